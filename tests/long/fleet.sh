#!/bin/sh
# A fleet on this machine: 1 000 simulated sites that send as fast as the record takes it, then a dozen whose jobs are
# calculated again and again while two of four workers are killed at a time, and while PostgreSQL is away. Argument:
# the build folder. SITES, SECONDS and KILLS make it smaller. Its result is JSON in .build/fleet; a part that is there
# is not made again.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
cmake --build "$1" --target fleet_load recald recald-sim --parallel 2 >/dev/null
exec python3 "$root/tests/long/fleet.py" "$(realpath "$1")" "$root/.build/fleet"
