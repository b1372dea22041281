#!/bin/sh
# The unit file: systemd understands it and finds its sandbox good (exposure at most 2.0 of 10), and its memory has a limit.
#
#   check_unit.sh UNIT PROGRAM
set -eu
unit=$1
program=$2
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
# The program is not installed here; an instance is what can be verified of a template.
sed "s#/usr/bin/recald#$program#" "$unit" > "$place/recald@tower-3.service"

said=$(systemd-analyze verify "$place/recald@tower-3.service" 2>&1) || { echo "$said"; exit 1; }
[ -z "$said" ] || { echo "$said"; exit 1; }
grep -q "^MemoryMax=[1-9]" "$unit" || { echo "$unit has no MemoryMax"; exit 1; }
# The threshold counts in tenths.
said=$(systemd-analyze security --offline=true --threshold=20 "$place/recald@tower-3.service") || {
  echo "$said"
  exit 1
}
echo "$said" | tail -n 1
