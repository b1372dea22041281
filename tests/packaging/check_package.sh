#!/bin/sh
# What is in a package: lintian has nothing to say, it is small, its programs are hardened, and the unit in it is sandboxed.
#
#   check_package.sh DEB RECALD    RECALD: a program that runs here, for the unit's check
set -eu
deb=$1
recald=$2
here=$(cd "$(dirname "$0")" && pwd)
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
fail() {
  echo "$1"
  exit 1
}

said=$(lintian --allow-root --fail-on error,warning "$deb" 2>&1) || fail "$said"
[ -z "$said" ] || fail "$said"

dpkg-deb -x "$deb" "$place/root"
cd "$place/root"
size=$(find . -type f -printf '%s\n' | awk '{ sum += $1 } END { print sum }')
[ "$size" -le 9750000 ] || fail "$size bytes installed, more than 9.75 MB"

# Hardened as dpkg-buildflags asks: full RELRO, position independent, stack protector, FORTIFY.
for program in $(find . -path '*/bin/*' -type f); do
  readelf -Wl "$program" | grep -q GNU_RELRO || fail "$program: no RELRO"
  readelf -Wd "$program" | grep -q 'BIND_NOW\|FLAGS.*NOW' || fail "$program: symbols are bound late, so RELRO is not full"
  readelf -Wh "$program" | grep -q 'Type: *DYN' || fail "$program: not position independent"
  readelf -W --dyn-syms "$program" >"$place/symbols"
  grep -q __stack_chk_fail "$place/symbols" || fail "$program: no stack protector"
  grep '__[a-z]*_chk' "$place/symbols" | grep -qv __stack_chk_fail || fail "$program: nothing is fortified"
done
[ -f usr/bin/recald ] || exit 0  # the simulator's package has no more

for command in $("$recald" --help | sed -n 's/^  \([a-z]*\)  .*/\1/p'); do
  page=usr/share/man/man1/recald-$command.1.gz
  [ -f "$page" ] || fail "no $page"
  said=$(gzip -dc "$page" | LC_ALL=C.UTF-8 MANWIDTH=100 man --warnings -l - 2>&1 >/dev/null)
  [ -z "$said" ] || fail "$page: $said"
done
for file in usr/share/bash-completion/completions/recald usr/share/zsh/vendor-completions/_recald \
  usr/share/fish/vendor_completions.d/recald.fish usr/lib/sysusers.d/recald.conf usr/lib/tmpfiles.d/recald.conf \
  usr/share/doc/recald/copyright usr/share/doc/recald/examples/every-key.toml \
  usr/share/doc/recald/examples/monitoring/recald-alerts.yml; do
  [ -s "$file" ] || fail "no $file"
done
for unit in recald@.service recald-worker@.service; do
  sh "$here/check_unit.sh" "lib/systemd/system/$unit" "$recald"
done
echo "$size bytes installed"
