"""Hold back samples until readers have acknowledged the large samples before them.

A reader of Fast DDS that has received part of a sample requests the rest. If a newer sample has replaced that sample in
the writer's history, Cyclone answers with a GAP. Fast DDS up to 3.6 then frees the sample but keeps a reference to it,
and the next ``take`` of the reader never returns (`docs/decisions/0095-large-messages-to-fast-dds.md`). Therefore, no
sample replaces a large sample that may still be requested. Newer messages replace the samples in this queue instead.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable

ACKNOWLEDGMENT_TIMEOUT_S = 3.0
"""Seconds after which samples are replaced anyway, because a stopped reader acknowledges nothing."""


class Backlog:
    """A queue of samples for one reliable writer, limited to the newest samples.

    Args:
        depth: the number of samples that the writer stores.
        fragment_size: the maximum size in bytes of a sample that is sent in one packet; larger samples may be received
            in part.
        write: writes a sample.
        acknowledged: returns whether all readers have acknowledged all written samples.
        has_vulnerable_reader: returns whether there is a reader that a replaced sample would harm.
        now: the steady clock, in seconds.
    """

    def __init__(
        self,
        depth: int,
        fragment_size: int,
        write: Callable[[bytes], None],
        acknowledged: Callable[[], bool],
        has_vulnerable_reader: Callable[[], bool],
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self._depth = depth
        self._fragment_size = fragment_size
        self._write = write
        self._wait_for_readers = acknowledged
        self._has_vulnerable_reader = has_vulnerable_reader
        self._now = now
        self._waiting: deque[bytes] = deque(maxlen=depth)
        self._unacknowledged_count = 0
        self._late_since: float | None = None
        self._lock = threading.RLock()  # reentrant: the warning of a failed write may use this writer

    def send(self, sample: bytes) -> bool:
        """Write a sample or queue it, and return whether any sample is queued."""
        with self._lock:
            if not self._unacknowledged_count and len(sample) <= self._fragment_size:
                self._write(sample)
                return False
            self._waiting.append(sample)
            return self._write_queued()

    def write_queued(self) -> bool:
        """Write the queued samples that may now be written, and return whether any remain queued."""
        with self._lock:
            return self._write_queued()

    def _write_queued(self) -> bool:
        while self._waiting and self._has_room():
            self._unacknowledged_count += 1
            self._write(self._waiting.popleft())
        return bool(self._waiting)

    def _has_room(self) -> bool:
        """Return whether the next sample would not replace a sample that may still be requested."""
        if self._unacknowledged_count < self._depth:
            return True
        if self._wait_for_readers():
            self._unacknowledged_count, self._late_since = 0, None
            return True
        if not self._has_vulnerable_reader():
            return True
        if self._late_since is None:
            self._late_since = self._now()
        return self._now() - self._late_since >= ACKNOWLEDGMENT_TIMEOUT_S
