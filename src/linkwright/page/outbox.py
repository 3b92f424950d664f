"""The queue of payloads for a page, and the measured rate of the page's connection.

Only the newest payload of each kind is queued, transforms precede all others, and large content is reduced for a slow
connection or sent in chunks.
"""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

from linkwright.page.protocol.message import DataContent, pack_piece

Pack = Callable[[DataContent], bytes]
Shrink = Callable[[int], DataContent]
"""Reduces the content to about so many bytes, or as far as possible; runs in a thread."""


class ScaledData:
    """The content of a display, which is packed for a page just before it is sent.

    Args:
        key: the key of the content in outboxes.
        content: the full content.
        shrink: returns the content reduced to a number of bytes.
        pack: returns the binary frame with some content.

    Attributes:
        gone: whether the content was replaced or removed, and must not be sent any more.
    """

    def __init__(self, key: str, content: DataContent, shrink: Shrink, pack: Pack) -> None:
        self.key = key
        self.gone = False
        self._content = content
        self._shrink = shrink
        self._pack = pack
        self._smaller: dict[int, asyncio.Future[bytes]] = {}

    @cached_property
    def full_frame(self) -> bytes:
        """The frame with the full content."""
        return self._pack(self._content)

    async def fitting(self, room: int) -> bytes:
        """Return a frame with as much content as fits into about `room` bytes.

        The room is rounded down to a power of two, so that pages with similar connections share a frame.
        """
        if len(self.full_frame) <= room:
            return self.full_frame
        size = 1 << (room.bit_length() - 1)
        if size not in self._smaller:
            self._smaller[size] = asyncio.ensure_future(asyncio.to_thread(self._made, size))
        return await asyncio.shield(self._smaller[size])

    def _made(self, size: int) -> bytes:
        return self._pack(self._shrink(size))


class ChunkedFrame:
    """A frame that an outbox sends in chunks, with other payloads between them.

    Args:
        payload: the content.
        number: the number of the transfer, which is unique for the page.
        size: returns the size of the next chunk in bytes.
    """

    def __init__(self, payload: ScaledData, number: int, size: Callable[[], int]) -> None:
        self.payload = payload
        self.key = payload.key
        self._number = number
        self._size = size
        self._given = 0

    @property
    def done(self) -> bool:
        """Whether all chunks were sent, or the content was replaced or removed."""
        return self.payload.gone or self._given >= len(self.payload.full_frame)

    def since(self, seen: int) -> tuple[bytes | None, int]:
        """Return the next chunk, or None if there is none, and `seen` unchanged.

        This object itself counts the chunks.
        """
        if self.done:
            return None, seen
        size = self._size()
        piece = pack_piece(self.payload.full_frame, self._number, self._given, size)
        self._given += size
        return piece, seen


FRAME_TABLE = "frame_table"
TRANSFORMS = "transforms"
_URGENT = (FRAME_TABLE, TRANSFORMS)

Outgoing = str | bytes
"""Text of a control message, or a binary frame."""


class Changes(Protocol):
    """Content that is sent as changes: each page receives the combined changes that it lacks.

    A slow page then receives many changes in one frame, and no content that has been removed since.
    """

    key: str
    """Its key in the outbox."""

    def since(self, seen: int) -> tuple[Outgoing | None, int]:
        """Return the message or binary frame for a page.

        Args:
            seen: the number that this method returned for the page's previous message; 0 for a new page.

        Returns:
            The message or frame, or None if the page lacks nothing; and the number to pass for the next message.
        """


Payload = Outgoing | Changes | ScaledData


class Outbox:
    """A queue of payloads by redundancy key.

    A payload replaces a queued payload with the same key and moves to the end, so payloads are sent in the order of
    their creation. Large content keeps its position, because the most frequent content would otherwise starve the rest.
    Frame tables and transforms have a separate queue that alternates with the other one: a slider moves the scene
    before anything else is sent, but on a slow page the other payloads are not starved.

    Attributes:
        is_held: whether the connection is full, in which case only frame tables and transforms are taken.
    """

    def __init__(self) -> None:
        self._urgent: dict[str, Payload] = {}
        self._ordinary: dict[str, Payload] = {}
        self._filled = asyncio.Event()
        self._urgent_last = False
        self._seen: dict[str, int] = {}
        self.is_held = False

    def __len__(self) -> int:
        return len(self._urgent) + len(self._ordinary)

    def put(self, key: str, payload: Payload) -> None:
        """Queue a payload, replacing a queued payload with the same key."""
        line = self._urgent if key in _URGENT else self._ordinary
        before = line.get(key)
        if not (isinstance(before, ScaledData) and isinstance(payload, ScaledData) and not before.gone):
            line.pop(key, None)
        line[key] = payload
        self._filled.set()

    def __contains__(self, key: str) -> bool:
        return key in self._urgent or key in self._ordinary

    def hold(self, held: bool) -> None:
        """Set whether everything except frame tables and transforms is held back."""
        self.is_held = held
        self._filled.set()

    async def take(self) -> Outgoing | ScaledData:
        """Return the next payload, waiting until there is one."""
        while True:
            while not self._urgent and (self.is_held or not self._ordinary):
                self._filled.clear()
                await self._filled.wait()
            others = self._ordinary and not self.is_held
            self._urgent_last = bool(self._urgent) and not (self._urgent_last and others)
            line = self._urgent if self._urgent_last else self._ordinary
            made = self.make(line.pop(next(iter(line))))
            if made is not None:
                return made

    def make(self, payload: Payload) -> Outgoing | ScaledData | None:
        """Return what is to be sent for a payload, or None if there is nothing to send."""
        if isinstance(payload, (str, bytes)):
            return payload
        if isinstance(payload, ScaledData):
            return None if payload.gone else payload
        made, self._seen[payload.key] = payload.since(self._seen.get(payload.key, 0))
        return made


