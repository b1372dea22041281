#!/bin/sh
# Fleets on this machine, in parts: sites that send while PostgreSQL is away and the broker wiped; jobs that are calculated
# while two of four workers are killed; a poison site beside others; pages with many sites; 1 000 sites that send as fast as
# the record takes it; real gateways behind a network that is cut while PostgreSQL is away for an hour. Argument: the build
# folder. PARTS names some of away, calculated, poison, pages, ingest and hour; SITES, SECONDS, KILLS and AWAY_S make them
# smaller. Results are JSON in .build/fleet; a part that is there is not made again. `hour` makes a network namespace, as root.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
cmake --build "$1" --target fleet_load fleet_lease recald recald-sim --parallel 2 >/dev/null
exec python3 "$root/tests/long/fleet.py" "$(realpath "$1")" "$root/.build/fleet"
