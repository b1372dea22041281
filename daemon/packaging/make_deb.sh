#!/bin/sh
# A Debian package of recald, of the sources as they are, for this Debian release.
#
#   make_deb.sh ARCH OUT_DIR    ARCH: amd64 or arm64; writes recald_VERSION_ARCH.deb and its SBOM
#
# Built in .build/packages, where headers and libraries of the architecture are unpacked too: nothing that is made
# depends on what is installed on this machine beyond compilers and packaging tools. The same commit gives the same bytes.
set -eu
arch=$1
packaging=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$packaging/../.." && pwd)
mkdir -p "$2"
out=$(cd "$2" && pwd)
. "$packaging/../packages.sh"

place=$root/.build/packages
sysroot=$place/sysroot-$arch
build=$place/build-$arch
work=$place/debian-$arch
triplet=$(dpkg-architecture -a"$arch" -qDEB_HOST_MULTIARCH 2>/dev/null)
SOURCE_DATE_EPOCH=$(git -C "$root" log -1 --format=%ct 2>/dev/null || stat -c %Y "$root/CHANGELOG.md")
export SOURCE_DATE_EPOCH
mkdir -p "$place"
sh "$packaging/make_sysroot.sh" "$arch" "$sysroot"

# To print its manual pages the program has to run.
emulator=
[ "$arch" = "$(dpkg --print-architecture)" ] || emulator="qemu-${triplet%%-*}-static;-L;$sysroot"
cmake -S "$root" -B "$build" --preset release -DRECALD_TESTS=OFF \
  -DRECALD_COMMIT="$(git -C "$root" rev-parse --short HEAD 2>/dev/null)" -DRECALD_UNIT_DIR=/lib/systemd/system \
  -DCMAKE_TOOLCHAIN_FILE="$packaging/sysroot.cmake" -DRECALD_TRIPLET="$triplet" -DCMAKE_SYSROOT="$sysroot" \
  -DCMAKE_CROSSCOMPILING_EMULATOR="$emulator" -DCMAKE_CXX_FLAGS="-ffile-prefix-map=$root/=" >/dev/null
cmake --build "$build" --target recald --parallel "$(build_jobs)"

rm -rf "$work"
mkdir -p "$work"
cp -r "$packaging/debian" "$work"
cd "$work"
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
{
  printf 'recald (%s) %s; urgency=medium\n\n  * What has changed is in NEWS.md.gz.\n\n' \
    "$version" "$(. /etc/os-release && echo "$VERSION_CODENAME")"
  printf ' -- %s  %s\n' "$(sed -n 's/^Maintainer: //p' debian/control)" "$(date -u -R -d "@$SOURCE_DATE_EPOCH")"
} >debian/changelog
# Variables of the architecture, as dpkg-buildpackage would set them.
eval "$(dpkg-architecture -a"$arch" -s 2>/dev/null)"
DH_QUIET=1 BUILD=$build SYSROOT=$sysroot debian/rules binary
deb=$out/recald_${version}_$arch.deb
[ "$place" = "$out" ] || mv "$place/recald_${version}_$arch.deb" "$deb"
# shellcheck disable=SC2046,SC2086  # lists of words
python3 "$packaging/make_sbom.py" "$deb" "$sysroot/var/lib/dpkg" "$root/adapters/report/package-lock.json" \
  $(dev_packages) >"${deb%.deb}.spdx.json"
echo "$deb"
