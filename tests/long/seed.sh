#!/bin/sh
# The way of the seed (Li, Gu, Augenbroe, Wu, Brown 2015) on a campus laboratory whose truth is known: EnergyPlus
# simulates the true building for 2011 to 2013, its meters get noise and gaps, and the model of the drawings is
# calibrated on 2011 and 2012 and held against 2013, as EnergyPlus model and as EPC. Writes tests/results/seed.md with
# the paper's Tables 2 to 4 beside ours. Goes on where it was stopped.
#   SEED  what is true of the building             (default 1)
#   RUNS  of the design                            (default 200, as in the paper)
#   OUT   where models, runs and results are kept  (default: a new folder)
#   RECALD_ENERGYPLUS  the program; without it that of the tests is installed; without a network nothing is done
# Argument: the build folder.
set -eu
if [ -z "${RECALD_ENERGYPLUS:-}" ]; then
  cmake --build "$1" --target energyplus_environment
  RECALD_ENERGYPLUS=$(find "$1/tests/adapters/energyplus/energyplus" -path '*/payload/energyplus' -type f | head -n 1)
  # The package leaves it without the right to be run.
  [ -z "$RECALD_ENERGYPLUS" ] || chmod u+x "$RECALD_ENERGYPLUS"
fi
if [ -z "$RECALD_ENERGYPLUS" ]; then
  echo "seed: skipped, there is no EnergyPlus; set RECALD_ENERGYPLUS" >&2
  exit 0
fi
export RECALD_ENERGYPLUS
OUT=${OUT:-$(mktemp -d)}
export OUT
exec python3 "$(dirname "$0")/seed.py" "$1"
