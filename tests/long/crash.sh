#!/bin/sh
# The gateway is killed 2 000 times within a month of virtual time, each time at a random step of its
# writing, and the real program 100 times by SIGKILL. Some ten minutes. Argument: the build folder.
set -eu
cmake --build "$1" --target crash_test run_command_test
RECALD_KILLS=${RECALD_KILLS:-2000} "$1/tests/daemon/crash_test"
RECALD_REAL_KILLS=${RECALD_REAL_KILLS:-100} "$1/tests/daemon/run_command_test" \
  --gtest_filter='KillCommand.*'
