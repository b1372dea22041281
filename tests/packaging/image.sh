#!/bin/sh
# The image of a package, run by crun: the program, and the months of a small site. Needs root.
#
#   image.sh DEB
set -eu
deb=$1
here=$(cd "$(dirname "$0")" && pwd)
. "$here/small_site.sh"
[ "$(id -u)" -eq 0 ] || { echo "needs root"; exit 77; }

place=$(mktemp -d)
trap 'rm -rf --one-file-system "$place"' EXIT
version=$(dpkg-deb --field "$deb" Version)
sh "$here/../../daemon/packaging/make_image.sh" "$deb" "$place/image.tar"
mkdir "$place/layout"
tar -C "$place/layout" -xf "$place/image.tar"
umoci unpack --image "$place/layout:$version" "$place/bundle" >/dev/null 2>&1
small_site "$place/site"
chmod -R a+rX "$place/site"

# contained ARGUMENTS…: recald with them, as the image says, but for the terminal.
contained() {
  python3 - "$place" "$@" <<'END'
import json, pathlib, sys
place, *arguments = sys.argv[1:]
file = pathlib.Path(place, "bundle/config.json")
config = json.loads(file.read_text())
process = config["process"]
assert process["args"][0] == "/usr/bin/recald", process
assert process["user"]["uid"] != 0, process
process.update(terminal=False, args=["/usr/bin/recald", *arguments])
config["mounts"] = [one for one in config["mounts"] if one["destination"] not in ("/sys/fs/cgroup", "/var/lib/recald")]
config["mounts"].append({"destination": "/etc/recald", "type": "bind", "source": f"{place}/site", "options": ["rbind", "ro"]})
file.write_text(json.dumps(config))
END
  # crun knows hierarchies of one kind alone; where this machine mixes two, it sees none of the second.
  unshare --mount --propagation private sh -c '
    ! mountpoint -q /sys/fs/cgroup/unified || umount /sys/fs/cgroup/unified
    exec crun --cgroup-manager=disabled --root "$1/state" run --bundle "$1/bundle" recald-test' sh "$place"
}

said=$(contained --version)
[ "$said" = "$version" ] || { echo "--version: $said, not $version"; exit 1; }
contained replay -q /etc/recald/site.toml --out /var/lib/recald/tower
cat "$place/bundle/rootfs/var/lib/recald/tower/months.csv"
[ "$(grep -c '2023-0[12]' "$place/bundle/rootfs/var/lib/recald/tower/months.csv")" -ge 2 ] || {
  echo "not two months"
  exit 1
}
