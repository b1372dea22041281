#!/bin/sh
# Opens the sample reports in headless Chromium and checks that every figure was drawn.
#
#   sh browser_test.sh WRITE_SAMPLE_REPORT
#
# Exit 0 passed, 1 failed, 77 skipped (no Chromium here).
set -eu

browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [ -z "$browser" ]; then
  echo "skipped: no chromium, chromium-browser or google-chrome on the PATH"
  exit 77
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failed=0
complain() {
  echo "failed: $1"
  failed=1
}

# Virtual time ends when the page's own timers have run, so nothing here waits by the clock.
open_page() { # open_page NAME: report.html -> dom.html, log.txt in $folder/NAME
  "$browser" --headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking \
    --disable-component-update --disable-default-apps --disable-sync --disable-extensions \
    --user-data-dir="$folder/$1/profile" --window-size=1280,1000 --virtual-time-budget=30000 \
    --enable-logging=stderr --dump-dom "file://$folder/$1/report.html" \
    >"$folder/$1/dom.html" 2>"$folder/$1/log.txt"
}

expect() { # expect NAME TEXT WHAT
  grep -q -F -e "$2" "$folder/$1/dom.html" || complain "$1: $3"
}

check_figures() { # check_figures WRITER NAME
  mkdir "$folder/$2"
  "$1" "$2" "$folder/$2/report.html"
  open_page "$2"
  # The embedded script mentions the attribute too; only places in the page have an index.
  figures=$(grep -o 'data-figure="[a-z]*" data-index=' "$folder/$2/report.html" | wc -l)
  drawn=$(grep -o '<svg ' "$folder/$2/dom.html" | wc -l)
  expect "$2" 'data-ready="true"' "the script did not come to its end"
  expect "$2" "data-charts=\"$figures\"" "not all of $figures figures were drawn"
  expect "$2" 'data-errors="0"' "a figure reported an error"
  [ "$drawn" -eq "$figures" ] || complain "$2: $drawn drawings for $figures figures"
  if grep -E 'CONSOLE.*(Content Security Policy|Refused|Uncaught|figure )' "$folder/$2/log.txt"; then
    complain "$2: the browser complained, see above"
  fi
  echo "$2: $drawn of $figures figures drawn"
}

check_figures "$1" full
expect full '>limit 15 %</text>' "the limit of CV(RMSE) is not labelled"
expect full '>Validation</text>' "the validation months are not labelled"
expect full '<image ' "the load calendar has no picture"
expect full 'Save all hours as CSV' "the hourly values cannot be saved"
check_figures "$1" readings-only
check_figures "$1" design
expect design '>36</text>' "months are not labelled by their numbers"
expect design '>kW</text>' "the peaks have no unit"
check_figures "$1" diagnosis
expect diagnosis '>Before</text>' "the maps before are not labelled"
expect diagnosis '>Something else</text>' "the unknown does not stand among the candidates"
check_figures "$1" unconfirmed
check_figures "$1" empty-handed
check_figures "$1" drift
expect drift '>Alarm</text>' "the months of the alarm are not labelled"

exit "$failed"
