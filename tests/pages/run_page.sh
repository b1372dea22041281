#!/bin/bash
# Runs a page as its reader would: all its sh blocks, in order, in one shell.
#
#   run_page.sh PAGE.md FOLDER…   the folders hold the programs that the page uses
#
# Ends with the first command that fails; what was started in the background ends with it.
set -eu
page=$1
shift
folders=$(IFS=:; echo "$*")
PATH=$folders:$PATH
export PATH

place=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; wait; rm -rf "$place"' EXIT
script=$place/page.sh
awk '/^```sh$/ { inside = 1; next } /^```/ { inside = 0 } inside' "$page" > "$script"
[ -s "$script" ] || { echo "$page has no sh block"; exit 1; }

cd "$place"
set -o pipefail
# Sourced, so that what the page starts is ours to stop.
trap 'echo "--- failed; what the programs said:"; tail -n 20 "$place"/*/*.log || true' ERR
set -x
. "$script"
