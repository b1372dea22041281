#!/bin/sh
# Draws daemon/picture.png, the picture in the README, from the pages of the demo. Needs Chromium.
set -eu
cd "$(dirname "$0")/.."
[ -f .demo/diagnosis.html ] || sh daemon/demo.sh
node daemon/picture.mjs .demo daemon/picture.png
echo "Drew daemon/picture.png."
