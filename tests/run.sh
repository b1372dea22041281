#!/bin/sh
# The tests, from nothing: installs what is missing, builds, runs. Ends with ctest's own summary.
#
#   sh tests/run.sh                  that the program works: unit and property tests, scenarios, whole runs
#   sh tests/run.sh --surroundings   what is around it: the format of the sources, fuzz targets for five seconds each,
#                                    sanitizers, packages, documentation pages in a shell, pages in a browser, other
#                                    people's programs, blind populations
#   sh tests/run.sh --long NAME      one of the longer studies; without NAME: which there are
#   RECALD_DATA=DIR                  measured data of others; tests that need it skip where it is absent
#   RECALD_CI=1                      a test that skips fails the run, unless tests/skips.txt lists it
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"

. "$root/daemon/packages.sh"
. "$root/daemon/progress.sh"

case ${1:-} in
  "" | --surroundings | --long) ;;
  *)
    sed -n '2,/^set/s/^# \{0,1\}//p' "$0" | sed '$d' >&2
    exit 2
    ;;
esac
part=${1:-}

begin=$(date +%s)
name=
stage() {
  now=$(date +%s)
  [ -z "$name" ] || echo "--- $name: $(minutes $((now - since)))"
  name=$1
  since=$now
  [ -z "$name" ] || echo "--- $name"
}

failed=
logs=
mkdir -p "$root/.build"

# build PRESET TARGETS…: the end of its log where it fails, and no more is done.
build() {
  preset=$1
  shift
  # The demo and packages do without tests where there are none yet.
  cmake --preset "$preset" -DRECALD_TESTS=ON >"$root/.build/$preset-cmake.log" 2>&1 || {
    tail -n 30 "$root/.build/$preset-cmake.log" >&2
    exit 1
  }
  with_progress "compiling" "$root/.build/$preset-build.log" \
    cmake --build --preset "$preset" --target "$@" --parallel "$(build_jobs)" || {
    grep -E -A 12 'error:|FAILED' "$root/.build/$preset-build.log" | head -n 60 >&2
    tail -n 10 "$root/.build/$preset-build.log" >&2
    echo "The build failed; all of it is in .build/$preset-build.log." >&2
    exit 1
  }
}

# run_tests PRESET OPTIONS OF CTEST…: what failed with its output, then ctest's own summary.
run_tests() {
  preset=$1
  shift
  log=$root/.build/$preset-tests.log
  logs="$logs $log"
  # Three at a time on two cores: whole runs of the daemon wait for their virtual clocks. Behind everything else: the
  # daemon calibrates at the lowest priority and would wait for every other test to end.
  with_progress "tests" "$log" nice -n 19 ctest --preset "$preset" -j $(($(nproc) + 1)) "$@" || {
    failed="$failed $preset"
    awk '/^ *[0-9]+\/[0-9]+ Test/ { shown = /\*\*\*(Failed|Timeout|Exception|Not Run)/ } shown' "$log" | tail -n 400
  }
  sed -n '/tests passed, .* tests failed out of/,$p' "$log" | sed '/^Label Time Summary/,/^Total Test time/{/^Total/!d}' |
    sed '/did not run:/,/^$/d'
}

