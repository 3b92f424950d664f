"""Clean the folder of a run, so that the grader can read it safely."""

from __future__ import annotations

import contextlib
import itertools
import os
import shutil
import stat
import tempfile
from collections import Counter

_SHARED_FOLDERS = ("/tmp", "/var/tmp", "/dev/shm", "/dev/mqueue", "/run/lock")
"""The folders in which all users may write."""
_MAX_PATH_LENGTH = 2048
"""The maximum number of characters of a path. Folders with longer paths are deleted, because most programs cannot read
much longer ones."""


def remove_harmful(folder: str) -> tuple[str, ...]:
    """Delete files that could harm a reader of a folder, and return their relative paths.

    Symbolic links out of the folder, and hard links to files outside it, lead a reader to other users' files.
    A reader waits forever for named pipes, sockets and devices, and fails at very deep folders. All folders and files
    become readable and writable for their owner. Nothing else may change the folder meanwhile.
    """
    _permit_owner(folder, os.lstat(folder))
    removed = []
    too_deep = [path for path in _list_paths(folder) if len(path) > _MAX_PATH_LENGTH]
    for path in too_deep:
        _delete_folder(path, folder)
    links: Counter[tuple[int, int]] = Counter()
    linked: list[tuple[str, os.stat_result]] = []
    for path in _list_paths(folder):
        status = os.lstat(path)
        if stat.S_ISLNK(status.st_mode):
            if _does_link_lead_out(path, folder):
                removed.append(path)
        elif not stat.S_ISREG(status.st_mode) and not stat.S_ISDIR(status.st_mode):
            removed.append(path)
        elif stat.S_ISREG(status.st_mode) and status.st_nlink > 1:
            links[status.st_dev, status.st_ino] += 1
            linked.append((path, status))
        else:
            _permit_owner(path, status)
    for path, status in linked:
        if links[status.st_dev, status.st_ino] < status.st_nlink:
            removed.append(path)
        else:
            _permit_owner(path, status)
    for path in removed:
        os.unlink(path)
    return tuple(sorted(os.path.relpath(path, folder) for path in removed + too_deep))


def remove_user_files(user: int) -> None:
    """Delete the files of a user in world-writable folders.

    No process of the user may be running.
    """
    for folder in _SHARED_FOLDERS:
        with contextlib.suppress(OSError), os.scandir(folder) as entries:
            for entry in entries:
                with contextlib.suppress(OSError):
                    if entry.stat(follow_symlinks=False).st_uid == user:
                        _delete(entry.path)


def change_owner(user: int, group: int, folder: str) -> None:
    """Change the owner of a folder and its contents to a user if this process runs as root.

    Links are not followed.
    """
    if os.geteuid() != 0:
        return
    os.chown(folder, user, group, follow_symlinks=False)
    for path in _list_paths(folder):
        if stat.S_ISDIR((status := os.lstat(path)).st_mode) or status.st_nlink == 1:
            os.chown(path, user, group, follow_symlinks=False)


def _delete(path: str) -> None:
    if stat.S_ISDIR(os.lstat(path).st_mode):
        shutil.rmtree(path)
    else:
        os.unlink(path)


def _delete_folder(path: str, folder: str) -> None:
    """Delete a folder of any depth. Each subfolder is first moved to a given parent folder."""
    base = tempfile.mkdtemp(dir=folder)
    numbers = itertools.count()

    def take(path: str) -> str:
        place = os.path.join(base, str(next(numbers)))
        os.rename(path, place)
        _permit_owner(place, os.lstat(place))
        return place

    if not stat.S_ISDIR(os.lstat(path).st_mode):
        os.unlink(path)
        waiting = []
    else:
        waiting = [take(path)]
    while waiting:
        current = waiting.pop()
        with os.scandir(current) as entries:
            for entry in list(entries):
                if entry.is_dir(follow_symlinks=False):
                    waiting.append(take(entry.path))
                else:
                    os.unlink(entry.path)
        os.rmdir(current)
    os.rmdir(base)


def _list_paths(folder: str) -> list[str]:
    """Return all paths in a folder, each folder before its contents.

    Folders that are nested too deeply are left out. Folders are made readable during the search.
    """
    found = []
    waiting = [folder]
    while waiting:
        with os.scandir(waiting.pop()) as entries:
            for entry in entries:
                found.append(entry.path)
                if entry.is_dir(follow_symlinks=False):
                    _permit_owner(entry.path, entry.stat(follow_symlinks=False))
                    if len(entry.path) <= _MAX_PATH_LENGTH:
                        waiting.append(entry.path)
    return found


def _does_link_lead_out(path: str, folder: str) -> bool:
    real_folder = os.path.realpath(folder)
    target = os.path.realpath(path)
    return target != real_folder and not target.startswith(real_folder + os.sep)


def _permit_owner(path: str, status: os.stat_result) -> None:
    """Allow the owner to read and write, and remove set-user-ID and set-group-ID."""
    owner_mode = 0o700 if stat.S_ISDIR(status.st_mode) else 0o600
    mode = stat.S_IMODE(status.st_mode) & 0o777 | owner_mode
    if mode != stat.S_IMODE(status.st_mode):
        os.chmod(path, mode)
