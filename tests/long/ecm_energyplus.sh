#!/bin/sh
# What `recald ecm` says of measures at buildings in EnergyPlus, against what they save there: truths drawn from the priors
# of three models, each run without and with the measures. The truths of a model share its design and its runs with
# measures. Goes on where it was stopped; with the same OUT it uses the designs of `--long energyplus`.
#   EXAMPLES, WEATHER, KINDS, RUNS, OUT   as in energyplus.sh
#   TRUTHS    buildings a model (default 17)
# Argument: the build folder. RECALD_ENERGYPLUS names the program.
set -eu
exec python3 "$(dirname "$0")/ecm_energyplus.py" "$1"
