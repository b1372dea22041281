#!/bin/sh
# Install, upgrade, remove and purge in a bare Debian. Needs root, for chroot.
#
#   package_life.sh DEB
set -eu
deb=$1
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../../daemon/packaging/mirror.sh"
. "$here/small_site.sh"
[ "$(id -u)" -eq 0 ] || { echo "needs root"; exit 77; }

place=$(mktemp -d)
trap 'rm -rf --one-file-system "$place"' EXIT
root=$place/root
fail() {
  echo "$1"
  exit 1
}
# systemd's tools look into /proc.
inside() {
  unshare --mount --propagation private sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" env DEBIAN_FRONTEND=noninteractive "$@"' \
    "$root" "$@"
}
install() { inside apt-get install -q -y --no-install-recommends "$@" >"$place/log" 2>&1 || fail "$(cat "$place/log")"; }
# is MODE:OWNER:GROUP PATH
is() { [ "$(inside stat -c %a:%U:%G "$2")" = "$1" ] || fail "$2 is $(inside stat -c %a:%U:%G "$2"), not $1"; }

debian_sources | mmdebstrap --quiet --variant=minbase --skip=cleanup/apt/lists "$(debian_release)" "$root" -
cp /etc/resolv.conf "$root/etc/"
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"
chmod +x "$root/usr/sbin/policy-rc.d"
version=$(dpkg-deb --field "$deb" Version)
dpkg-deb -R "$deb" "$place/old"
sed -i 's/^Version: .*/Version: 0.0.1/' "$place/old/DEBIAN/control"
dpkg-deb --root-owner-group -b "$place/old" "$root/tmp/old.deb" >/dev/null
cp "$deb" "$root/tmp/new.deb"

echo "installed"
install /tmp/old.deb systemd-standalone-sysusers systemd-standalone-tmpfiles
is 750:root:recald /etc/recald
is 750:recald:recald /var/lib/recald
small_site "$root/etc/recald"
inside chown recald /etc/recald/readings.csv
[ "$(inside /usr/bin/recald --version)" = "$version" ] || fail "another version: $(inside /usr/bin/recald --version)"
inside setpriv --reuid=recald --regid=recald --init-groups \
  recald replay -q /etc/recald/site.toml --out /var/lib/recald/tower >/dev/null
[ -s "$root/var/lib/recald/tower/months.csv" ] || fail "no months"

echo "upgraded"
install /tmp/new.deb
[ "$(inside dpkg-query -W -f '${Version}' recald)" = "$version" ] || fail "not upgraded"
is 750:root:recald /etc/recald
[ -s "$root/var/lib/recald/tower/months.csv" ] && [ -s "$root/etc/recald/site.toml" ] || fail "an upgrade lost files"

echo "removed"
inside apt-get remove -q -y recald >"$place/log" 2>&1 || fail "$(cat "$place/log")"
[ ! -e "$root/usr/bin/recald" ] || fail "removed, and still there"
[ -s "$root/var/lib/recald/tower/months.csv" ] && [ -s "$root/etc/recald/site.toml" ] || fail "a removal lost files"

echo "purged"
install /tmp/new.deb
wants=$root/etc/systemd/system/multi-user.target.wants
mkdir -p "$wants"
ln -s /lib/systemd/system/recald@.service "$wants/recald@tower.service"
inside apt-get purge -q -y recald >"$place/log" 2>&1 || fail "$(cat "$place/log")"
[ -s "$root/etc/recald/site.toml" ] || fail "a purge took a site file, which the package did not make"
rm -r "$root/etc/recald" "$root/tmp/old.deb" "$root/tmp/new.deb"
left=$(cd "$root" && find . -xdev -name '*recald*' ! -path './proc/*')
[ -z "$left" ] || fail "left behind: $left"
echo "all as it was"
