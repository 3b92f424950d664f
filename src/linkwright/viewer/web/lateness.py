"""How late this program is with what it is to do."""

from __future__ import annotations

import asyncio
from collections import deque

_EVERY = 0.05
"""Seconds between two looks."""

_LOOKS = 20
"""Looks that count."""


class Lateness:
    """Measures by how much the event loop is late, from its making until it is closed.

    What comes from a page waits as long before it is read, and what goes to it before it is sent.
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
        """Measure no longer."""
        self._timer.cancel()

    def _look(self) -> None:
        now = self._loop.time()
        self._seen.append(now - self._due)
        self._due = now + _EVERY
        self._timer = self._loop.call_at(self._due, self._look)
