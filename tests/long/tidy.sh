#!/bin/sh
# clang-tidy with the checks of .clang-tidy, on the sources that clang 14 can compile: all of core, and
# those of the adapters and the daemon that use neither coroutines nor std::views. Ten seconds of a core
# a file, so an hour of one core: too long for every run. Argument: the build folder, for its generated
# headers.
#
#   sh tests/run.sh --long tidy
#   ONLY=core/drift sh tests/run.sh --long tidy    files below that folder
set -eu
cmake --preset release >/dev/null
report=$(mktemp)
trap 'rm -f "$report"' EXIT
files=$(find "${ONLY:-.}" -path './.build' -prune -o -name '*.cpp' -print | sed 's#^\./##' |
  grep -E '^(core|adapters|daemon)/' | sort | xargs grep -LE 'co_await|std::views|asio|beast' || true)  # which says no when it lists all
# -w: warnings are GCC's business, which builds with -Werror.
# shellcheck disable=SC2086  # a list of words
if printf '%s\n' $files | xargs -P "$(nproc)" -n 1 sh -c '
  clang-tidy --quiet "$2" -- -std=c++20 -w -I. -I"$1/generated" -isystem /usr/include/eigen3 \
    -DHAS_STRING_VIEW=1 -DONLY_C_LOCALE=1 -DUSE_OS_TZDB=1 2>/dev/null' tidy "$1" >"$report"; then
  echo "clang-tidy found nothing in $(echo "$files" | wc -l) files."
else
  cat "$report"
  echo "clang-tidy found the above; the check's name is in brackets." >&2
  exit 1
fi
