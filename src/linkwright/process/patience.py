"""A clock for timeouts that stops while the machine is busy."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Iterator

_SECONDS_PER_NANOSECOND = 1e-9
_MAX_SLOWDOWN = 10.0
"""The clock is slower than real time by at most this factor."""


class PatientClock:
    """A clock that stops while a process and its descendants wait for a processor.

    On a busy machine, the clock is slower than real time. If the system does not report waiting times (Linux reports
    them in schedstat), the clock follows real time. Call `read` every few milliseconds to seconds.

    Attributes:
        cpu_seconds: the processor time that the processes used until the last call of `read`, without the last
            moments of processes that have ended.

    Args:
        process: the ID of the process; None for this process.
    """

    def __init__(self, process: int | None = None) -> None:
        self._process = os.getpid() if process is None else process
        self._start = self._last = time.monotonic()
        self._waited = 0.0
        self._usages = dict(_read_usages(self._process))
        self.cpu_seconds = 0.0

    def read(self) -> float:
        """Return the seconds on this clock since its creation."""
        now = time.monotonic()
        usages = dict(_read_usages(self._process))
        running = waiting = 0.0
        for thread, (run, wait) in usages.items():
            run_before, wait_before = self._usages.get(thread, (0.0, 0.0))
            running += run - run_before
            waiting += wait - wait_before
        if waiting > 0.0:
            # For one thread, this is its waiting time; for parallel threads, the share of the time that they waited.
            self._waited += min(now - self._last, running + waiting) * waiting / (running + waiting)
        self.cpu_seconds += running
        self._usages, self._last = usages, now
        elapsed = now - self._start
        return max(elapsed - self._waited, elapsed / _MAX_SLOWDOWN)


def _read_usages(root: int) -> Iterator[tuple[str, tuple[float, float]]]:
    """Yield the threads of a process and of its descendants, with running and waiting times.

    Both times are in seconds.
    """
    waiting = [root]
    while waiting:
        folder = f"/proc/{waiting.pop()}/task"
        with contextlib.suppress(OSError):
            for thread in os.listdir(folder):  # noqa: PTH208 - read often
                with contextlib.suppress(OSError, ValueError):
                    run, wait, _ = map(int, _read_text(f"{folder}/{thread}/schedstat").split())
                    yield thread, (run * _SECONDS_PER_NANOSECOND, wait * _SECONDS_PER_NANOSECOND)
                with contextlib.suppress(OSError):  # not supported by all kernels
                    waiting += map(int, _read_text(f"{folder}/{thread}/children").split())


def _read_text(path: str) -> str:
    with open(path, encoding="ascii") as file:  # noqa: PTH123 - read often
        return file.read()
