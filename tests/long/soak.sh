#!/bin/sh
# A daemon that calibrates lives through MONTHS (default 100) of virtual time in MINUTES (default 30) of ours:
# readings are pushed as they fall due, months close, calibrations follow. What it holds in memory, in files
# and in rows is printed every ten months. Argument: the build folder.
set -eu
exec python3 "$(dirname "$0")/soak.py" "$1" "${MONTHS:-100}" "${MINUTES:-30}"
