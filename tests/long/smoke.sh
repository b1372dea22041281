#!/bin/sh
# All twelve cases of the smoke population made, diagnosed and scored; tests/run.sh diagnoses two.
# Some five minutes on two cores. Argument: the build folder.
set -eu
cmake --build "$1" --target blind_surroundings
RECALD_SMOKE_CASES=${RECALD_SMOKE_CASES:-1-12} "$1/tests/blind_surroundings" --gtest_filter='Smoke.*'
