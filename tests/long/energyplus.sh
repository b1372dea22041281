#!/bin/sh
# How well a meta-model stands in for EnergyPlus models, and whether calibrations on it hold the truth: left-out runs, corners
# of the priors, synthetic measurements. Goes on where it was stopped. Models: recald-sim's own, and those of a folder.
#   KINDS     of recald-sim's own, one after the other (default "small_office laboratory")
#   EXAMPLES  folder with *.epJSON (5ZoneAutoDXVAV, the ASHRAE warehouse, a data centre with an economiser); default: none
#   WEATHER   an EPW file for them
#   RUNS      of a design (default 200)
#   TRUTHS    synthetic buildings (default 30)
#   OUT       where runs are kept (default: a new folder)
# Argument: the build folder. RECALD_ENERGYPLUS names the program.
set -eu
exec python3 "$(dirname "$0")/energyplus.py" "$1"
