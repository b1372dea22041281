#!/bin/sh
# Masked known effects on measured buildings: a term is taken out of the site file and sought again,
# blind; weather of another place must not earn a weather name. About ten minutes on one core.
# Argument: the build folder. RECALD_DATA: the measured data; where they are absent nothing is done.
set -eu
build=$1
here=$(cd "$(dirname "$0")" && pwd)
RECALD_DATA=${RECALD_DATA:-$here/../../../shared/data}
if [ ! -d "$RECALD_DATA/real" ]; then
  echo "masked-effects: skipped, no measured data at $RECALD_DATA; set RECALD_DATA" >&2
  exit 0
fi
RECALD_DATA=$(cd "$RECALD_DATA" && pwd)   # site files elsewhere refer to it
export RECALD_DATA
out=${MASKED_EFFECTS_DIR:-$(mktemp -d)}
python3 "$here/masked_effects.py" derive "$out"
for site in "$out"/*/*/site.toml; do
  dir=$(dirname "$site")
  rm -f "$dir/diagnosis.json"
  # One that fails says why and is a row of the table.
  "${RECALD:-$build/daemon/recald}" diagnose "$site" --out "$dir" --seed 1 >"$dir/words.txt" \
    2>"$dir/log.txt" || tail -n 1 "$dir/log.txt" >&2
done
python3 "$here/masked_effects.py" table "$out"
echo "details in $out"
