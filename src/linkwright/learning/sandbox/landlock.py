"""Landlock: the Linux kernel restricts the paths that a process may access.

The restriction also applies to the descendants of the process.
Landlock needs Linux 5.13 or later, but no privileges. Newer versions of its interface protect more.
"""

from __future__ import annotations

import contextlib
import ctypes
import errno
import os
import stat
from collections.abc import Iterable

from linkwright.learning.sandbox.linux import system_call

_CREATE_RULESET = 444
_ADD_RULE = 445
_RESTRICT_SELF = 446
_ASK_VERSION = 1
_PATH_BENEATH = 1

_EXECUTE = 1 << 0
_WRITE_FILE = 1 << 1
_READ_FILE = 1 << 2
_READ_DIR = 1 << 3
_TRUNCATE = 1 << 14
_IOCTL_DEV = 1 << 15
_ACCESSES_OF_VERSION = {1: 13, 2: 14, 3: 15, 4: 15, 5: 16}
"""The number of accesses to files that each version knows. The highest applies to later versions."""

_READ = _EXECUTE | _READ_FILE | _READ_DIR
_ACCESSES_TO_FILES = _EXECUTE | _WRITE_FILE | _READ_FILE | _TRUNCATE | _IOCTL_DEV

_SCOPE_ABSTRACT_SOCKETS = 1
_SCOPE_SIGNALS = 2

MOVE_VERSION = 2
"""The version since which files can be moved from one folder to another."""


class _RulesetAttributes(ctypes.Structure):
    _fields_ = (
        ("handled_access_fs", ctypes.c_uint64),
        ("handled_access_net", ctypes.c_uint64),
        ("scoped", ctypes.c_uint64),
    )


class _PathBeneath(ctypes.Structure):
    _pack_ = 1
    _layout_ = "ms"
    _fields_ = (("allowed_access", ctypes.c_uint64), ("parent_fd", ctypes.c_int32))


def landlock_version() -> int:
    """Return the version of Landlock's interface; 0 without Landlock."""
    try:
        return system_call(_CREATE_RULESET, None, ctypes.c_size_t(0), ctypes.c_uint(_ASK_VERSION))
    except OSError:
        return 0


def restrict(readable: Iterable[str], listable: Iterable[str], writable: Iterable[str]) -> tuple[int, bool]:
    """Restrict the file access of this process and its descendants.

    Args:
        readable: the files and whole folders that may be read and executed.
        listable: the folders that may be listed, including all folders below them.
        writable: the files and whole folders with unrestricted access.

    Raises:
        OSError: Landlock is missing.
    """
    version = landlock_version()
    if version == 0:
        raise OSError(errno.ENOSYS, "Landlock is missing")
    handled = (1 << _ACCESSES_OF_VERSION.get(version, 16)) - 1
    ruleset, signals = _create_ruleset(version, handled)
    try:
        for paths, access in ((readable, _READ), (listable, _READ_DIR), (writable, handled)):
            for path in paths:
                with contextlib.suppress(FileNotFoundError, PermissionError):
                    _allow(ruleset, path, access & handled)
        system_call(_RESTRICT_SELF, ctypes.c_int(ruleset), ctypes.c_uint(0))
    finally:
        os.close(ruleset)
    return version, signals


def _create_ruleset(version: int, handled: int) -> tuple[int, bool]:
    """Return a ruleset, and whether it restricts signals.

    Kernels of RHEL 9 report version 6, but cannot restrict signals.
    """
    size = 8 if version < 4 else 16 if version < 6 else 24
    scopes = (_SCOPE_ABSTRACT_SOCKETS | _SCOPE_SIGNALS, _SCOPE_ABSTRACT_SOCKETS, 0) if version >= 6 else (0,)
    for scope in scopes:
        attributes = _RulesetAttributes(handled, 0, scope)
        try:
            ruleset = system_call(_CREATE_RULESET, ctypes.byref(attributes), ctypes.c_size_t(size), ctypes.c_uint(0))
        except OSError as error:
            if error.errno != errno.EINVAL or scope == 0:
                raise
        else:
            return ruleset, bool(scope & _SCOPE_SIGNALS)
    raise AssertionError("the last scope returns or raises")


def _allow(ruleset: int, path: str, access: int) -> None:
    descriptor = os.open(path, os.O_PATH | os.O_CLOEXEC)
    try:
        if not stat.S_ISDIR(os.fstat(descriptor).st_mode):
            access &= _ACCESSES_TO_FILES
        rule = _PathBeneath(access, descriptor)
        system_call(_ADD_RULE, ctypes.c_int(ruleset), ctypes.c_int(_PATH_BENEATH), ctypes.byref(rule), ctypes.c_uint(0))
    finally:
        os.close(descriptor)
