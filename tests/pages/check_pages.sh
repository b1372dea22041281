#!/bin/sh
# Writes every sample page and has them looked at in headless Chromium.
#
#   sh check_pages.sh WRITE_SAMPLE_REPORT WRITE_SAMPLE_STATUS NODE_MODULES [NAME…]   some of the pages
#   PICTURES=DIR                                                                     keeps screenshots there
#
# Exit 0 passed, 1 failed, 77 skipped (no Chromium here).
set -eu
write=$1
write_status=$2
modules=$3
shift 3
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
[ "$#" -gt 0 ] ||
  set -- full design readings-only meters young-meters diagnosis empty-handed drift savings saved now meter months model data events
for name in "$@"; do
  case $name in
    now | meter | months | model | data | events) "$write_status" "$name" "$folder/$name.html" ;;
    *) "$write" "$name" "$folder/$name.html" ;;
  esac
done
status=0
node "$here/browser/check_pages.mjs" --modules "$modules" ${PICTURES:+--pictures "$PICTURES"} \
  "$folder"/*.html || status=$?
exit "$status"
