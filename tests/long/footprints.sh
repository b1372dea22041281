#!/bin/sh
# Figures of what each hidden effect does to the meters, and a week of each use of building: SVG files and a README.md.
#   OUT     where (default: footprints in the build folder)
#   TWINS   a blind population made with --twins, of either world: its cases instead
# Argument: the build folder. Some three minutes.
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
python=$1/tests/blind/python
sh "$here/python_environment.sh" "$(command -v python3)" "$python" "$here/blind/requirements.txt"
[ -f "$python/installed" ] || exit 1
set -- "$1" "${OUT:-$1/footprints}"
if [ -n "${TWINS:-}" ]; then
  exec "$python/bin/python" "$here/long/footprints.py" --twins "$TWINS" "$2"
fi
exec "$python/bin/python" "$here/long/footprints.py" "$1/simulators/recald-sim" "$2"
