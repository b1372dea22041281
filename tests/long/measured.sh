#!/bin/sh
# Measured buildings, calibrated with defaults and held against months that they have not seen: cambridge-b25,
# cambridge-b40, openeis-hillside and nmecr-facility. The table is that of forecasts.sh; a refusal counts as a failure.
# Argument: the build folder. RECALD_DATA: the measured data; where they are absent nothing is done.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
RECALD_DATA=${RECALD_DATA:-$here/../../../shared/data}
if [ ! -d "$RECALD_DATA/real" ]; then
  echo "measured: skipped, no measured data at $RECALD_DATA; set RECALD_DATA" >&2
  exit 0
fi
RECALD_DATA=$(cd "$RECALD_DATA" && pwd)   # site files elsewhere refer to it
export RECALD_DATA
OUT=${OUT:-$(mktemp -d)}
export OUT
SITES=
for name in cambridge-b25 b40 hillside facility; do
  file=$here/real/$name.toml
  [ -f "$file" ] || file=$here/../../daemon/examples/$name.toml
  folder=$OUT/sites/$name
  mkdir -p "$folder"
  cp "$file" "$folder/site.toml"
  SITES="$SITES $folder"
done
# The nine months before the spring of 2020 teach, and the spring is no month that they could tell of.
sed -i 's/^calibration = { from = "2019-05", to = "2020-01" }/&\nvalidation = { from = "2020-02", to = "2020-02" }/' \
  "$OUT/sites/facility/site.toml"
export SITES
exec python3 "$here/forecasts.py" "$1"
