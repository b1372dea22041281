#!/bin/sh
# Names by signatures: makes buildings of both worlds, learns what signatures look like where nothing is hidden
# (tests/naming/null.py), prints which effect comes first with weights learnt in the other world (study.py), and writes what a
# diagnosis uses, learnt in both (learn.py). What has been made is kept and used again.
#   OUT         where populations, tables and learnt_names.cpp are kept (default: a new folder)
#   OWN, ENERGYPLUS   what is made of each world: populations, each with its seed and cases
#   PLAIN       buildings of our own world with nothing hidden, only to compare with (default 100)
#   RECALD_ENERGYPLUS names the program.
# Argument: the build folder. Some four hours of a processor.
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
: "${RECALD_ENERGYPLUS:?names no EnergyPlus}"
out=${OUT:-$(mktemp -d)}
own=${OWN:-development 1 1-89 learning 11 1-100}
energyplus=${ENERGYPLUS:-development 1 1-34 development 6 1-40 learning 5 1-33}
plain=${PLAIN:-100}
build=$1
cmake --build "$build" --target blind_make signature_table >/dev/null
python=$build/tests/blind/python
sh "$here/python_environment.sh" "$(command -v python3)" "$python" "$here/blind/requirements.txt"
[ -f "$python/installed" ] || exit 1
echo "Populations and tables are in $out. Remove its tables after a change of the program."
table=$build/tests/naming/signature_table
"$build/tests/blind/blind_make" --population plain --uses office,laboratory,school,hotel,warehouse --count "$plain" --seed 1 \
  --out "$out/plain"
"$table" --population "$out/plain" --out "$out/plain-left"

# make_left WORLD POPULATION SEED CASES …: prints what null.py reads.
make_left() {
  world=$1
  shift
  while [ $# -gt 0 ]; do
    at=$out/$world-$1-$2
    "$build/tests/blind/blind_make" --world "$world" --population "$1" --seed "$2" --cases "$3" --twins --out "$at" >&2
    "$table" --population "$at" --out "$at-left" >&2
    "$table" --population "$at" --out "$at-twins-left" --twins >&2
    printf ',%s' "$at-left:$at/answers,$at-twins-left:$at/answers:twins"
    shift 3
  done
}

# make_evidence WORLD POPULATION SEED CASES …: prints what study.py and learn.py read.
make_evidence() {
  world=$1
  shift
  while [ $# -gt 0 ]; do
    at=$out/$world-$1-$2
    "$table" --population "$at" --out "$at-evidence" --null "$out/null.json" >&2
    printf '%s' "${comma-}$at-evidence:$at/answers"
    comma=,
    shift 3
  done
}
own_left=$out/plain-left:$out/plain/answers$(make_left own $own)
energyplus_left=$(make_left energyplus $energyplus)
export OPENBLAS_NUM_THREADS=1
"$python/bin/python" "$here/naming/null.py" "$out/null.new" "$own_left" "${energyplus_left#,}"
if ! cmp -s "$out/null.new" "$out/null.json"; then
  rm -rf "$out"/*-evidence # made beside another null
  mv "$out/null.new" "$out/null.json"
fi
own_evidence=$(make_evidence own $own)
energyplus_evidence=$(make_evidence energyplus $energyplus)
"$python/bin/python" "$here/naming/study.py" "$own_evidence" "$energyplus_evidence"
"$python/bin/python" "$here/naming/learn.py" "$out/null.json" "$out/learnt_names.cpp" \
  "Own: $own, with plain 1 1-$plain for the null; EnergyPlus: $energyplus." "$own_evidence" "$energyplus_evidence"
echo "What was learnt is in $out/learnt_names.cpp; core/diagnosis uses its own copy."
