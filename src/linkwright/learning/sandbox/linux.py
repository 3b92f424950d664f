"""System calls of Linux without a Python function, made through ctypes.

Constants and structures are those of the manual pages unshare(2), mount(2), mount_setattr(2), prctl(2), capset(2) and
landlock(7). The numbers of system calls newer than Linux 5.0 are the same on all architectures.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
from functools import cache

CLONE_NEWNS = 0x00020000
CLONE_NEWIPC = 0x08000000
CLONE_NEWUSER = 0x10000000
CLONE_NEWPID = 0x20000000
CLONE_NEWNET = 0x40000000

MS_RDONLY = 0x1
MS_NOSUID = 0x2
MS_NODEV = 0x4
MS_NOEXEC = 0x8
MS_BIND = 0x1000
MS_REC = 0x4000
MS_PRIVATE = 0x40000
_MNT_DETACH = 2

_MOUNT_ATTR_RDONLY = 0x1
_MOUNT_ATTR_NOSUID = 0x2
_AT_FDCWD = -100
_AT_RECURSIVE = 0x8000
_SYS_MOUNT_SETATTR = 442

_PR_SET_PDEATHSIG = 1
_PR_SET_DUMPABLE = 4
_PR_CAPBSET_DROP = 24
_PR_SET_CHILD_SUBREAPER = 36
_PR_SET_NO_NEW_PRIVS = 38
_CAPABILITY_VERSION_3 = 0x20080522

CAP_SETGID = 6
CAP_SETUID = 7
CAP_SYS_PTRACE = 19


@cache
def load_libc() -> ctypes.CDLL:
    """Return the C library of this process."""
    return ctypes.CDLL(None, use_errno=True)


def call_libc(name: str, *arguments: object) -> int:
    """Call a function of the C library whose negative return value means a failure.

    Raises:
        OSError: The function failed.
    """
    result = int(getattr(load_libc(), name)(*arguments))
    if result < 0:
        error = ctypes.get_errno()
        raise OSError(error, f"{name}: {os.strerror(error)}")
    return result


def system_call(number: int, *arguments: object) -> int:
    """Make a system call, and raise an OSError if it fails."""
    return call_libc("syscall", ctypes.c_long(number), *arguments)


def unshare(flags: int) -> None:
    """Move this process, or its next children, into new namespaces."""
    call_libc("unshare", ctypes.c_int(flags))


def mount(source: str, target: str, kind: str = "", flags: int = 0, data: str = "") -> None:
    """Mount a file system, or bind-mount a folder."""
    call_libc(
        "mount",
        source.encode(),
        os.fsencode(target),
        kind.encode() or None,
        ctypes.c_ulong(flags),
        data.encode() or None,
    )


class _MountAttributes(ctypes.Structure):
    _fields_ = (
        ("attr_set", ctypes.c_uint64),
        ("attr_clr", ctypes.c_uint64),
        ("propagation", ctypes.c_uint64),
        ("userns_fd", ctypes.c_uint64),
    )


def make_read_only(path: str, *, with_mounts_below: bool = True) -> None:
    """Make a mount read-only, without set-user-ID programs.

    Including all mounts below it requires Linux 5.12.
    """
    attributes = _MountAttributes(attr_set=_MOUNT_ATTR_RDONLY | _MOUNT_ATTR_NOSUID)
    system_call(
        _SYS_MOUNT_SETATTR,
        ctypes.c_int(_AT_FDCWD),
        os.fsencode(path),
        ctypes.c_uint(_AT_RECURSIVE if with_mounts_below else 0),
        ctypes.byref(attributes),
        ctypes.c_size_t(ctypes.sizeof(attributes)),
    )


def change_root(path: str) -> None:
    """Make a mount the root folder of this mount namespace, and unmount the previous root."""
    os.chdir(path)
    call_libc("pivot_root", b".", b".")
    call_libc("umount2", b".", ctypes.c_int(_MNT_DETACH))
    os.chdir("/")


def _prctl(option: int, argument: int) -> None:
    zero = ctypes.c_ulong(0)
    call_libc("prctl", ctypes.c_int(option), ctypes.c_ulong(argument), zero, zero, zero)


def die_with_parent(signal_number: int, parent: int) -> None:
    """Request a signal to this process when its parent ends.

    A change of credentials cancels the request.
    """
    _prctl(_PR_SET_PDEATHSIG, signal_number)
    if os.getppid() != parent:
        os.kill(os.getpid(), signal_number)


def adopt_orphans() -> None:
    """Make this process the new parent of descendants whose parents end."""
    _prctl(_PR_SET_CHILD_SUBREAPER, 1)


def forbid_new_privileges() -> None:
    """Prevent programs that this process executes from gaining privileges."""
    _prctl(_PR_SET_NO_NEW_PRIVS, 1)


class _CapabilityHeader(ctypes.Structure):
    _fields_ = (("version", ctypes.c_uint32), ("pid", ctypes.c_int))


def drop_capabilities() -> None:
    """Drop all capabilities of this process and of the programs that it executes."""
    with contextlib.suppress(OSError):  # until one does not exist, or if there is no right to drop any
        for capability in range(64):
            _prctl(_PR_CAPBSET_DROP, capability)
    header = _CapabilityHeader(_CAPABILITY_VERSION_3, 0)
    no_rights = (ctypes.c_uint32 * 6)()
    call_libc("capset", ctypes.byref(header), ctypes.byref(no_rights))


def has_capability(number: int) -> bool:
    """Return whether this process has a capability in its user namespace."""
    with open("/proc/self/status", encoding="ascii", errors="replace") as file:
        for line in file:
            if line.startswith("CapEff:"):
                return bool(int(line.split()[1], 16) >> number & 1)
    return False


def set_file_user(user: int, group: int) -> None:
    """Access files as another user, but receive signals as the current user."""
    load_libc().setfsgid(ctypes.c_uint(group))
    load_libc().setfsuid(ctypes.c_uint(user))
