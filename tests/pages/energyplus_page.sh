#!/bin/sh
# A page that needs EnergyPlus, which the tests of its adapter have installed; skips (77) where they could not.
#
#   energyplus_page.sh PAGE.md ENVIRONMENT FOLDER…   as run_page.sh; the environment is the Python package's
set -eu
page=$1
environment=$2
shift 2
payload=$(dirname "$(find "$environment/lib" -path '*/payload/energyplus' 2>/dev/null | head -n 1)")
if [ ! -f "$environment/installed" ] || [ ! -f "$payload/energyplus" ]; then
  echo "EnergyPlus is not installed"
  exit 77
fi
chmod u+x "$payload/energyplus"
exec bash "$(dirname "$0")/run_page.sh" "$page" "$@" "$payload"
