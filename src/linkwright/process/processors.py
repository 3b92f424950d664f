"""The number of processors that this process may use."""

from __future__ import annotations

import os

_DEFAULT_COUNT = 2
"""The number of processors to assume if the system does not report it."""


def usable_processors() -> int:
    """Return the number of processors that this process may use.

    On systems without processor affinity, this is the number of processors of the computer.
    """
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or _DEFAULT_COUNT
