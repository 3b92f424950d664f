"""Samples wait until readers have acknowledged the large ones before them.

A reader of Fast DDS that has received a sample in part asks for the rest of it. When a newer sample has taken its place
in the writer's history, Cyclone answers with a GAP, and Fast DDS up to 3.6 then frees the sample without forgetting it:
the next ``take`` of the reader never returns (`docs/decisions/0095-large-messages-to-fast-dds.md`). So no sample takes
the place of a large one that may still be asked for. Newer messages replace the samples that wait here instead.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable

PATIENCE = 3.0
"""Seconds after which samples are replaced all the same: a reader that was stopped acknowledges nothing."""


class Backlog:
    """The samples that wait to be written by one reliable writer that keeps the last samples.

    Args:
        depth: how many samples the writer keeps.
        fragment_size: the bytes of a sample that go into one packet; larger samples may be received in part.
        write: writes a sample.
        acknowledged: whether all readers have acknowledged all written samples.
        matters: whether a reader listens that a replaced sample would harm.
        now: the steady clock, in seconds.
    """

    def __init__(
        self,
        depth: int,
        fragment_size: int,
        write: Callable[[bytes], None],
        acknowledged: Callable[[], bool],
        matters: Callable[[], bool],
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self._depth = depth
        self._fragment_size = fragment_size
        self._write = write
        self._acknowledged = acknowledged
        self._matters = matters
        self._now = now
        self._waiting: deque[bytes] = deque(maxlen=depth)
        self._written = 0
        self._late_since: float | None = None
        self._lock = threading.RLock()  # a warning of a write that failed may go the same way

    def send(self, sample: bytes) -> bool:
        """Write a sample, or let it wait; whether a sample waits."""
        with self._lock:
            if not self._written and len(sample) <= self._fragment_size:
                self._write(sample)
                return False
            self._waiting.append(sample)
            return self._write_what_fits()

    def review(self) -> bool:
        """Write the samples that may be written by now; whether a sample still waits."""
        with self._lock:
            return self._write_what_fits()

    def _write_what_fits(self) -> bool:
        while self._waiting and self._has_room():
            self._written += 1
            self._write(self._waiting.popleft())
        return bool(self._waiting)

    def _has_room(self) -> bool:
        """Whether the next sample replaces none that may still be asked for."""
        if self._written < self._depth:
            return True
        if self._acknowledged():
            self._written, self._late_since = 0, None
            return True
        if not self._matters():
            return True
        if self._late_since is None:
            self._late_since = self._now()
        return self._now() - self._late_since >= PATIENCE
