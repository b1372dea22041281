#!/bin/sh
# Which hidden effect comes first by the signatures of the meters, with weights learnt in the other world
# (tests/naming/study.py): makes buildings of both worlds, their tables, and prints rates by strength. What has been made
# is kept and used again.
#   OUT         where populations and tables are kept (default: a new folder)
#   OWN         cases of our own world (default 1-89), beside PLAIN with nothing hidden (default 100)
#   ENERGYPLUS  cases of EnergyPlus's (default 1-34); RECALD_ENERGYPLUS names the program
#   SEED        of all (default 1)
# Argument: the build folder. Some two hours of a processor.
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
: "${RECALD_ENERGYPLUS:?names no EnergyPlus}"
out=${OUT:-$(mktemp -d)}
seed=${SEED:-1}
cmake --build "$1" --target blind_make signature_table >/dev/null
python=$1/naming-study
sh "$here/python_environment.sh" "$(command -v python3)" "$python" "$here/naming/study-requirements.txt"
[ -f "$python/installed" ] || exit 1
echo "Populations and tables are in $out. Remove its tables after a change of the program."
make=$1/tests/blind/blind_make
"$make" --population plain --uses office,laboratory,school,hotel,warehouse --count "${PLAIN:-100}" --seed "$seed" --out "$out/plain"
"$make" --population development --seed "$seed" --cases "${OWN:-1-89}" --out "$out/own"
"$make" --world energyplus --population development --seed "$seed" --cases "${ENERGYPLUS:-1-34}" --out "$out/energyplus"
for each in plain own energyplus; do
  "$1/tests/naming/signature_table" --population "$out/$each" --out "$out/$each-tables"
done
OPENBLAS_NUM_THREADS=1 exec "$python/bin/python" "$here/naming/study.py" \
  "$out/plain-tables:$out/plain/answers,$out/own-tables:$out/own/answers" "$out/energyplus-tables:$out/energyplus/answers"
