"""The queue of payloads for a page, and the measured rate of the page's connection.

Only the newest payload of each kind is queued. Transforms precede other payloads. Large content is reduced for a slow
connection, or sent in chunks.
"""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

from linkwright.page.protocol.message import DataContent, pack_chunk

Pack = Callable[[DataContent], bytes]
Shrink = Callable[[int], DataContent]
"""Returns the content reduced to about the given number of bytes, or as far as possible. Called in a thread."""


class ScaledData:
    """The content of a display, packed for each page just before it is sent.

    Args:
        key: the key of the content in outboxes.
        content: the full content.
        shrink: returns the content reduced to a number of bytes.
        pack: returns the binary frame with the given content.

    Attributes:
        is_withdrawn: whether the content was replaced or removed, so that it must no longer be sent.
    """

    def __init__(self, key: str, content: DataContent, shrink: Shrink, pack: Pack) -> None:
        self.key = key
        self.is_withdrawn = False
        self._content = content
        self._shrink = shrink
        self._pack = pack
        self._frames_by_size: dict[int, asyncio.Future[bytes]] = {}

    @cached_property
    def full_frame(self) -> bytes:
        """The frame with the full content."""
        return self._pack(self._content)

    async def pack_fitting(self, room: int) -> bytes:
        """Return a frame with as much content as fits into about `room` bytes.

        `room` is rounded down to a power of two, so that pages with similar connections share a frame.
        """
        if len(self.full_frame) <= room:
            return self.full_frame
        size = 1 << (room.bit_length() - 1)
        if size not in self._frames_by_size:
            self._frames_by_size[size] = asyncio.ensure_future(asyncio.to_thread(self._pack_reduced, size))
        return await asyncio.shield(self._frames_by_size[size])

    def _pack_reduced(self, size: int) -> bytes:
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
        self._next_size = size
        self._sent_bytes = 0

    @property
    def done(self) -> bool:
        """Whether all chunks were sent, or the content was replaced or removed."""
        return self.payload.is_withdrawn or self._sent_bytes >= len(self.payload.full_frame)

    def since(self, seen: int) -> tuple[bytes | None, int]:
        """Return the next chunk, or None if there is none, and `seen` unchanged.

        The position in the frame is stored in this object, not in `seen`.
        """
        if self.done:
            return None, seen
        size = self._next_size()
        chunk = pack_chunk(self.payload.full_frame, self._number, self._sent_bytes, size)
        self._sent_bytes += size
        return chunk, seen


FRAME_TABLE = "frame_table"
TRANSFORMS = "transforms"
_URGENT_KEYS = (FRAME_TABLE, TRANSFORMS)

Outgoing = str | bytes
"""The text of a control message, or a binary frame."""


class Changes(Protocol):
    """Content that is sent as changes.

    Each page receives all changes since its last message in one message.

    A slow page therefore receives many changes in one frame, and no content that was removed in the meantime.
    """

    key: str
    """The key of the content in outboxes."""

    def since(self, seen: int) -> tuple[Outgoing | None, int]:
        """Return the message or binary frame for a page.

        Args:
            seen: the number that this method returned for the page's previous message; 0 for a new page.

        Returns:
            The message or frame, or None if nothing has changed, and the number to pass for the next message.
        """


Payload = Outgoing | Changes | ScaledData


class Outbox:
    """A queue of payloads by redundancy key.

    A payload replaces a queued payload with the same key and moves to the end, so payloads are sent in the order of
    their creation. Large content keeps its position, because the most frequent content would otherwise starve the rest.
    Frame tables and transforms have a separate queue. The two queues alternate, beginning with the separate one. A
    slider therefore moves the scene immediately, and other payloads are not starved on a slow connection.

    Attributes:
        is_held: whether the connection is full, in which case only frame tables and transforms are taken.
    """

    def __init__(self) -> None:
        self._urgent: dict[str, Payload] = {}
        self._ordinary: dict[str, Payload] = {}
        self._has_payloads = asyncio.Event()
        self._was_urgent = False
        self._seen_numbers: dict[str, int] = {}
        self.is_held = False

    def __len__(self) -> int:
        return len(self._urgent) + len(self._ordinary)

    def put(self, key: str, payload: Payload) -> None:
        """Queue a payload, replacing a queued payload with the same key."""
        queue = self._urgent if key in _URGENT_KEYS else self._ordinary
        previous = queue.get(key)
        if not (isinstance(previous, ScaledData) and isinstance(payload, ScaledData) and not previous.is_withdrawn):
            queue.pop(key, None)
        queue[key] = payload
        self._has_payloads.set()

    def __contains__(self, key: str) -> bool:
        return key in self._urgent or key in self._ordinary

    def hold(self, holds_back: bool) -> None:
        """Set whether all payloads except frame tables and transforms are held back."""
        self.is_held = holds_back
        self._has_payloads.set()

    async def take(self) -> Outgoing | ScaledData:
        """Return the next payload, waiting until there is one."""
        while True:
            while not self._urgent and (self.is_held or not self._ordinary):
                self._has_payloads.clear()
                await self._has_payloads.wait()
            has_others = self._ordinary and not self.is_held
            self._was_urgent = bool(self._urgent) and not (self._was_urgent and has_others)
            queue = self._urgent if self._was_urgent else self._ordinary
            content = self.make(queue.pop(next(iter(queue))))
            if content is not None:
                return content

    def make(self, payload: Payload) -> Outgoing | ScaledData | None:
        """Return the content to send for a payload, or None if there is none."""
        if isinstance(payload, (str, bytes)):
            return payload
        if isinstance(payload, ScaledData):
            return None if payload.is_withdrawn else payload
        content, self._seen_numbers[payload.key] = payload.since(self._seen_numbers.get(payload.key, 0))
        return content


