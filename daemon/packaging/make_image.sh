#!/bin/sh
# An OCI image, as a layout in a tar file: a small Debian with the package in it. Needs root.
#
#   make_image.sh DEB OUT.tar     DEB as made by make_deb.sh, for this machine's architecture
#
# It runs `recald` as the user recald; give it site files in /etc/recald and keep /var/lib/recald on a volume.
set -eu
deb=$(realpath "$1")
out=$2
packaging=$(cd "$(dirname "$0")" && pwd)
. "$packaging/mirror.sh"
version=$(dpkg-deb --field "$deb" Version)
arch=$(dpkg-deb --field "$deb" Architecture)
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git -C "$packaging" log -1 --format=%ct)}
export SOURCE_DATE_EPOCH

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
layout=$work/layout
umoci init --layout "$layout"
umoci new --image "$layout:$version"
umoci unpack --image "$layout:$version" "$work/bundle"
# No service manager runs in it: users and folders are made by systemd's tools for that alone.
debian_sources | mmdebstrap --quiet --variant=essential --architectures="$arch" \
  --hook-dir=/usr/share/mmdebstrap/hooks/file-mirror-automount \
  --include="systemd-standalone-sysusers,systemd-standalone-tmpfiles,ca-certificates,$deb" \
  --dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-exclude=/usr/share/man/*' \
  --dpkgopt='path-exclude=/usr/share/locale/*' "$(debian_release)" "$work/rootfs" -
rm -rf "$work/rootfs/dev"
cp -a "$work/rootfs/." "$work/bundle/rootfs"
created=$(date -u -d "@$SOURCE_DATE_EPOCH" +%Y-%m-%dT%H:%M:%SZ)
umoci repack --image "$layout:$version" --history.created "$created" "$work/bundle"
umoci config --image "$layout:$version" --created "$created" --history.created "$created" --architecture "$arch" \
  --config.entrypoint /usr/bin/recald --config.cmd --help --config.user recald \
  --config.workingdir /var/lib/recald --config.volume /var/lib/recald
umoci gc --layout "$layout"
tar --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner -C "$layout" -cf "$out" .
