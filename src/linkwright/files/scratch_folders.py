"""Temporary folders that do not outlive their process for long, however it ends.

A folder is removed when it is closed, or when Python ends. A process that is killed leaves it, so the next process that
makes one removes the folders of processes that have ended. A lock on the folder (flock(2)), which ends with the
process, marks those in use. A process ID in the name would not do: containers that share ``/tmp`` have their own IDs.
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
_YOUNG_SECONDS = 60.0
"""An empty folder without a lock may be one that is just being made, for so long."""


class ScratchFolder(TemporaryDirectory[str]):
    """A temporary folder.

    Args:
        purpose: a word of the folder's name.
        place: the folder that it is made in; that of the system for temporary files when left out.
    """

    def __init__(self, purpose: str, place: Path | None = None) -> None:
        remove_abandoned(place or Path(gettempdir()))
        super().__init__(prefix=f"{_PREFIX}{purpose}_", dir=place)
        lock = _locked(Path(self.name))
        self._unlock = None if lock is None else weakref.finalize(self, os.close, lock)

    def cleanup(self) -> None:
        """Remove the folder and all in it."""
        super().cleanup()
        if self._unlock is not None:
            self._unlock()


def remove_abandoned(place: Path) -> None:
    """Remove the scratch folders of processes that have ended; folders that cannot be removed stay."""
    if sys.platform == "win32":  # there are no locks on folders
        return
    with suppress(OSError):
        with os.scandir(place) as entries:
            ours = [entry for entry in entries if entry.name.startswith(_PREFIX)]
        for entry in ours:
            with suppress(OSError):
                _remove_if_abandoned(entry)


def _remove_if_abandoned(entry: os.DirEntry[str]) -> None:
    if not entry.is_dir(follow_symlinks=False) or entry.stat(follow_symlinks=False).st_uid != os.getuid():
        return
    lock = _locked(Path(entry.path))
    if lock is None:
        return
    try:
        changed = time.time() - entry.stat(follow_symlinks=False).st_mtime
        if changed > _YOUNG_SECONDS or any(Path(entry.path).iterdir()):
            shutil.rmtree(entry.path, ignore_errors=True)
    finally:
        os.close(lock)


def _locked(folder: Path) -> int | None:
    """Lock a folder until this file descriptor is closed; None if it is locked already, or there are no locks."""
    if sys.platform == "win32":
        return None
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(descriptor)
        return None
    return descriptor