if [ "$part" = "--long" ]; then
  stage "Debian packages"
  # shellcheck disable=SC2086  # lists of words
  install_packages $BUILD_PACKAGES $TEST_PACKAGES $SURROUNDINGS_PACKAGES python3 clang-tidy
  study=$root/tests/long/${2:-}.sh
  if [ -z "${2:-}" ] || [ ! -f "$study" ]; then
    echo "Long studies:" >&2
    for file in "$root"/tests/long/*.sh; do echo "  $(basename "$file" .sh)" >&2; done
    exit 2
  fi
  if [ "$2" != fuzz ] && [ "$2" != tidy ]; then  # which need another compiler, or none
    stage "build (release)"
    build release recald recald-sim
  fi
  stage "$2"
  sh "$study" "$root/.build/release"
  stage ""
  exit 0
fi

if [ -z "$part" ]; then
  stage "1 of 3: Debian packages"
  # shellcheck disable=SC2086  # lists of words
  install_packages $BUILD_PACKAGES $TEST_PACKAGES
  stage "2 of 3: build (what is shipped, and its tests; warnings are errors)"
  build release tests recald recald-sim
  stage "3 of 3: tests"
  run_tests release -LE surroundings -E "_surroundings_NOT_BUILT"
  stage ""
else
  stage "1 of 7: Debian packages"
  # shellcheck disable=SC2086  # lists of words
  install_packages $BUILD_PACKAGES $TEST_PACKAGES $SURROUNDINGS_PACKAGES

  stage "2 of 7: format"
  sources=$(find core adapters daemon simulators tests -name '*.cpp' -o -name '*.hpp')
  # shellcheck disable=SC2086  # a list of words
  unformatted=$(printf '%s\n' $sources | xargs -P "$(nproc)" -n 50 clang-format --dry-run 2>&1 |
    sed -n 's/^\([^:]*\):[0-9]*:[0-9]*: .*clang-format.*/\1/p' | sort -u)
  if [ -n "$unformatted" ]; then
    for file in $unformatted; do
      echo "$file is not formatted; run: clang-format -i $file" >&2
    done
    exit 1
  fi

  stage "3 of 7: fuzz (5 s each)"
  fuzz_log=$root/.build/fuzz.log
  with_progress "fuzz" "$fuzz_log" sh "$root/tests/fuzz/run.sh" 5 || failed="$failed fuzz"
  grep -a 'nothing found\|FOUND' "$fuzz_log" || true

  # What leads from registers to months. All 300 kills are in the tests above; under a sanitizer each takes ten times
  # as long.
  stage "4 of 7: AddressSanitizer and UBSan"
  build asan tests
  export RECALD_KILLS=40
  # What differs from the other scenarios by its dates, by what is silent or late, or by when the power fails, has the
  # same memory.
  run_tests asan -E "ClockChange|GatewayClock|PowerCut|ARegisterAtZeroForDays|SilentForAWeek|LateAfterClose$"
  stage "5 of 7: ThreadSanitizer"
  build tsan tests
  # A month of the gateway has the same threads whatever its dates are, whatever is late or silent, and whatever ends it.
  run_tests tsan -E "ClockChange|GatewayClock|LateAfterClose|OutagesCostNoEnergy|ARegisterAtZeroForDays|KillsCostNo|\
AFullDiskForHours|SilentForAWeek|WeatherSensor.AMonth"

  unset RECALD_KILLS

  stage "6 of 7: packages and programs"
  with_progress "package" "$root/.build/package.log" \
    sh "$root/daemon/packaging/make_deb.sh" "$(dpkg --print-architecture)" "$root/.build/packages" || {
    tail -n 30 "$root/.build/package.log" >&2
    failed="$failed package"
  }
  build release surroundings recald recald-sim
  stage "7 of 7: tests of the surroundings"
  run_tests release -L surroundings
  stage ""
fi
echo "--- $(minutes $(($(date +%s) - begin))) in all"

# A test that skips shows nothing, in whichever run. Those of tests/skips.txt may; in CI (RECALD_CI=1) no other.
# shellcheck disable=SC2086  # a list of files
skipped=$(sed -n 's/.*Test  *#[0-9]*: \([^ ]*\).*\*\*\*Skipped.*/\1/p' $logs | sort -u)
if [ -n "$skipped" ]; then
  unexpected=$(printf '%s\n' $skipped | grep -v -E -x -f "$root/tests/skips.txt" || true)
  expected=$(printf '%s\n' $skipped | grep -c -E -x -f "$root/tests/skips.txt" || true)
  [ "$expected" = 0 ] || echo "$expected skipped: most need measurements of others; tests/data/README.md says where to get them."
  if [ -n "$unexpected" ]; then
    echo "Skipped although nothing says that it may (tests/skips.txt):" $unexpected >&2
    [ -z "${RECALD_CI:-}" ] || failed="$failed skipped"
  fi
fi
[ -z "$failed" ] || {
  case "$failed" in *fuzz*) tail -n 100 "$fuzz_log" | cut -c 1-4000 ;; esac
  echo "Failed:$failed" >&2
  exit 1
}
