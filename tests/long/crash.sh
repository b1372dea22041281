#!/bin/sh
# The gateway is killed more than 10 000 times and the power goes more than 10 000 times: in steady running,
# while it opens, recovers, reloads, backs up and ends jobs. Each time the store is opened as the daemon does:
# nothing that was acknowledged is lost, and the energy is equal. Some 40 minutes on one core; a part that has
# passed says so in crash.txt in the build folder, and the next run goes on behind it, until a program is built
# anew. RECALD_CRASH_SHARE=10: a tenth of it. Argument: the build folder.
set -eu
share=${RECALD_CRASH_SHARE:-1}
passed=$1/crash.txt
tests=$1/tests/daemon_tests
[ ! -w /dev/shm ] || export TMPDIR=/dev/shm  # no test needs the machine's disk, and many would wait for it
cmake --build "$1" --target daemon_tests recald
[ ! "$tests" -nt "$passed" ] || rm -f "$passed"

# part NAME FILTER [VARIABLE=VALUE…]
part() {
  name=$1 filter=$2
  shift 2
  if grep -q "^$name:" "$passed" 2>/dev/null; then
    return
  fi
  begin=$(date +%s)
  env "$@" "$tests" --gtest_brief=1 --gtest_filter="$filter" || {
    echo "$name failed; again: env $* $tests --gtest_filter='$filter'" >&2
    exit 1
  }
  echo "$name: passed in $(($(date +%s) - begin)) s" | tee -a "$passed"
}

# Every step of opening, of commits, of a recovery and of half an hour of all that a daemon does: an error that
# passes or lasts, a signal, a kill.
all=RECALD_ALL_EDGES=1
[ "$share" = 1 ] || all=RECALD_SEED=2
part "every step of commits" 'Crash.AtEveryStep*' RECALD_SEED=1
part "every step of a recovery" 'RecoveryEdges.*-*PowerCut*' "$all"
part "every step of a life" '*LifeEdges.*' "$all"

# 2 000 kills in steady running, 8 000 of a daemon that also opens, reloads, backs up and works all the time,
# half of them with a disk that spoils pages; 4 000 power cuts in steady running, 3 000 in a recovery and
# 4 000 in such a life.
for seed in 1 2 3 4 5 6 7 8; do
  few=$((500 / share))
  part "$few kills of a life, seed $seed" 'LifeKills.AtAnyMoment*' \
    RECALD_SEED=$seed RECALD_EDGE_KILLS=$few
  part "$few kills with a spoilt store, seed $seed" 'LifeKills.OfASpoilt*' \
    RECALD_SEED=$seed RECALD_EDGE_KILLS=$few
  part "$few power cuts of a life, seed $seed" 'LifePowerCuts.AtAnyMoment*' \
    RECALD_SEED=$seed RECALD_EDGE_CUTS=$few
  [ "$seed" -le 4 ] || continue
  part "$few kills in a month, seed $seed" 'Crash.AMonthOfKills*' \
    RECALD_SEED=$seed RECALD_KILLS=$few
  many=$((1000 / share))
  part "$many power cuts, seed $seed" 'PowerCut.LosesNothing*' \
    RECALD_SEED=$seed RECALD_CUTS=$many
  some=$((750 / share))
  part "$some power cuts of a recovery, seed $seed" 'RecoveryEdges.APowerCut*' \
    RECALD_SEED=$seed RECALD_EDGE_CUTS=$some
done
real=$((100 / share))
part "$real kills of the program" 'KillCommand.*' RECALD_REAL_KILLS=$real
cat "$passed"
