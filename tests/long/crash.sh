#!/bin/sh
# The gateway is killed 2 000 times within a month of virtual time, each time at a random step of its
# writing; 8 000 times while it also opens, reloads, backs up and works on jobs; the real program 100
# times by SIGKILL. The power goes at 10 000 random steps. Half an hour or so. Argument: the build folder.
set -eu
cmake --build "$1" --target crash_test edges_test run_command_test
RECALD_KILLS=${RECALD_KILLS:-2000} RECALD_CUTS=${RECALD_CUTS:-10000} "$1/tests/daemon/crash_test"
RECALD_EDGE_KILLS=${RECALD_EDGE_KILLS:-8000} "$1/tests/daemon/edges_test"
RECALD_REAL_KILLS=${RECALD_REAL_KILLS:-100} "$1/tests/daemon/run_command_test" \
  --gtest_filter='KillCommand.*'
