"""How fast a page may send messages."""

from __future__ import annotations

import time
from collections.abc import Callable

_RATE = 1000.0
_BURST = 4000.0
"""A page of a large robot tells of each of its meshes in one go."""


class Pace:
    """Says when a sender has to wait, so that one page cannot keep the program from the others.

    Args:
        clock: seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._left = _BURST
        self._at = clock()

    def wait(self) -> float:
        """Seconds to wait before the message that came is worked on."""
        now = self._clock()
        self._left = min(_BURST, self._left + (now - self._at) * _RATE) - 1.0
        self._at = now
        return max(0.0, -self._left / _RATE)
