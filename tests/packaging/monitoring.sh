#!/bin/sh
# The alert rules and the dashboard, with a real Prometheus that scrapes a real daemon.
#
#   monitoring.sh RECALD FOLDER   Debian's prometheus is unpacked in FOLDER, not installed
#
# Exit 0 passed, 1 failed, 77 skipped (no Prometheus to be had).
set -eu
recald=$1
folder=$2
here=$(cd "$(dirname "$0")" && pwd)
fetch() {
  (cd "$folder" && apt-get download prometheus && dpkg -x prometheus_*.deb .) >/dev/null 2>&1
}
if [ ! -x "$folder/usr/bin/promtool" ]; then
  mkdir -p "$folder"
  as_root=
  [ "$(id -u)" -eq 0 ] || as_root="sudo -n"
  # The lists of packages may be missing: nothing else had to be installed.
  fetch || { $as_root apt-get update -q >/dev/null 2>&1 && fetch; } ||
    { echo "prometheus cannot be downloaded"; exit 77; }
fi
exec python3 "$here/monitoring.py" "$recald" "$folder/usr/bin" \
  "$here/../../daemon/packaging/monitoring" "$here/alerts_test.yml"
