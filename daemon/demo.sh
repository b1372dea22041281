#!/bin/sh
# The main job from nothing: builds recald, invents an office building with three years of 15-minute meters and a
# hidden fault, calibrates its energy model on two years, checks it on the third, and looks for the fault.
#
#   sh daemon/demo.sh [--details] [DIR]   results in DIR, by default .demo/ beside the sources; --details prints all
#                                         that was printed on the way
#   SEED=7 sh daemon/demo.sh              another building
#   EFFECT=NAME                           something else is wrong, or none: an effect without a date, of those that
#                                         recald-sim building --list-effects explains
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
details=
if [ "${1:-}" = --details ]; then
  details=yes
  shift
fi
dir=${1:-$root/.demo}
seed=${SEED:-1}
effect=${EFFECT:-weekend_operation}
began=$(date +%s)

. "$root/daemon/packages.sh"
. "$root/daemon/progress.sh"

# Installed programs will do if they are of this version.
version=$(sed -n 's/^project(recald VERSION \([^ ]*\).*/\1/p' "$root/CMakeLists.txt")
recald=$(command -v recald || true)
sim=$(command -v recald-sim || true)
if [ -n "$recald" ] && [ -n "$sim" ] && [ "$("$recald" --version)" = "$version" ] &&
  [ "$("$sim" --version)" = "$version" ]; then
  echo "Using $recald and $sim, which are of version $version."
else
  # shellcheck disable=SC2086  # lists of words
  install_packages $BUILD_PACKAGES
  mkdir -p "$root/.build"
  log=$root/.build/demo.log
  build() {
    # Where the tests were built in it, they stay known: CMake deletes what it no longer knows.
    tests=
    [ -f "$root/.build/release/CMakeCache.txt" ] || tests=-DRECALD_TESTS=OFF
    (cd "$root" && cmake --preset release $tests) &&
      cmake --build "$root/.build/release" --target recald-demo recald-sim-demo --parallel "$(build_jobs)"
  }
  echo "Building recald; the first time takes some minutes."
  with_progress "compiling" "$log" build || {
    tail -n 40 "$log" >&2
    echo "The build failed; the last lines are above, all of it in $log." >&2
    exit 1
  }
  recald=$root/.build/release/daemon/recald-demo
  sim=$root/.build/release/simulators/recald-sim-demo
fi

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

echo "1 of 4: making three years of meter readings of an office building (seed $seed)"
{
  echo '[building]'
  echo 'use = "office"'
  if [ "$effect" != none ]; then
    echo '[[effect]]'
    echo "name = \"$effect\""
  fi
} >"$dir/scenario.toml"
run building "$sim" building --scenario "$dir/scenario.toml" --out "$dir" --years 3 --seed "$seed"
# What a month costs, so that a fault has a price.
cat >>"$dir/site.toml" <<'TARIFF'

[tariff]
currency = "EUR"
[tariff.electricity]
per_kWh = 0.22
[tariff.chilled_water]
per_kWh = 0.07
[tariff.heating]
per_kWh = 0.11
TARIFF
echo "2 of 4: turning 15-minute readings into months"
run replay "$recald" replay --quiet "$dir/site.toml" --out "$dir"
echo "3 of 4: calibrating the model on the first two years"
run calibrate "$recald" calibrate --quiet "$dir/site.toml" --seed "$seed" --out "$dir"
echo "4 of 4: looking for the hidden fault (about a minute)"
run diagnose "$recald" diagnose --quiet "$dir/site.toml" --seed "$seed" --out "$dir"

# said EXPRESSION: what sed makes of the lines of the diagnosis.
said() { sed -n "$1" "$dir/diagnose.txt" | head -n 1; }

hidden=$effect
[ "$effect" = none ] || hidden=$("$sim" building --list-effects | sed -n "s/^$effect ([^)]*): //p" | head -n 1)
outcome=$(said 's/^Outcome: \([^.]*\)[.].*/\1/p')
found=$(said 's/^Outcome: [^.]*[.] *Missing from the model: "\(.*\)"[.]$/\1/p')
if [ -n "$found" ]; then
  months=$(said 's/^Scatter of days .* in the \([0-9]*\) held-out months: .*/\1/p')
  sure="$(said 's/^ *\([0-9.]* %\)  .*/\1/p')${months:+, and it holds on $months months that no fit has used}"
else
  found="no single effect ($outcome)"
  sure=$(sed -n '/^Explanations:/,/^[^ E]/s/^ *\([0-9.]* %\)  \(.*\)/\2 \1/p' "$dir/diagnose.txt" | head -n 3 | paste -sd, | sed 's/,/, /g')
fi
error=$(said 's/^Scatter of days [^:]*: \(.*\)[.]$/\1/p' | sed 's/ % before, / → /g; s/ after//g; s/ and /, /g')
cost=$(said 's/.* It makes about \(.*\)[.] It costs about \(.*\)[.]$/\2: \1/p' | sed 's/ a month more at / more of /g; s/ a month less at / less of /g; s/$/ a month/')

echo
echo "Hidden        $hidden (in the simulated building; recald is not told)"
echo "Found         $found"
echo "How sure      $sure"
echo "Daily error   ${error:+CV(RMSE) on those months: }${error:-not lowered: nothing was added to the model}"
echo "Cost          ${cost:-none is known}"
echo
echo "Pages         $dir/diagnosis.html"
echo "              $dir/report.html"
echo "Took          $(minutes $(($(date +%s) - began)))"
if [ -z "$details" ]; then
  echo "--details prints all that was found on the way; it is in $dir/*.txt."
  exit 0
fi
echo
cat "$dir/building.txt" "$dir/calibrate.txt" "$dir/diagnose.txt"
echo
echo "Also in $dir:"
echo "  months.csv         monthly figures of each meter"
echo "  calibration.json   the calibration, with its diagnostics and seeds"
echo "  diagnosis.json     where model and meters disagree, and why"
echo "  readings.csv, weather.csv, site.toml   the feeds and what their user knows"
echo "  truth.json         what the user does not know, for scoring"
