#!/bin/sh
# Priors learned from a portfolio of buildings in EnergyPlus that differ in their parameters alone: the model is right, so this is
# what the learning itself can do. What is judged is where the truth of the parameters lies. Goes on where it was stopped.
#   KIND      of recald-sim's own models                        (default small_office)
#   PARAMETERS  that differ, of which a few months have to tell (default: five)
#   LEARNING  buildings that teach, with twelve months          (default 16)
#   JUDGED    buildings of each fleet that are judged           (default 12)
#   MONTHS    of data of a judged building                      (default "2 3 6")
#   RUNS      of the design                                     (default 200)
#   OUT       where runs are kept                               (default: a new folder)
# Argument: the build folder. RECALD_ENERGYPLUS names the program.
set -eu
cmake --build "$1" --target portfolio_priors_study recald recald-sim >/dev/null
exec python3 "$(dirname "$0")/portfolio_priors_energyplus.py" "$1"
