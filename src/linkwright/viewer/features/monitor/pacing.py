"""Rate limiting: does something soon, but at most so many times a second."""

from __future__ import annotations

import asyncio
from collections.abc import Callable


class Paced:
    """Work that is asked for more often than it is to be done.

    Args:
        work: what is done.
        period: least time between two turns, seconds.
    """

    def __init__(self, work: Callable[[], None], period: float) -> None:
        self._work = work
        self._period = period
        self._loop = asyncio.get_running_loop()
        self._done_at = float("-inf")
        self._due: asyncio.TimerHandle | None = None

    def ask(self) -> None:
        """Have the work done: as soon as the period since the last turn is over."""
        if self._due is None:
            self._due = self._loop.call_at(max(self._loop.time(), self._done_at + self._period), self._do)

    def cancel(self) -> None:
        """Do not do what was asked for."""
        if self._due is not None:
            self._due.cancel()
            self._due = None

    def _do(self) -> None:
        self._due = None
        self._done_at = self._loop.time()
        self._work()
