#!/bin/sh
# The main job from nothing: builds recald, invents an office building with three years of
# 15-minute meters and one thing wrong in it that its drawings do not tell, calibrates its energy
# model on two years, checks it on the third, and finds what is wrong.
#
#   sh daemon/demo.sh [DIR]     results in DIR, by default .demo/ beside the sources
#   SEED=7 sh daemon/demo.sh    another building
#   EFFECT=NAME                 something else is wrong, or none: an effect without a date, of those
#                               that recald-sim building --list-effects explains
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
dir=${1:-$root/.demo}
seed=${SEED:-1}
effect=${EFFECT:-weekend_operation}

. "$root/daemon/packages.sh"
# shellcheck disable=SC2086  # lists of words
install_packages $BUILD_PACKAGES

echo "Building (release) …"
log=$(mktemp)
if ! { cmake -S "$root" --preset release -DRECALD_TESTS=OFF -DRECALD_WARNINGS_AS_ERRORS=OFF \
    -DRECALD_TOGETHER=ON -B "$root/.build/demo" &&
  cmake --build "$root/.build/demo" --target recald recald-sim --parallel "$(build_jobs)"; } >"$log" 2>&1; then
  tail -n 40 "$log" >&2
  echo "The build failed; the last lines are above, all of it in $log." >&2
  exit 1
fi
rm -f "$log"

recald=$root/.build/demo/daemon/recald
sim=$root/.build/demo/simulators/recald-sim
mkdir -p "$dir"
dir=$(cd "$dir" && pwd)

echo "Making three years of feeds of an office building (seed $seed) …"
{
  echo '[building]'
  echo 'use = "office"'
  if [ "$effect" != none ]; then
    echo '[[effect]]'
    echo "name = \"$effect\""
  fi
} >"$dir/scenario.toml"
"$sim" building --scenario "$dir/scenario.toml" --out "$dir" --years 3 --seed "$seed"
echo
echo "What the recording shows:"
"$recald" replay "$dir/site.toml" --out "$dir" >"$dir/replay.txt"
echo
echo "Calibrating on the first two years, validating on the third …"
"$recald" calibrate "$dir/site.toml" --seed "$seed" --out "$dir" 2>"$dir/calibrate.log" || {
  cat "$dir/calibrate.log" >&2
  exit 1
}
echo
echo "Looking for what the drawings do not tell …"
"$recald" diagnose "$dir/site.toml" --seed "$seed" --out "$dir" 2>"$dir/diagnose.log" || {
  cat "$dir/diagnose.log" >&2
  exit 1
}
echo
echo "What the simulator has hidden: $effect (scenario.toml)"
echo
echo "In $dir:"
echo "  report.html        open it in a browser"
echo "  calibration.json   the result, with its diagnostics and seeds"
echo "  diagnosis.html, diagnosis.json   where model and meters disagree, and why"
echo "  readings.csv, weather.csv, site.toml   the feeds and what their user knows"
echo "  truth.json         what the user does not know, for scoring"
