#!/bin/sh
# Headers and libraries of an architecture, unpacked from this machine's Debian mirror and not installed. The machine's
# own packages and architectures stay as they are.
#
#   make_sysroot.sh ARCH DIR    ARCH as Debian calls it: amd64, arm64
#
# DIR/var/lib/dpkg is a package database in which every file has DIR before its path, so that dpkg-shlibdeps finds
# the package of a library there (--admindir). What is there is kept while the list of packages is the same.
set -eu
arch=$1
dir=$2
packaging=$(cd "$(dirname "$0")" && pwd)
. "$packaging/../packages.sh"
. "$packaging/mirror.sh"

# And the compiler's library.
packages=$(dev_packages | paste -sd,),libstdc++-$(g++ -dumpversion)-dev
[ "$(cat "$dir/made-of" 2>/dev/null)" != "$packages" ] || exit 0

rm -rf "$dir"
mkdir -p "$dir"
dir=$(cd "$dir" && pwd)
debian_sources | mmdebstrap --quiet --variant=extract --architectures="$arch" --include="$packages" \
  --skip=cleanup/apt "$(debian_release)" "$dir" -

# Links from / would leave the folder.
find "$dir" -type l -lname '/*' | while read -r link; do
  ln -sfn "$(realpath -m --relative-to "$(dirname "$link")" "$dir$(readlink "$link")")" "$link"
done

database=$dir/var/lib/dpkg
rm -rf "$database"
mkdir -p "$database/info" "$database/updates" "$database/triggers"
echo 1 >"$database/info/format"
printf '%s\n' "$arch" >"$database/arch"
for deb in "$dir"/var/cache/apt/archives/*.deb; do
  name=$(dpkg-deb --field "$deb" Package)
  [ "$(dpkg-deb --field "$deb" Multi-Arch)" != same ] || name=$name:$arch
  control=$dir/control
  dpkg-deb --control "$deb" "$control"
  for file in shlibs symbols; do
    [ ! -f "$control/$file" ] || cp "$control/$file" "$database/info/$name.$file"
  done
  dpkg-deb --fsys-tarfile "$deb" | tar -t | sed -n "s#^\.\(/.*[^/]\)\$#$dir\1#p" >"$database/info/$name.list"
  { sed '1a Status: install ok installed' "$control/control"; echo; } >>"$database/status"
  rm -r "$control"
done
rm -rf "$dir"/var/cache/apt "$dir"/var/lib/apt
printf '%s\n' "$packages" >"$dir/made-of"
