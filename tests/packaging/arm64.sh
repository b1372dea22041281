#!/bin/sh
# The package for arm64, installed in a bare Debian of that architecture under qemu: it computes the months that this
# machine's program does, byte for byte.
#
#   arm64.sh DEB RECALD
set -eu
deb=$(realpath "$1")
recald=$2
here=$(cd "$(dirname "$0")" && pwd)
[ "$(id -u)" -eq 0 ] || { echo "needs root"; exit 77; }

if [ -z "${INSIDE:-}" ]; then
  place=$(mktemp -d)
  trap 'rm -rf --one-file-system "$place"' EXIT
  INSIDE=$place python3 "$here/emulated.py" qemu-aarch64 sh "$0" "$deb" "$recald"
  exit
fi

. "$here/../../daemon/packaging/mirror.sh"
. "$here/small_site.sh"
root=$INSIDE/root
debian_sources | mmdebstrap --quiet --mode=root --variant=essential --architectures=arm64 --skip=check/qemu,output/dev \
  --hook-dir=/usr/share/mmdebstrap/hooks/file-mirror-automount \
  --include="systemd-standalone-sysusers,systemd-standalone-tmpfiles,$deb" "$(debian_release)" "$root" - \
  >"$INSIDE/log" 2>&1 || { cat "$INSIDE/log"; exit 1; }

version=$(dpkg-deb --field "$deb" Version)
said=$(chroot "$root" /usr/bin/recald --version)
[ "$said" = "$version" ] || { echo "--version: $said, not $version"; exit 1; }
small_site "$INSIDE/site"
cp -r "$INSIDE/site" "$root/tmp/site"
chroot "$root" /usr/bin/recald replay -q /tmp/site/site.toml --out /tmp/out >/dev/null
"$recald" replay -q "$INSIDE/site/site.toml" --out "$INSIDE/out" >/dev/null
[ "$(wc -l <"$INSIDE/out/months.csv")" -ge 3 ] || { echo "no months"; exit 1; }
for months in "$root/tmp/out/months.csv" "$INSIDE/out/months.csv"; do
  sed -i 's/,[^,]*$//' "$months"  # the release of the time zones, which may be another there
done
cmp "$root/tmp/out/months.csv" "$INSIDE/out/months.csv"
echo "the same months"
