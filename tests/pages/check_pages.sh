#!/bin/sh
# Writes every sample page and has them looked at in headless Chromium.
#
#   sh check_pages.sh WRITE_SAMPLE_REPORT NODE_MODULES [NAME…]   some of the pages
#   PICTURES=DIR                                                 keeps screenshots there
#
# Exit 0 passed, 1 failed, 77 skipped (no Chromium here).
set -eu
write=$1
modules=$2
shift 2
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
[ "$#" -gt 0 ] ||
  set -- full readings-only meters young-meters diagnosis empty-handed drift
for name in "$@"; do
  "$write" "$name" "$folder/$name.html"
done
status=0
node "$here/browser/check_pages.mjs" --modules "$modules" ${PICTURES:+--pictures "$PICTURES"} \
  "$folder"/*.html || status=$?
exit "$status"
