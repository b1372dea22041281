#!/bin/sh
# What `recald ecm` says that measures will save, and that one has saved, held against buildings of the simulator in
# which they were really carried out: the same building, weather and people with each measure and without. Goes on
# where it was stopped.
#   USES    of the simulator, one after the other   (default office school laboratory)
#   COUNT   buildings of each                       (default 17)
#   SEED    of the first; the others follow         (default 5001)
#   MODELS  epc, hourly                             (default both)
#   SINCE   buildings, of those, in which the first measure is looked at afterwards (default 12)
#   OUT     where results are kept                  (default: a new folder)
# Argument: the build folder.
set -eu
exec python3 "$(dirname "$0")/ecm.py" "$1"
