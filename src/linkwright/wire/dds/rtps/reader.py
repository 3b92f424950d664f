"""RTPS readers that request missing samples (DDSI-RTPS 2.5, 8.4.12).

A sample is passed on when it arrives, even if an earlier one is still missing: the order of requests and responses does
not matter, and no call waits for another one.
"""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from linkwright.wire.dds.rtps.messages import Data, Gap, Heartbeat, acknack, message
from linkwright.wire.dds.rtps.values import PREFIX, Address
from linkwright.wire.dds.rtps.writer import Packet

_FIRST_REPEAT, _LAST_REPEAT = 0.05, 2.0
"""Seconds after which a silent writer is asked for its samples, and the limit to which that interval grows."""

_MOST_MISSING = 256
_MAX_AHEAD = 100_000
"""How far ahead of the next expected number a reader takes note of samples."""

_LARGEST = 1 << 30
_MOST_INCOMPLETE = 8


@dataclass(slots=True)
class _Incomplete:
    """A sample whose fragments have not all arrived."""

    size: int
    fragment: int
    parts: dict[int, bytes] = field(default_factory=dict)

    def add(self, first: int, payload: bytes) -> bytes | None:
        """Add consecutive fragments; return the sample once it is complete, otherwise None.

        Args:
            first: the number of the first fragment.
            payload: the bytes of the fragments.
        """
        count = (self.size + self.fragment - 1) // self.fragment
        for start in range(0, len(payload), self.fragment):
            number = first + start // self.fragment
            if number <= count:
                self.parts.setdefault(number, payload[start : start + self.fragment])
        if len(self.parts) < count or any(number not in self.parts for number in range(1, count + 1)):
            return None
        return b"".join(self.parts[number] for number in range(1, count + 1))[: self.size]


@dataclass(slots=True)
class _Writer:
    addresses: tuple[Address, ...]
    low: int = 1
    """Everything before it is here, or not to be had."""
    later: set[int] = field(default_factory=set)
    incomplete: dict[int, _Incomplete] = field(default_factory=dict)
    count: int = 0
    heard_at: float | None = None
    last: int = 0
    due: float = 0.0
    repeat: float = _FIRST_REPEAT

    def has(self, number: int) -> bool:
        return number < self.low or number in self.later

    def add(self, number: int) -> None:
        self.later.add(number)
        self.incomplete.pop(number, None)
        self._advance_low()

    def start_at(self, number: int) -> None:
        if number > self.low:
            self.low = number
            self.later = {value for value in self.later if value >= number}
            self.incomplete = {each: part for each, part in self.incomplete.items() if each >= number}
        self._advance_low()

    def _advance_low(self) -> None:
        while self.low in self.later:
            self.later.discard(self.low)
            self.low += 1

    def missing(self) -> list[int]:
        end = min(self.last + 1, self.low + _MOST_MISSING)
        return [number for number in range(self.low, end) if number not in self.later]


