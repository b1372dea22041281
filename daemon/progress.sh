# Says where a long step is. Sourced by the scripts.
#
# with_progress WHAT LOG COMMAND…  runs the command with its output in LOG; says how many of its steps are done and
#                                  about how long the rest takes: on a terminal each second on one line, else every
#                                  half minute. Ninja's "[3/80]" and ctest's "3/80 Test" are understood.

# minutes SECONDS: "3:07"
minutes() { printf '%d:%02d' $(($1 / 60)) $(($1 % 60)); }

# told_progress WHAT LOG SECONDS: one line without its end.
told_progress() {
  steps=$(tail -c 4000 "$2" 2>/dev/null | sed -n 's/^ *\[*\([0-9][0-9]*\)\/\([0-9][0-9]*\)[] ].*/\1 \2/p' | tail -n 1)
  done=${steps% *}
  total=${steps#* }
  printf '%s: ' "$1"
  [ -z "$steps" ] || printf '%s of %s, ' "$done" "$total"
  printf '%s gone' "$(minutes "$3")"
  # The first steps, such as reading headers, say nothing about the rest.
  [ -z "$steps" ] || [ "$done" -lt 5 ] || [ "$done" -ge "$total" ] ||
    printf ', about %s left' "$(minutes $(($3 * (total - done) / done)))"
}

with_progress() {
  what=$1
  log=$2
  shift 2
  : >"$log"
  began=$(date +%s)
  told=$began
  "$@" >"$log" 2>&1 &
  running=$!
  trap 'kill $running 2>/dev/null; exit 130' INT
  trap 'kill $running 2>/dev/null; exit 143' TERM
  while kill -0 $running 2>/dev/null; do
    sleep 1
    now=$(date +%s)
    if [ -t 1 ]; then
      printf '\r\033[K  %s' "$(told_progress "$what" "$log" $((now - began)))"
    elif [ $((now - told)) -ge 30 ]; then
      told=$now
      echo "  $(told_progress "$what" "$log" $((now - began)))"
    fi
  done
  [ ! -t 1 ] || printf '\r\033[K'
  result=0
  wait $running || result=$?
  trap - INT TERM
  return $result
}
