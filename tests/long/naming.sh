#!/bin/sh
# Which hidden effect comes first by the signatures of the meters, with weights learnt in the other world
# (tests/naming/study.py): makes buildings of both worlds, their tables, and prints rates by strength. What has been made
# is kept and used again.
#   OUT         where populations and tables are kept (default: a new folder)
#   OWN, ENERGYPLUS   what is made of each world: populations, each with its seed and cases
#   PLAIN       buildings of our own world with nothing hidden, only to compare with (default 100)
#   RECALD_ENERGYPLUS names the program.
# Argument: the build folder. Some three hours of a processor.
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
: "${RECALD_ENERGYPLUS:?names no EnergyPlus}"
out=${OUT:-$(mktemp -d)}
own=${OWN:-development 1 1-89 learning 11 1-200}
energyplus=${ENERGYPLUS:-development 1 1-34 learning 5 1-33}
cmake --build "$1" --target blind_make signature_table >/dev/null
python=$1/naming-study
sh "$here/python_environment.sh" "$(command -v python3)" "$python" "$here/naming/study-requirements.txt"
[ -f "$python/installed" ] || exit 1
echo "Populations and tables are in $out. Remove its tables after a change of the program."
"$1/tests/blind/blind_make" --population plain --uses office,laboratory,school,hotel,warehouse --count "${PLAIN:-100}" --seed 1 \
  --out "$out/plain"
"$1/tests/naming/signature_table" --population "$out/plain" --out "$out/plain-tables" --no-effects

# make_tables BUILD WORLD POPULATION SEED CASES …: prints what study.py reads.
make_tables() {
  build=$1
  world=$2
  shift 2
  all=
  while [ $# -gt 0 ]; do
    at=$out/$world-$1-$2
    "$build/tests/blind/blind_make" --world "$world" --population "$1" --seed "$2" --cases "$3" --twins --out "$at" >&2
    "$build/tests/naming/signature_table" --population "$at" --out "$at-tables" >&2
    all="$all${all:+,}$at-tables:$at/answers"
    shift 3
  done
  echo "$all"
}
own_tables=$(make_tables "$1" own $own)
energyplus_tables=$(make_tables "$1" energyplus $energyplus)
OPENBLAS_NUM_THREADS=1 exec "$python/bin/python" "$here/naming/study.py" "$out/plain-tables:$out/plain/answers,$own_tables" \
  "$energyplus_tables"
