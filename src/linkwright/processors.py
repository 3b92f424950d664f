"""How many processors a process may use."""

from __future__ import annotations

import os

_UNKNOWN = 2
"""What is taken where the system does not tell."""


def usable_processors() -> int:
    """The number of processors that this process may use; those of the machine where it cannot be bound to some."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or _UNKNOWN
