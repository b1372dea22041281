#!/bin/sh
# Draws daemon/report.png, the picture in the README: the top of the demo's report. Needs Chromium.
set -eu
cd "$(dirname "$0")/.."
[ -f .demo/report.html ] || sh daemon/demo.sh
for name in chromium chromium-browser google-chrome; do
  browser=$(command -v "$name") && break
done
[ -n "$browser" ] || { echo "daemon/picture.sh: install chromium first" >&2; exit 1; }
"$browser" --headless --no-sandbox --disable-gpu --hide-scrollbars --virtual-time-budget=10000 \
  --window-size=1000,1120 --screenshot="$PWD/daemon/report.png" "file://$PWD/.demo/report.html" 2>/dev/null
echo "Drew daemon/report.png."
