#!/bin/sh
# Whether files of a blind population tell what is hidden in its cases: from sizes and times of files and the numbers and words of site
# files alone, is "something hidden" told from "nothing", and one class of effects from another where use and plant are the
# same? Better than chance means that a truth leaks. Where there are twins, site files and weather must be theirs.
#   POPULATION  folder with cases/ and answers/ (default: a development population of our own world, made anew)
#   SEED        of that population (default 1)
# Argument: the build folder.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
if [ -z "${POPULATION:-}" ]; then
  POPULATION=$(mktemp -d)
  cmake --build "$1" --target blind_make >/dev/null
  "$1/tests/blind/blind_make" --population development --seed "${SEED:-1}" --twins --out "$POPULATION"
fi
exec python3 "$here/leak.py" "$POPULATION"
