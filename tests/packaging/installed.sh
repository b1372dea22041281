#!/bin/sh
# `cmake --install` into a folder: the program runs from there, the unit names it.
#
#   installed.sh BUILD
set -eu
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cmake --install "$1" --prefix "$place" --strip >/dev/null
"$place/bin/recald" --version
grep -q "^ExecStart=$place/bin/recald run /etc/recald/%i.toml$" "$place/lib/systemd/system/recald@.service"
for file in lib/sysusers.d/recald.conf lib/tmpfiles.d/recald.conf share/man/man1/recald-calibrate.1 \
  share/bash-completion/completions/recald share/zsh/site-functions/_recald share/doc/recald/LICENSE; do
  [ -s "$place/$file" ] || { echo "no $file"; exit 1; }
done
