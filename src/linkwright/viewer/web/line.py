"""The connection to one page: how much it carries, how little may wait in front of it, how fast the page may send."""

from __future__ import annotations

import asyncio
import socket
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

_RATE = 1000.0
_BURST = 4000.0
"""A page of a large robot reports all its meshes at once."""

MOST_UNSENT = 16 * 1024
"""Bytes that may wait in the program, and again as many in the operating system, before the writer has to."""

_NOT_SENT_LOW_WATER: int | None = getattr(socket, "TCP_NOTSENT_LOWAT", None)


@dataclass(slots=True)
class _OnTheWay:
    number: int
    size: int
    sent: float


class Line:
    """Measures the connection to one page.

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
        """How many bytes a reducible payload should have."""
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
        elif 2 * size >= self.room:  # it went into buffers of unknown size
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


def keep_short(transport: asyncio.Transport) -> None:
    """Keep the send buffer of a connection short, without bounding what is in flight.

    What waits there can neither be replaced by newer data nor overtaken.

    The system grows its send buffer to megabytes; over a slow line these are many seconds. Where it offers no other
    bound (Windows), its buffer stays as it is, and pages' acknowledgements alone keep the line free.
    """
    transport.set_write_buffer_limits(high=MOST_UNSENT)
    connection = transport.get_extra_info("socket")
    if connection is not None and _NOT_SENT_LOW_WATER is not None:
        connection.setsockopt(socket.IPPROTO_TCP, _NOT_SENT_LOW_WATER, MOST_UNSENT)
