#!/bin/sh
# Calibrations of buildings with nothing hidden in them, held against a year that they have not seen: forecasts beside
# the yardstick, the model alone, and where the truth lies in the posteriors. Goes on where it was stopped.
#   USES    of the simulator, one after the other   (default office school laboratory)
#   COUNT   buildings of each                       (default 12)
#   SEED    of the first; the others follow         (default 9001)
#   MODELS  epc, hourly                             (default both)
#   SITES   folders with a site.toml (and a truth.json) in the place of simulated buildings
#   ERRORS  lines of [model.errors], to try other sizes of the models' own errors; with an OUT of its own
#   OUT     where results are kept                  (default: a new folder)
# Argument: the build folder.
set -eu
exec python3 "$(dirname "$0")/forecasts.py" "$1"
