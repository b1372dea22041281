#!/bin/sh
# What `recald drift` says that a change has cost and will cost a year, beside what the simulator's twin
# without the change shows. About 40 minutes on two cores. Argument: the build folder.
# BUILDINGS (default 40), JOBS (default 2); COSTS_DIR keeps what was made, and a run there goes on where it stopped.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
exec python3 "$here/alarm_costs.py" "$1"
