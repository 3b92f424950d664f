"""The user of a run if the grader is root: a user that owns no files or processes."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from linkwright.learning.sandbox.linux import CAP_SETGID, CAP_SETUID, has_capability

if sys.platform != "win32":
    import pwd

_HIGH_USERS = 0x7000_0000
"""Plus the number of the supervisor's process, a user number that no other run has."""
_LOW_USERS = range(61184, 65520)
"""The user numbers for containers that have few: those of systemd's dynamic users."""


def find_unused_user() -> int | None:
    """Return an unused user ID for the run, or None if this process cannot change its user."""
    if os.geteuid() != 0 or not (has_capability(CAP_SETUID) and has_capability(CAP_SETGID)):
        return None
    count = min(_count_mapped("/proc/self/uid_map"), _count_mapped("/proc/self/gid_map"))
    if count > _HIGH_USERS + 2**23:
        return _HIGH_USERS + os.getpid()
    busy = _list_users_of_processes()
    for offset in range(len(_LOW_USERS)):
        user = _LOW_USERS[(os.getpid() + offset) % len(_LOW_USERS)]
        if user < count and user not in busy and not _is_known(user):
            return user
    return None


def become(user: int) -> None:
    """Change this process to a user and to the group with the same ID, without other groups."""
    os.setgroups([])
    os.setresgid(user, user, user)
    os.setresuid(user, user, user)


def can_be_reached(paths: list[str]) -> bool:
    """Return whether a user without files may traverse all folders that contain these paths."""
    for path in paths:
        place = Path(path).resolve()
        if any(not folder.stat().st_mode & 0o001 for folder in place.parents):
            return False
    return True


def is_readable_for_others(path: str) -> bool:
    """Return whether a user without files may read a reachable file or list a reachable folder."""
    needed = 0o005 if os.path.isdir(path) else 0o004
    return os.stat(path).st_mode & needed == needed


def _count_mapped(path: str) -> int:
    """Return the number of consecutive IDs from 0 that exist in this user namespace."""
    for line in Path(path).read_text(encoding="ascii").splitlines():
        first, _, count = map(int, line.split())
        if first == 0:
            return count
    return 0


def _list_users_of_processes() -> set[int]:
    users = set()
    for entry in os.scandir("/proc"):
        if entry.name.isdecimal():
            try:
                users.add(entry.stat().st_uid)
            except OSError:
                continue
    return users


def _is_known(user: int) -> bool:
    try:
        pwd.getpwuid(user)
    except KeyError:
        return False
    return True
