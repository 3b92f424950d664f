"""Temporary folders for copies of recordings.

Copies can be larger than the memory.
"""

from __future__ import annotations

import os
from pathlib import Path

from linkwright.files.scratch_folders import ScratchFolder

_DISK_FOLDER = Path("/var/tmp")  # noqa: S108 - the folder below it gets an unpredictable name
"""The system's folder for large temporary files. ``/tmp`` may be memory (file-hierarchy(7))."""


def create_scratch_folder() -> ScratchFolder:
    """Create a temporary folder in TMPDIR, or in a system folder on disk if TMPDIR is not set.

    If the system folder is not writable, Python's default folder for temporary files is used.
    """
    parent = None if os.environ.get("TMPDIR") or not os.access(_DISK_FOLDER, os.W_OK) else _DISK_FOLDER
    return ScratchFolder("bag", parent)
