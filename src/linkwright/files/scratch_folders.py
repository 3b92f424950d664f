"""Temporary folders that are removed even if their process is killed.

A folder is removed when it is closed, or when Python ends. A process that is killed leaves its folder behind.
Therefore, the next process that creates a folder removes the folders of processes that have ended. A lock (flock(2)),
which ends with the process, marks a folder in use. A process ID in the name would not be sufficient, because
containers that share ``/tmp`` have separate process IDs.
"""

from __future__ import annotations

import os
import shutil
import sys
import time
import weakref
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory, gettempdir

if sys.platform != "win32":
    import fcntl

_PREFIX = "linkwright_"
_MIN_AGE_S = 60.0
"""The age in seconds above which an empty folder without a lock is abandoned.

The process that creates a younger folder may not have locked it yet.
"""


class ScratchFolder(TemporaryDirectory[str]):
    """A temporary folder with a lock.

    Args:
        purpose: a word for the name of the folder.
        parent: the parent folder; None for the system's folder for temporary files.
        ignore_cleanup_errors: whether files that cannot be removed are left behind without an error.
    """

    def __init__(self, purpose: str, parent: Path | None = None, *, ignore_cleanup_errors: bool = False) -> None:
        remove_abandoned(parent or Path(gettempdir()))
        super().__init__(prefix=f"{_PREFIX}{purpose}_", dir=parent, ignore_cleanup_errors=ignore_cleanup_errors)
        lock = _lock(Path(self.name))
        self._unlock = None if lock is None else weakref.finalize(self, os.close, lock)

    def cleanup(self) -> None:
        """Remove the folder and its contents."""
        super().cleanup()
        if self._unlock is not None:
            self._unlock()


def is_scratch_folder(folder: Path) -> bool:
    """Return whether a folder has the name of a scratch folder."""
    return folder.name.startswith(_PREFIX)


def remove_abandoned(parent: Path) -> None:
    """Remove the scratch folders of ended processes in a parent folder.

    A folder that cannot be removed is skipped.
    """
    if sys.platform == "win32":  # Windows cannot lock folders
        return
    with suppress(OSError):
        with os.scandir(parent) as entries:
            own_entries = [entry for entry in entries if entry.name.startswith(_PREFIX)]
        for entry in own_entries:
            with suppress(OSError):
                _remove_if_abandoned(entry)


def _remove_if_abandoned(entry: os.DirEntry[str]) -> None:
    if not entry.is_dir(follow_symlinks=False) or entry.stat(follow_symlinks=False).st_uid != os.getuid():
        return
    lock = _lock(Path(entry.path))
    if lock is None:
        return
    try:
        age_seconds = time.time() - entry.stat(follow_symlinks=False).st_mtime
        if age_seconds > _MIN_AGE_S or any(Path(entry.path).iterdir()):
            shutil.rmtree(entry.path, ignore_errors=True)
    finally:
        os.close(lock)


def _lock(folder: Path) -> int | None:
    """Lock a folder, and return a file descriptor that holds the lock while it is open.

    The result is None if the folder is locked already, or if the file system does not support such locks.
    """
    if sys.platform == "win32":
        return None
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(descriptor)
        return None
    return descriptor
