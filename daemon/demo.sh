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

# An installed recald will do if it is of this version; the simulator is in no package.
version=$(sed -n 's/^project(recald VERSION \([^ ]*\).*/\1/p' "$root/CMakeLists.txt")
recald=$(command -v recald || true)
[ -n "$recald" ] && [ "$("$recald" --version)" = "$version" ] || recald=

log=$(mktemp)
build() {
  cmake -S "$root" --preset release -DRECALD_TESTS=OFF -DRECALD_WARNINGS_AS_ERRORS=OFF \
    -DRECALD_TOGETHER=ON -B "$root/.build/demo" &&
    cmake --build "$root/.build/demo" --target "$@" --parallel "$(build_jobs)"
}

if [ -n "$recald" ]; then
  echo "Using $recald, which is recald $version; building the simulator alone …"
  set -- recald-sim
else
  echo "Building recald; the first time takes some minutes …"
  recald=$root/.build/demo/daemon/recald
  set -- recald recald-sim
fi
build "$@" >"$log" 2>&1 &
building=$!
trap 'kill $building 2>/dev/null; exit 130' INT TERM
while [ -t 1 ] && kill -0 $building 2>/dev/null; do
  printf '\r\033[K  %.70s' "$(tail -n 1 "$log")"
  sleep 1
done
[ ! -t 1 ] || printf '\r\033[K'
wait $building || {
  tail -n 40 "$log" >&2
  echo "The build failed; the last lines are above, all of it in $log." >&2
  exit 1
}
trap - INT TERM
rm -f "$log"

sim=$root/.build/demo/simulators/recald-sim
mkdir -p "$dir"
dir=$(cd "$dir" && pwd)

# run NAME COMMAND…: what it prints goes to NAME.txt, what it says to NAME.log; on a terminal it shows its progress.
run() {
  name=$1
  shift
  if [ -t 2 ]; then
    "$@" >"$dir/$name.txt"
  else
    "$@" >"$dir/$name.txt" 2>"$dir/$name.log" || { cat "$dir/$name.log" >&2; return 1; }
  fi
}

echo "Making three years of feeds of an office building (seed $seed) …"
{
  echo '[building]'
  echo 'use = "office"'
  if [ "$effect" != none ]; then
    echo '[[effect]]'
    echo "name = \"$effect\""
  fi
} >"$dir/scenario.toml"
"$sim" building --scenario "$dir/scenario.toml" --out "$dir" --years 3 --seed "$seed" >"$dir/building.txt"
echo "Turning 15-minute readings into months …"
run replay "$recald" replay --quiet "$dir/site.toml" --out "$dir"
echo "Calibrating the model on the first two years …"
run calibrate "$recald" calibrate --quiet "$dir/site.toml" --seed "$seed" --out "$dir"
echo "Looking for what the drawings do not tell …"
run diagnose "$recald" diagnose --quiet "$dir/site.toml" --seed "$seed" --out "$dir"

echo
sed -n '1s/^Outcome: [^.]*[.] //p' "$dir/diagnose.txt"
echo "(Hidden by the simulator: $effect.)"
echo
echo "Open in a browser: $dir/report.html, $dir/diagnosis.html"
echo
echo "Details"
echo
cat "$dir/building.txt" "$dir/calibrate.txt" "$dir/diagnose.txt"
echo
echo "Also in $dir:"
echo "  months.csv         monthly figures of each meter"
echo "  calibration.json   the calibration, with its diagnostics and seeds"
echo "  diagnosis.json     where model and meters disagree, and why"
echo "  readings.csv, weather.csv, site.toml   the feeds and what their user knows"
echo "  truth.json         what the user does not know, for scoring"