BULK = 4096
"""Messages of at least so many bytes are counted; pages acknowledge those (and some smaller ones)."""

_SHARE = 0.1
"""Seconds that one payload may keep the line busy."""

_FIRST_ROOM = 24 * 1024
_LEAST_ROOM = 6 * 1024

_BLOCKED = 0.02
"""Seconds of waiting for the socket that indicate a slow line, not a busy machine."""

_MEAN_OF = 8
"""Number of answers in the mean."""

_MOST_ON_THE_WAY = 64
"""Messages remembered for the first answer of a page that may never answer."""


@dataclass(slots=True)
class _InTransit:
    number: int
    size: int
    sent: float


class Line:
    """Measures the connection to one page.

    A page acknowledges large messages, so that the full path is measured, including tunnels that have their own
    buffers.
    For a page that sends no acknowledgements, only the time in which the socket accepted the data is known.

    Args:
        clock: returns the time in seconds.

    Attributes:
        rate: bytes per second; None until it is known.
        took: the mean time in seconds from a large message to its acknowledgement, over the last such messages; None
            until it is known.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.rate: float | None = None
        self.took: float | None = None
        self._clock = clock
        self._number = 0
        self._answers = False
        self._shortest = float("inf")
        self._on_the_way: deque[_InTransit] = deque()
        self._hello: float | None = None

    @property
    def room(self) -> int:
        """The size in bytes that a reducible payload should have."""
        return _FIRST_ROOM if self.rate is None else max(_LEAST_ROOM, int(self.rate * _SHARE))

    @property
    def is_full(self) -> bool:
        """Whether large messages must wait until the page has acknowledged earlier ones."""
        return self._answers and sum(on_the_way.size for on_the_way in self._on_the_way) >= self.room / 2

    @property
    def is_idle(self) -> bool:
        """Whether the page has acknowledged all large messages."""
        return self._answers and not self._on_the_way

    def sending(self, size: int) -> float:
        """Record that `size` bytes are passed to the socket; return the time to pass to `sent`."""
        now = self._clock()
        self._number += 1
        if self._number == 1:
            self._hello = now
        if size >= BULK:
            self._on_the_way.append(_InTransit(self._number, size, now))
        return now

    def sent(self, size: int, since: float) -> None:
        """Record that the socket has accepted a message of `size` bytes.

        `since` is the time that `sending` returned.
        """
        if self._answers or size < BULK:
            return
        while len(self._on_the_way) > _MOST_ON_THE_WAY:
            self._on_the_way.popleft()
        seconds = self._clock() - since
        if seconds >= _BLOCKED:
            self._learn(size / seconds)
        elif 2 * size >= self.room:  # some buffer of unknown size took it
            self._learn(float("inf"))

    def received(self, count: int) -> None:
        """Record that the page has acknowledged its first `count` messages."""
        now = self._clock()
        if not self._answers:
            self._answers = True
            if self._hello is not None:
                self._shortest = now - self._hello
        while self._on_the_way and self._on_the_way[0].number <= count:
            arrived = self._on_the_way.popleft()
            took = now - arrived.sent
            self._shortest = min(self._shortest, took)
            self.took = took if self.took is None else self.took + (took - self.took) / _MEAN_OF
            if 2 * arrived.size >= min(self.room, _FIRST_ROOM):
                self._learn(arrived.size / max(took - self._shortest, took / 10, 1e-4))

    def _learn(self, rate: float) -> None:
        """Update the rate with a measurement in bytes per second.

        A measurement at most doubles or halves the rate, because it may be an outlier.
        """
        known = self.room / _SHARE
        self.rate = min(max(rate, known / 2), known * 2)
