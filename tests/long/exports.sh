#!/bin/sh
# Random exports of portals, standards and devices, whose truth is known, through `recald init` and `replay`: how many
# come out right at the first go, by kind (tests/exports). About a quarter of an hour on two cores.
#   COUNT         exports (default 2000)
#   SEED          of all of them (default 1)
#   JOBS          at a time (default: one per core)
#   EXPORTS_ONLY  numbers of exports: these alone, with what came of each; their folders are kept
#   OUT           where outcomes and those folders go (default: a new folder)
#   RECALD        the program (default: that of the build folder)
# Argument: the build folder.
set -eu
exec python3 "$(dirname "$0")/exports.py" "$1"