MIN_MEASURED_SIZE = 4096
"""The minimum size in bytes of messages that are measured. Pages acknowledge all of these messages."""

_MAX_BUSY_TIME_S = 0.1
"""The time in s for which one payload may occupy the connection."""

_INITIAL_BUDGET = 24 * 1024
_MIN_BUDGET = 6 * 1024

_MIN_BLOCKED_TIME_S = 0.02
"""The minimum time of waiting for the socket, in s, of a slow connection."""

_AVERAGED_COUNT = 8
"""The number of acknowledgments over which times are averaged."""

_MAX_IN_TRANSIT = 64
"""The largest number of stored messages for a page that has not acknowledged any message yet."""


@dataclass(slots=True)
class _InTransit:
    number: int
    size: int
    sent: float


class ConnectionMeter:
    """A meter of the connection to one page.

    A page acknowledges large messages, so that the full path is measured, including tunnels with buffers. For a page
    without acknowledgments, only the time in which the socket accepts the data is known.

    Args:
        clock: returns the time in seconds.

    Attributes:
        rate: bytes per second; None until it is known.
        acknowledgment_time: the mean time in seconds between a large message and its acknowledgment; None until it
            is known.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.rate: float | None = None
        self.acknowledgment_time: float | None = None
        self._clock = clock
        self._number = 0
        self._has_acknowledged = False
        self._shortest_time = float("inf")
        self._in_transit: deque[_InTransit] = deque()
        self._first_sent_time: float | None = None

    @property
    def room(self) -> int:
        """The target size of large content, in bytes."""
        return _INITIAL_BUDGET if self.rate is None else max(_MIN_BUDGET, int(self.rate * _MAX_BUSY_TIME_S))

    @property
    def is_full(self) -> bool:
        """Whether large messages must wait until the page has acknowledged earlier messages."""
        return self._has_acknowledged and sum(message.size for message in self._in_transit) >= self.room / 2

    @property
    def is_idle(self) -> bool:
        """Whether the page has acknowledged all large messages."""
        return self._has_acknowledged and not self._in_transit

    def sending(self, size: int) -> float:
        """Record that `size` bytes are passed to the socket, and return the time for `sent`."""
        now = self._clock()
        self._number += 1
        if self._number == 1:
            self._first_sent_time = now
        if size >= MIN_MEASURED_SIZE:
            self._in_transit.append(_InTransit(self._number, size, now))
        return now

    def sent(self, size: int, start_time: float) -> None:
        """Record that the socket has accepted a message of `size` bytes.

        `start_time` is the time that `sending` returned.
        """
        if self._has_acknowledged or size < MIN_MEASURED_SIZE:
            return
        while len(self._in_transit) > _MAX_IN_TRANSIT:
            self._in_transit.popleft()
        seconds = self._clock() - start_time
        if seconds >= _MIN_BLOCKED_TIME_S:
            self._update_rate(size / seconds)
        elif 2 * size >= self.room:  # a buffer of unknown size has accepted it
            self._update_rate(float("inf"))

    def record_acknowledged(self, count: int) -> None:
        """Record that the page has acknowledged its first `count` messages."""
        now = self._clock()
        if not self._has_acknowledged:
            self._has_acknowledged = True
            if self._first_sent_time is not None:
                self._shortest_time = now - self._first_sent_time
        while self._in_transit and self._in_transit[0].number <= count:
            acknowledged = self._in_transit.popleft()
            elapsed = now - acknowledged.sent
            self._shortest_time = min(self._shortest_time, elapsed)
            self.acknowledgment_time = (
                elapsed
                if self.acknowledgment_time is None
                else self.acknowledgment_time + (elapsed - self.acknowledgment_time) / _AVERAGED_COUNT
            )
            if 2 * acknowledged.size >= min(self.room, _INITIAL_BUDGET):
                self._update_rate(acknowledged.size / max(elapsed - self._shortest_time, elapsed / 10, 1e-4))

    def _update_rate(self, rate: float) -> None:
        """Update the rate with a measurement in bytes per second.

        A measurement at most doubles or halves the rate, because it may be an outlier.
        """
        previous_rate = self.room / _MAX_BUSY_TIME_S
        self.rate = min(max(rate, previous_rate / 2), previous_rate * 2)
