"""How much a page's connection carries, so that nothing large stands in the way of what must be quick."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

BULK = 4096
"""Messages of at least so many bytes are counted; pages acknowledge those (and some smaller ones)."""

_SHARE = 0.1
"""Seconds that one payload may keep the line busy."""

_FIRST_ROOM = 24 * 1024
_LEAST_ROOM = 6 * 1024

_BLOCKED = 0.02
"""Seconds of waiting for the socket that say something about the line, and not about this machine."""


_MOST_ON_THE_WAY = 64
"""Messages remembered for the first answer of a page that may never answer."""


@dataclass(slots=True)
class _OnTheWay:
    number: int
    size: int
    sent: float


class Line:
    """What is known of the connection to one page.

    Pages acknowledge large messages, which measures all of the way, tunnels with buffers of their own included. Of a
    page that does not, only the time is known that the socket took to accept what was sent.

    Args:
        clock: seconds.

    Attributes:
        rate: bytes a second; None as long as nothing is known.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.rate: float | None = None
        self._clock = clock
        self._number = 0
        self._answers = False
        self._shortest = float("inf")
        self._on_the_way: deque[_OnTheWay] = deque()
        self._hello: float | None = None

    @property
    def room(self) -> int:
        """How many bytes a payload should have that can be had smaller."""
        return _FIRST_ROOM if self.rate is None else max(_LEAST_ROOM, int(self.rate * _SHARE))

    @property
    def is_full(self) -> bool:
        """Whether large messages should wait until the page has those that are on the way."""
        return self._answers and sum(each.size for each in self._on_the_way) >= self.room / 2

    @property
    def is_idle(self) -> bool:
        """Whether the page has said that nothing large is on the way."""
        return self._answers and not self._on_the_way

    def sending(self, size: int) -> float:
        """A message of so many bytes is handed to the socket; the time, for `sent`."""
        now = self._clock()
        self._number += 1
        if self._number == 1:
            self._hello = now
        if size >= BULK:
            self._on_the_way.append(_OnTheWay(self._number, size, now))
        return now

    def sent(self, size: int, since: float) -> None:
        """The socket has accepted a message that it was handed at a time."""
        if self._answers or size < BULK:
            return
        while len(self._on_the_way) > _MOST_ON_THE_WAY:
            self._on_the_way.popleft()
        seconds = self._clock() - since
        if seconds >= _BLOCKED:
            self._learn(size / seconds)
        elif 2 * size >= self.room:  # it went into buffers, who knows how large
            self._learn(float("inf"))

    def received(self, count: int) -> None:
        """The page says that it has so many messages."""
        now = self._clock()
        if not self._answers:
            self._answers = True
            if self._hello is not None:
                self._shortest = now - self._hello
        while self._on_the_way and self._on_the_way[0].number <= count:
            arrived = self._on_the_way.popleft()
            took = now - arrived.sent
            self._shortest = min(self._shortest, took)
            if 2 * arrived.size >= min(self.room, _FIRST_ROOM):
                self._learn(arrived.size / max(took - self._shortest, took / 10, 1e-4))

    def _learn(self, rate: float) -> None:
        """Take a measurement. A single one may be chance: twice as much is tried at most, or half as much."""
        known = self.room / _SHARE
        self.rate = min(max(rate, known / 2), known * 2)
