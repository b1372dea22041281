#!/bin/sh
# sh tests/fuzz/run.sh SECONDS: builds the fuzz targets and runs each so long, two at a time.
#
# What they find besides coverage stays in .build/fuzz/findings, one file each; to see one again:
# .build/fuzz/tests/fuzz/NAME_fuzz FILE. New inputs are not kept: they are found again in a second.
set -eu
seconds=$1
root=$(cd "$(dirname "$0")/../.." && pwd)
build=$root/.build/fuzz
cd "$root"
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz

# run_target NAME: prints one line.
run_target() {
  grown=$(mktemp -d)
  log=$build/$1.log
  result=0
  "$build/tests/fuzz/$1_fuzz" -max_total_time="$seconds" -timeout=25 -rss_limit_mb=2048 \
    -artifact_prefix="$build/findings/$1-" "$grown" "$root/tests/fuzz/corpus/$1" >"$log" 2>&1 ||
    result=1
  rm -rf "$grown"
  if [ "$result" -eq 0 ]; then
    echo "$1: $(sed -n 's/^Done \([0-9]*\) runs.*/\1/p' "$log") inputs, nothing found"
  else
    echo "$1: FOUND: $(grep -aE -m 1 'property broken|runtime error|ERROR' "$log"); see $log"
    # On another machine the files are gone, and the next run draws other inputs.
    { grep -aE -m 12 '^ +#[0-9]' "$log"; grep -aE '^Base64|^SUMMARY' "$log"; } |
      cut -c 1-4000 | tr -d '\000-\010\013-\037'
  fi
  return "$result"
}

mkdir -p "$build/findings"
names=$(cd "$root/tests/fuzz/corpus" && ls)
failed=0
waiting=
for name in $names; do
  if [ -z "$waiting" ]; then
    run_target "$name" &
    waiting=$!
  else
    run_target "$name" || failed=1
    wait "$waiting" || failed=1
    waiting=
  fi
done
[ -z "$waiting" ] || wait "$waiting" || failed=1
exit "$failed"
