"""Asks participants for their nodes, which they would tell only after seconds.

A writer of Fast DDS tells a reader what it has told before when it gets to know the reader. Often that is before
Cyclone knows the writer, so that it is lost; what Cyclone sends to have it repeated, Fast DDS passes over, and repeats
it after 3 s by itself. A reader that is made when the writer is known is told within milliseconds.
"""

from __future__ import annotations

import time
from collections.abc import Callable

INTERVALS = (0.02, 0.1, 0.2, 0.4, 0.8)
"""Seconds after which a participant that has not announced its nodes is asked, and asked again."""


class DiscoveryRequests:
    """Listens with a second reader of ``ros_discovery_info`` until every participant has announced its nodes.

    Args:
        listen: makes such a reader; gives what takes it back.
    """

    def __init__(self, listen: Callable[[], Callable[[], None]]) -> None:
        self._listen = listen
        self._stop: Callable[[], None] | None = None
        self._asked: int | None = None
        self._due = 0.0

    def review(self, *, is_complete: bool) -> float | None:
        """Ask if it is time to.

        Args:
            is_complete: whether all have announced theirs.

        Returns:
            Seconds after which to check again; None when all have announced theirs, or were asked often enough.
        """
        now = time.monotonic()
        if is_complete:
            self._end()
            self._asked = None
            return None
        if self._asked is None:
            self._asked, self._due = 0, now + INTERVALS[0]
        elif now >= self._due and self._asked < len(INTERVALS):
            self._end()
            self._stop = self._listen()
            self._asked += 1
            self._due = now + INTERVALS[min(self._asked, len(INTERVALS) - 1)]
        return None if self._asked == len(INTERVALS) else max(self._due - now, 0.0)

    def _end(self) -> None:
        if self._stop is not None:
            self._stop()
            self._stop = None
