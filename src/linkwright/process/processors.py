"""The number of processors that a process may use."""

from __future__ import annotations

import os

_UNKNOWN = 2
"""The number to use if the system does not report one."""


def usable_processors() -> int:
    """Return the number of processors that this process may use.

    On a system without processor affinity, this is the number of processors of the machine.
    """
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or _UNKNOWN
