#!/bin/sh
# All tests, from nothing: installs what is missing, builds, runs. Ends with ctest's own summary.
#
#   sh tests/run.sh              the format of all sources, all tests, fuzz targets for five seconds
#                                each, and what leads from registers to months under the sanitizers
#   sh tests/run.sh --plain      all tests alone
#   sh tests/run.sh --long NAME  one of the longer studies; without NAME: which there are
#   RECALD_DATA=DIR              measured data of others; tests that need it skip where it is absent
#   RECALD_CI=1                  a test that skips fails the run, unless tests/skips.txt lists it
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"

. "$root/daemon/packages.sh"

begin=$(date +%s)
stage() {
  now=$(date +%s)
  [ -z "${name:-}" ] || echo "--- $name: $((now - since)) s"
  name=$1
  since=$now
  [ -z "$name" ] || echo "--- $name"
}

stage "Debian packages"
long=
[ "${1:-}" != "--long" ] || long="python3 clang-tidy"
# shellcheck disable=SC2086  # lists of words
install_packages $BUILD_PACKAGES $TEST_PACKAGES $PACKAGING_PACKAGES $long

if [ "${1:-}" = "--long" ]; then
  study=$root/tests/long/${2:-}.sh
  if [ -z "${2:-}" ] || [ ! -f "$study" ]; then
    echo "Long studies:" >&2
    for file in "$root"/tests/long/*.sh; do echo "  $(basename "$file" .sh)" >&2; done
    exit 2
  fi
  if [ "$2" != fuzz ] && [ "$2" != tidy ]; then  # which need another compiler, or none
    stage "build (release)"
    cmake --preset release >/dev/null
    cmake --build --preset release --target recald recald-sim --parallel "$(build_jobs)"
  fi
  stage "$2"
  sh "$study" "$root/.build/release"
  stage ""
  exit 0
fi

if [ "${1:-}" != "--plain" ]; then
  stage "format"
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
fi

failed=
logs=
part=all
# instrumented PRESET [OPTIONS OF CTEST…]: what leads from registers to months, built with a sanitizer
# and run.
instrumented() {
  preset=$1
  shift
  stage "$preset"
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset" --target ingestion_tests --parallel "$(build_jobs)"
  # All 300 kills happen below; under a sanitizer each takes ten times as long.
  logs="$logs .build/$preset/ctest.log"
  RECALD_KILLS=40 ctest --preset "$preset" -j $(($(nproc) + 1)) \
    --output-log "$root/.build/$preset/ctest.log" "$@" || failed="$failed $preset"
}

if [ "${1:-}" != "--plain" ]; then
  stage "fuzz (5 s each)"
  mkdir -p "$root/.build"
  fuzz_log=$root/.build/fuzz.log
  sh "$root/tests/fuzz/run.sh" 5 >"$fuzz_log" 2>&1 || failed="$failed fuzz"
  grep -a 'nothing found\|FOUND' "$fuzz_log" || true
  instrumented asan
  # What differs from the other scenarios by its dates, or by what comes late or not at all, has the same threads.
  instrumented tsan -E "ClockChange|GatewayClock|LateAfterClose|OutagesCostNoEnergy"
  part=rest  # what a sanitizer has watched need not run again
fi

stage "package (amd64)"
sh "$root/daemon/packaging/make_deb.sh" amd64 "$root/.build/packages" || failed="$failed package"

stage "build (dev: optimised, assertions on, warnings are errors)"
cmake --preset dev -DRECALD_PART=$part >/dev/null
cmake --build --preset dev --parallel "$(build_jobs)"
stage ""
echo "--- tests, after $(($(date +%s) - begin)) s for all of the above"
# Three at a time on two cores: whole runs of the daemon wait for their virtual clocks. Behind everything else: the
# daemon calibrates at the lowest priority and would wait for every other test to end. ctest's own summary is the
# last word, unless something failed before.
logs="$logs .build/dev/ctest.log"
nice -n 19 ctest --preset dev -j $(($(nproc) + 1)) --output-log "$root/.build/dev/ctest.log" ||
  failed="$failed tests"

# A test that skips shows nothing, in whichever run. Those of tests/skips.txt may; in CI (RECALD_CI=1) no other.
# shellcheck disable=SC2086  # a list of files
skipped=$(sed -n 's/.*Test  *#[0-9]*: \([^ ]*\).*\*\*\*Skipped.*/\1/p' $logs | sort -u)
if [ -n "$skipped" ]; then
  echo "Skipped:"
  printf '  %s\n' $skipped
  unexpected=$(printf '%s\n' $skipped | grep -v -E -x -f "$root/tests/skips.txt" || true)
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
