#!/bin/sh
# The package for arm64 under qemu: built, looked at, its months compared with this machine's, and the whole page of a
# gateway in a bare Debian of that architecture. What is built is kept in .build/packages, so that it can go on.
#
#   arm64.sh BUILD
set -eu
build=$(realpath "$1")
root=$(cd "$(dirname "$0")/../.." && pwd)
out=$root/.build/packages
sh "$root/daemon/packaging/make_deb.sh" arm64 "$out"
deb=$(ls "$out"/recald_*_arm64.deb)
sh "$root/tests/packaging/check_package.sh" "$deb" "$build/daemon/recald"
sh "$root/tests/packaging/arm64.sh" "$deb" "$build/daemon/recald"
sh "$root/tests/packaging/gateway.sh" "$deb" "$build/simulators/recald-sim" "$root/daemon/packaging/gateway.md"
echo "the gateway's page, on arm64"
