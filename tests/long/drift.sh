#!/bin/sh
# What `recald drift` finds in simulated buildings: nothing where nothing changes, and what changed
# where something did (simulators/scenario/drift). About an hour on two cores.
# Argument: the build folder. SEEDS (default 8): buildings of each scenario; QUIET (default 40) of the
# one where nothing changes, YEARS (default 6) long each; SCRATCH (default 1): buildings of each that are
# also recalibrated from scratch each month; PARTICLES (default 256); JOBS (default 2).
# DRIFT_DIR keeps what was made, and a run there goes on where it stopped; ONLY: names of scenarios.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
exec python3 "$here/drift.py" "$1" "$here/../../simulators/scenario/drift"
