#!/bin/sh
# What `recald drift` finds in measured buildings: the turn of 2016 to 2017 in cambridge-b25, the gas
# meter of cambridge-b40 that changes its unit, the spring of 2020 in nmecr-facility. Half a minute.
# Argument: the build folder. RECALD_DATA: the measured data; where they are absent nothing is done.
set -eu
build=$1
here=$(cd "$(dirname "$0")" && pwd)
RECALD_DATA=${RECALD_DATA:-$here/../../../shared/data}
if [ ! -d "$RECALD_DATA/real" ]; then
  echo "real-drift: skipped, no measured data at $RECALD_DATA; set RECALD_DATA" >&2
  exit 0
fi
RECALD_DATA=$(cd "$RECALD_DATA" && pwd)   # site files elsewhere refer to it
export RECALD_DATA
out=${DRIFT_DIR:-$(mktemp -d)}
follow() {
  name=$1
  shift
  mkdir -p "$out/$name"
  echo "$name"
  "$build/daemon/recald" drift "$@" --particles 256 --out "$out/$name" 2>"$out/$name/log.txt" ||
    tail -n 1 "$out/$name/log.txt"
  echo
}
follow cambridge-b25 "$here/../../daemon/examples/cambridge-b25.toml"
# The monthly model has no chiller of its own.
sed '/^chiller_cop/d' "$here/real/b40.toml" >"$out/b40.toml"
follow cambridge-b40 "$out/b40.toml" --model epc
# Its weather is temperature alone: sun, humidity and wind are what a clear enough sky would have.
mkdir -p "$out/facility"
python3 - "$here" "$out/facility" <<'END'
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import masked_effects
folder = Path(sys.argv[2])
site = (Path(sys.argv[1]) / "real" / "facility.toml").read_text()
(folder / "site.toml").write_text(masked_effects.with_assumed_sky(site, folder))
END
# The spring is the twelfth month of the record, so the model is made from the nine before.
follow facility "$out/facility/site.toml" --learn 9
echo "details in $out"
