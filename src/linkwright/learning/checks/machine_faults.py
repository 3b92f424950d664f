"""Detect checks that failed because of the machine.

The machine may lack memory, disk space, processes or libraries.
"""

from __future__ import annotations

import errno
import traceback
from pathlib import Path

from linkwright.diagnostics.extras import EXTRAS

_RESOURCES = {
    getattr(errno, name)
    for name in ("EAGAIN", "EDQUOT", "EIO", "EMFILE", "ENFILE", "ENOMEM", "ENOSPC", "EROFS")
    if hasattr(errno, name)
}


def is_machine_fault(error: Exception, workspace: Path) -> bool:
    """Return whether an error has its cause in the machine, and not in the learner's files."""
    frames = traceback.extract_tb(error.__traceback__)
    if any(Path(frame.filename).is_relative_to(workspace) for frame in frames):
        return False
    if isinstance(error, ImportError):
        return (error.name or "").partition(".")[0] in {"linkwright", *EXTRAS.values()}
    if isinstance(error, (MemoryError, TimeoutError)):
        return True
    if isinstance(error, RuntimeError) and "start new thread" in str(error):
        return True
    return isinstance(error, OSError) and error.errno in _RESOURCES
