"""The lateness of this program's event loop."""

from __future__ import annotations

import asyncio
from collections import deque

_EVERY = 0.05
"""Seconds between two measurements."""

_LOOKS = 20
"""Measurements that count."""


class Lateness:
    """Measures by how much the event loop is late, from its creation until it is closed.

    Messages from a page wait as long before they are read, and messages to it before they are sent.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._seen: deque[float] = deque(maxlen=_LOOKS)
        self._due = self._loop.time() + _EVERY
        self._timer = self._loop.call_at(self._due, self._look)

    @property
    def mean(self) -> float:
        """The mean of the last second, in seconds; 0.0 before anything is known."""
        return sum(self._seen) / len(self._seen) if self._seen else 0.0

    def close(self) -> None:
        """Stop measuring."""
        self._timer.cancel()

    def _look(self) -> None:
        now = self._loop.time()
        self._seen.append(now - self._due)
        self._due = now + _EVERY
        self._timer = self._loop.call_at(self._due, self._look)
