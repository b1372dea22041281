#!/bin/sh
# Runs the page daemon/packaging/gateway.md in a bare Debian 12. Needs root, for chroot.
#
#   gateway.sh DEB SIM PAGE    SIM: recald-sim, which is not packaged
set -eu
deb=$1
sim=$2
page=$3
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../../daemon/packaging/mirror.sh"
[ "$(id -u)" -eq 0 ] || { echo "needs root"; exit 77; }

arch=$(dpkg-deb --field "$deb" Architecture)
if [ -z "${INSIDE:-}" ]; then
  place=$(mktemp -d)
  trap 'rm -rf --one-file-system "$place"' EXIT
  emulated=
  [ "$arch" = "$(dpkg --print-architecture)" ] || emulated="python3 $here/emulated.py qemu-aarch64"
  INSIDE=$place $emulated sh "$0" "$deb" "$sim" "$page"
  exit
fi

place=$INSIDE
root=$place/root
debian_sources | mmdebstrap --quiet --mode=root --variant=minbase --architectures="$arch" --skip=check/qemu,cleanup/apt/lists,output/dev \
  "$(debian_release)" "$root" -
cp /etc/resolv.conf "$root/etc/"
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"  # packages start no services
chmod +x "$root/usr/sbin/policy-rc.d"

mkdir "$root/gateway" "$root/opt/sim"
cp "$deb" "$root/gateway/recald.deb"
dpkg-deb -R "$deb" "$place/next"
sed -i 's/^Version: .*/&.1/' "$place/next/DEBIAN/control"
dpkg-deb --root-owner-group -b "$place/next" "$root/gateway/recald-next.deb" >/dev/null
# The simulator with this machine's libraries, whatever the gateway has.
cp "$sim" "$root/opt/sim/recald-sim"
ldd "$sim" | sed -n 's/.*=> \(\/[^ ]*\).*/\1/p; s/^[[:space:]]*\(\/[^ ]*ld-linux[^ ]*\).*/\1/p' |
  xargs -I{} cp -L {} "$root/opt/sim/"
loader=$(basename "$(ls "$root"/opt/sim/ld-linux*)")
printf '#!/bin/sh\nexec /opt/sim/%s --library-path /opt/sim /opt/sim/recald-sim "$@"\n' "$loader" \
  >"$root/usr/local/bin/recald-sim"
chmod +x "$root/usr/local/bin/recald-sim"

awk '/^```sh$/ { inside = 1; next } /^```/ { inside = 0 } inside' "$page" >"$root/gateway/page.sh"
[ -s "$root/gateway/page.sh" ] || { echo "$page has no sh block"; exit 1; }
cat >"$root/gateway/run.sh" <<'END'
set -eu
mount -t proc proc /proc
cd /gateway
trap 'echo "--- failed; what the programs said:"; tail -n 15 ./*.log' ERR
set -x
. ./page.sh
END
# Whatever the page starts is in a namespace of processes of its own, and ends with it. Where no devices could be made,
# as by the root of a user namespace, they are this machine's.
# shellcheck disable=SC2016  # for the shell inside
unshare --mount --pid --fork --kill-child --propagation private sh -c '
  [ -c "$1/dev/null" ] || mount --rbind /dev "$1/dev"
  exec chroot "$1" env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 bash -E /gateway/run.sh' sh "$root"
