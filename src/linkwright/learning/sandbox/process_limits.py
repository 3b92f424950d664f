"""Limits that the kernel enforces for each process: resources, priority and processors."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Collection

from linkwright.learning.sandbox.outcome import Limits

if sys.platform != "win32":
    import resource

_MAX_OPEN_FILES = 1024
_NICENESS = 10
_SPARE_PROCESSES = 16
"""The number of processes that the kernel allows beyond the limit, so that the watchdog can detect an excess."""
_OTHER_THREADS_GROWTH = 100
"""The number of threads that the user's other programs may start meanwhile without affecting the run."""
_OOM_SCORE = 1000


def apply_limits(limits: Limits, *, other_threads: int) -> None:
    """Apply the resource limits to this process and its descendants.

    Args:
        limits: the limits of the run. Here, memory and processor time are limited for each process; the watchdog
            limits them for all processes together.
        other_threads: the number of threads outside the run that the kernel counts for the same user.
    """
    seconds = max(1, round(limits.cpu_seconds + 0.5))
    _limit("RLIMIT_CPU", seconds, seconds + 1)
    _limit("RLIMIT_FSIZE", limits.file_bytes)
    _limit("RLIMIT_NOFILE", _MAX_OPEN_FILES)
    _limit("RLIMIT_CORE", 0)
    _limit("RLIMIT_MSGQUEUE", 0)
    if sys.platform == "linux":
        _limit("RLIMIT_DATA", limits.memory)
    spare = _SPARE_PROCESSES if other_threads == 0 else _OTHER_THREADS_GROWTH
    _limit("RLIMIT_NPROC", other_threads + limits.processes + spare)


def count_threads_of_user() -> int:
    """Return the number of threads of this process's user."""
    if sys.platform != "linux":
        return _OTHER_THREADS_GROWTH
    count = 0
    for entry in os.scandir("/proc"):
        with contextlib.suppress(OSError):
            if entry.name.isdecimal() and entry.stat().st_uid == os.getuid():
                count += len(os.listdir(f"{entry.path}/task"))
    return count


def lower_priority(processors: Collection[int]) -> None:
    """Run this process at low priority on some processors.

    If memory runs out, the kernel kills the process first.
    """
    with contextlib.suppress(OSError):
        os.nice(_NICENESS)
    if sys.platform == "linux":
        with contextlib.suppress(OSError):
            if processors:
                os.sched_setaffinity(0, processors)
        with contextlib.suppress(OSError), open("/proc/self/oom_score_adj", "w", encoding="ascii") as file:
            file.write(str(_OOM_SCORE))


def _limit(name: str, soft: int, hard: int | None = None) -> None:
    number = getattr(resource, name, None)
    if number is None:
        return  # this system has no such limit
    _, allowed = resource.getrlimit(number)
    hard = soft if hard is None else hard
    if allowed != resource.RLIM_INFINITY:
        soft, hard = min(soft, allowed), min(hard, allowed)
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(number, (soft, hard))
