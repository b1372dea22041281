#!/bin/sh
# Simulation-based calibration and interval coverage of the ways of calibrating, 500 replicates each.
# Takes about twenty minutes on two cores. Argument: the build folder.
set -eu
cmake --build "$1" --target sbc_study
"$1/tests/long/sbc_study" "${REPLICATES:-500}"