class Reader:
    """An RTPS reader.

    Args:
        guid: the reader's GUID, 16 bytes.
    """

    def __init__(self, guid: bytes) -> None:
        self.guid = guid
        self._writers: dict[bytes, _Writer] = {}

    @property
    def writers(self) -> Iterable[bytes]:
        """The GUIDs of the matched writers."""
        return self._writers.keys()

    def heard_at(self, writer: bytes) -> float | None:
        """Return when the first heartbeat of a writer arrived, in seconds of the steady clock.

        Returns None if none has arrived. A heartbeat shows that the writer has matched this reader.
        """
        matched = self._writers.get(writer)
        return matched.heard_at if matched is not None else None

    def last_of(self, writer: bytes) -> int:
        """Return the highest sequence number that a writer has announced to this reader."""
        matched = self._writers.get(writer)
        return matched.last if matched is not None else 0

    def match(self, writer: bytes, addresses: tuple[Address, ...]) -> list[Packet]:
        """Match a writer; return the packets that request its samples."""
        if writer in self._writers:
            self._writers[writer].addresses = addresses
            return []
        matched = self._writers[writer] = _Writer(addresses)
        return [self._ask(writer, matched, time.monotonic())]

    def unmatch(self, writer: bytes) -> None:
        """Unmatch a writer."""
        self._writers.pop(writer, None)

    def on_data(self, sample: Data) -> Data | None:
        """Handle a sample or fragment; return the sample if it is new and complete, otherwise None."""
        matched = self._writers.get(sample.writer)
        if matched is None or matched.has(sample.number) or sample.number > max(matched.low, matched.last) + _MAX_AHEAD:
            return None
        complete: Data | None = sample
        if sample.first:
            payload = self._complete(matched, sample)
            complete = None if payload is None else replace(sample, payload=payload, first=0)
        if complete is not None:
            matched.add(sample.number)
            matched.last = max(matched.last, sample.number)
        return complete

    def on_heartbeat(self, heartbeat: Heartbeat) -> list[Packet]:
        """Handle a heartbeat; return its acknowledgement, with the numbers of missing samples."""
        matched = self._writers.get(heartbeat.writer)
        if matched is None:
            return []
        if matched.heard_at is None:
            matched.heard_at = time.monotonic()
        matched.last = max(matched.last, heartbeat.last)
        matched.start_at(heartbeat.first)
        if heartbeat.final and not matched.missing():
            return []
        return [self._answer(heartbeat.writer, matched)]

    def on_gap(self, gap: Gap) -> None:
        """Handle a GAP: the samples in it count as received.

        Such samples are not for this reader, or the writer no longer has them.
        """
        matched = self._writers.get(gap.writer)
        if matched is None:
            return
        if gap.start <= matched.low:
            matched.start_at(gap.base)
        else:
            for number in range(gap.start, min(gap.base, gap.start + _MAX_AHEAD)):
                matched.add(number)
        for number in gap.others:
            if not matched.has(number):
                matched.add(number)

    def remind(self, now: float) -> list[Packet]:
        """Return the packets that repeat a request to silent writers, if a request is due."""
        silent = [item for item in self._writers.items() if item[1].heard_at is None and now >= item[1].due]
        return [self._ask(writer, matched, now) for writer, matched in silent]

    def next_reminder(self) -> float | None:
        """Return when to call `remind` next, in seconds of the steady clock.

        Returns None if all writers have sent a heartbeat.
        """
        return min((matched.due for matched in self._writers.values() if matched.heard_at is None), default=None)

    @staticmethod
    def _complete(matched: _Writer, sample: Data) -> bytes | None:
        if sample.payload is None or sample.size > _LARGEST:
            return None
        part = matched.incomplete.get(sample.number)
        if part is None or (part.size, part.fragment) != (sample.size, sample.fragment):
            while len(matched.incomplete) >= _MOST_INCOMPLETE:
                matched.incomplete.pop(min(matched.incomplete))
            part = matched.incomplete[sample.number] = _Incomplete(sample.size, sample.fragment)
        return part.add(sample.first, sample.payload)

    def _ask(self, writer: bytes, matched: _Writer, now: float) -> Packet:
        """Return an acknowledgement of no samples, with base 0, as a request for a heartbeat.

        Fast DDS answers base 0, but not base 1, with a heartbeat.
        """
        matched.due, matched.repeat = now + matched.repeat, min(matched.repeat * 2, _LAST_REPEAT)
        return self._acknack(writer, matched, 0, [], final=False)

    def _answer(self, writer: bytes, matched: _Writer) -> Packet:
        return self._acknack(writer, matched, matched.low, matched.missing(), final=True)

    def _acknack(self, writer: bytes, matched: _Writer, base: int, missing: list[int], *, final: bool) -> Packet:
        matched.count += 1
        answer = acknack(self.guid[PREFIX:], writer[PREFIX:], base, missing, matched.count, final=final)
        return message(self.guid[:PREFIX], answer, to=writer[:PREFIX]), matched.addresses
