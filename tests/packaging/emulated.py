"""Runs a command where programs of another architecture run too, by qemu-user-static.

    emulated.py QEMU COMMAND…     such as emulated.py qemu-aarch64 sh

Where the kernel does not know the emulator it is registered for this command alone, in a user namespace: nothing is
left on the machine. Exit 77 where neither is possible (it needs root, and Linux 6.7 or a registered emulator).
"""
import ctypes
import os
import pathlib
import sys

name, *command = sys.argv[1:]
CLONE_NEWNS, CLONE_NEWUSER = 0x20000, 0x10000000
UIDS = 65536
binfmt = pathlib.Path("/proc/sys/fs/binfmt_misc")
if (binfmt / name).exists():
    os.execvp(command[0], command)

libc = ctypes.CDLL(None, use_errno=True)
ready, go = os.pipe(), os.pipe()
child = os.fork()
if child == 0:
    made = libc.unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0
    os.write(ready[1], b"+" if made else b"-")
    os.read(go[0], 1)
    try:
        if not made or libc.mount(b"none", bytes(binfmt), b"binfmt_misc", 0, None) != 0:
            raise OSError("no namespace")
        (binfmt / "register").write_text(pathlib.Path(f"/usr/lib/binfmt.d/{name}.conf").read_text().strip())
    except OSError as error:
        print(f"foreign programs cannot be run here: {error}", file=sys.stderr)
        os._exit(77)
    os.execvp(command[0], command)
if os.read(ready[0], 1) == b"+":
    for kind in ("uid_map", "gid_map"):
        pathlib.Path(f"/proc/{child}/{kind}").write_text(f"0 0 {UIDS}\n")
os.write(go[1], b"+")
sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
