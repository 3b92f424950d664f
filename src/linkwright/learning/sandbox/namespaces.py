"""Linux namespaces, which isolate the processes, mounts, network and IPC of a run."""

from __future__ import annotations

import errno
import os
import socket
import struct
import sys
from collections.abc import Collection
from pathlib import Path

from linkwright.learning.sandbox.linux import (
    CLONE_NEWIPC,
    CLONE_NEWNET,
    CLONE_NEWNS,
    CLONE_NEWPID,
    CLONE_NEWUSER,
    unshare,
)

if sys.platform != "win32":
    import fcntl

_NAMESPACES = {"processes": CLONE_NEWPID, "mounts": CLONE_NEWNS, "ipc": CLONE_NEWIPC, "network": CLONE_NEWNET}

_SIOCGIFFLAGS = 0x8913
_SIOCSIFFLAGS = 0x8914
_IFF_UP = 0x1
_IFF_MULTICAST = 0x1000


def enter_user_namespace() -> None:
    """Move this process into a new user namespace, so that it may create the other namespaces.

    Raises:
        OSError: The system does not allow it.
    """
    unshare(CLONE_NEWUSER)


def map_users(pid: int) -> None:
    """Map the users of this process into the new user namespace of another process.

    Raises:
        OSError: The system does not allow it.
    """
    proc = Path("/proc") / str(pid)
    whole_map = "".join(
        f"{first} {first} {count}\n"
        for first, _, count in (line.split() for line in Path("/proc/self/uid_map").read_text("ascii").splitlines())
    )
    if os.geteuid() == 0:
        try:
            (proc / "uid_map").write_text(whole_map, "ascii")
            (proc / "gid_map").write_text(whole_map, "ascii")
        except PermissionError:
            pass  # this root has no right to users other than its own
        else:
            return
    (proc / "uid_map").write_text(f"{os.geteuid()} {os.geteuid()} 1", "ascii")
    (proc / "setgroups").write_text("deny", "ascii")
    (proc / "gid_map").write_text(f"{os.getegid()} {os.getegid()} 1", "ascii")


def enter_namespaces(requested_names: Collection[str]) -> set[str]:
    """Create the requested namespaces as far as the system allows, and return their names.

    A new process namespace applies to the next child of this process.
    """
    return {name for name, flag in _NAMESPACES.items() if name in requested_names and _can_enter(flag)}


def _can_enter(flag: int) -> bool:
    try:
        unshare(flag)
    except OSError as error:
        if error.errno not in {errno.EPERM, errno.EINVAL, errno.ENOSPC, errno.ENOSYS, errno.EACCES}:
            raise
        return False
    return True


def bring_up_loopback() -> None:
    """Enable loopback, including multicast, in this network namespace."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as control:
        name = b"lo".ljust(16, b"\0")
        request = fcntl.ioctl(control, _SIOCGIFFLAGS, name + bytes(24))
        (flags,) = struct.unpack_from("H", request, 16)
        fcntl.ioctl(control, _SIOCSIFFLAGS, name + struct.pack("H", flags | _IFF_UP | _IFF_MULTICAST) + bytes(22))
