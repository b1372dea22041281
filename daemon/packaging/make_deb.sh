#!/bin/sh
# Debian packages of recald and of its simulator, of the sources as they are, for this Debian release.
#
#   make_deb.sh ARCH OUT_DIR    ARCH: amd64 or arm64; writes recald_VERSION_ARCH.deb, its SBOM,
#                               and recald-sim_VERSION_ARCH.deb
#
# For this machine's architecture it is the release build, which the demo and the benchmarks use too; for another one,
# headers and libraries are unpacked into .build/packages. The same commit, made with the same packages, gives the same
# bytes.
set -eu
arch=$1
packaging=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$packaging/../.." && pwd)
mkdir -p "$2"
out=$(cd "$2" && pwd)
. "$packaging/../packages.sh"

place=$root/.build/packages
work=$place/debian-$arch
triplet=$(dpkg-architecture -a"$arch" -qDEB_HOST_MULTIARCH 2>/dev/null)
SOURCE_DATE_EPOCH=$(git -C "$root" log -1 --format=%ct 2>/dev/null || stat -c %Y "$root/CHANGELOG.md")
export SOURCE_DATE_EPOCH
mkdir -p "$place"

set --
if [ "$arch" = "$(dpkg --print-architecture)" ]; then
  build=$root/.build/release
  sysroot=
  # Where the tests were built in it, they stay known: CMake deletes what it no longer knows.
  [ -f "$build/CMakeCache.txt" ] || set -- -DRECALD_TESTS=OFF
else
  build=$place/build-$arch
  sysroot=$place/sysroot-$arch
  sh "$packaging/make_sysroot.sh" "$arch" "$sysroot"
  # To print its manual pages the program has to run.
  set -- -DRECALD_TESTS=OFF -DCMAKE_TOOLCHAIN_FILE="$packaging/sysroot.cmake" -DRECALD_TRIPLET="$triplet" -DCMAKE_SYSROOT="$sysroot" \
    -DCMAKE_CROSSCOMPILING_EMULATOR="qemu-${triplet%%-*}-static;-L;$sysroot"
fi
cmake -S "$root" -B "$build" --preset release "$@" >/dev/null
cmake --build "$build" --target recald recald-sim --parallel "$(build_jobs)"

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
[ "$place" = "$out" ] || mv "$place/recald_${version}_$arch.deb" "$place/recald-sim_${version}_$arch.deb" "$out"
# shellcheck disable=SC2046,SC2086  # lists of words
python3 "$packaging/make_sbom.py" "$deb" "$sysroot/var/lib/dpkg" "$root/adapters/views/package-lock.json" \
  $(dev_packages) >"${deb%.deb}.spdx.json"
echo "$deb"
