#!/bin/sh
# 1 032 meters of 8 fields each on 250 TCP endpoints and 8 serial lines (pseudo-terminals), read
# every 10 s by one daemon for MINUTES (default 10) beside the devices on the same machine. What the
# daemon takes, how late it polls and whether a boundary was missed. Argument: the build folder.
# ENDPOINTS, LINES and UNITS (meters on each) make it smaller; REQUESTS asks the API so many times a
# second beside it, and REGISTER_READS reads 125 Modbus registers so many times a second; CALIBRATE=1 has
# it calibrate a building all the while; HOSTILE=64 lets so many clients hold connections and answers.
set -eu
exec python3 "$(dirname "$0")/load.py" "$1" "${MINUTES:-10}"
