#!/bin/sh
# The gateway is killed 2 000 times within a month of virtual time, each time at a random step of its
# writing; 8 000 times while it also opens, reloads, backs up and works on jobs; the real program 100
# times by SIGKILL. The power goes 5 000 times in steady running, 2 500 times in a recovery and 2 500
# times in such a life. Argument: the build folder.
set -eu
cmake --build "$1" --target crash_test edges_test run_command_test
RECALD_KILLS=${RECALD_KILLS:-2000} RECALD_CUTS=${RECALD_CUTS:-5000} "$1/tests/daemon/crash_test"
RECALD_EDGE_KILLS=${RECALD_EDGE_KILLS:-8000} RECALD_EDGE_CUTS=${RECALD_EDGE_CUTS:-2500} \
  "$1/tests/daemon/edges_test"
RECALD_REAL_KILLS=${RECALD_REAL_KILLS:-100} "$1/tests/daemon/run_command_test" \
  --gtest_filter='KillCommand.*'
