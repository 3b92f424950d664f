"""Readers of RTPS that ask for what they lack (DDSI-RTPS 2.5, 8.4.12).

A sample is handed on when it arrives, though an earlier one may still be on its way: requests and responses need no
order, and no call waits for another one.
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
_FURTHEST = 100_000
"""How far ahead of the next expected number a reader takes note of samples."""

_LARGEST = 1 << 30
_MOST_INCOMPLETE = 8


@dataclass(slots=True)
class _Incomplete:
    """A sample of which not all fragments are here."""

    size: int
    fragment: int
    parts: dict[int, bytes] = field(default_factory=dict)

    def add(self, first: int, payload: bytes) -> bytes | None:
        """Take fragments from the one with number `first` on; the sample when it is complete."""
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
        self.close_up()

    def start_at(self, number: int) -> None:
        if number > self.low:
            self.low = number
            self.later = {each for each in self.later if each >= number}
            self.incomplete = {each: part for each, part in self.incomplete.items() if each >= number}
        self.close_up()

    def close_up(self) -> None:
        while self.low in self.later:
            self.later.discard(self.low)
            self.low += 1

    def missing(self) -> list[int]:
        end = min(self.last + 1, self.low + _MOST_MISSING)
        return [number for number in range(self.low, end) if number not in self.later]


class Reader:
    """A reader.

    Args:
        guid: 16 bytes.
    """

    def __init__(self, guid: bytes) -> None:
        self.guid = guid
        self._writers: dict[bytes, _Writer] = {}

    @property
    def writers(self) -> Iterable[bytes]:
        """The GUIDs of the writers that it hears."""
        return self._writers.keys()

    def heard_at(self, writer: bytes) -> float | None:
        """When the first heartbeat of a writer arrived, by the steady clock: it has matched this reader."""
        known = self._writers.get(writer)
        return known.heard_at if known is not None else None

    def last_of(self, writer: bytes) -> int:
        """The highest number that a writer has announced."""
        known = self._writers.get(writer)
        return known.last if known is not None else 0

    def match(self, writer: bytes, addresses: tuple[Address, ...]) -> list[Packet]:
        """Match a writer; returns the packets that ask it for its samples."""
        if writer in self._writers:
            self._writers[writer].addresses = addresses
            return []
        known = self._writers[writer] = _Writer(addresses)
        return [self._ask(writer, known, time.monotonic())]

    def unmatch(self, writer: bytes) -> None:
        """Unmatch a writer."""
        self._writers.pop(writer, None)

    def on_data(self, said: Data) -> Data | None:
        """A sample that is new and complete, else None."""
        known = self._writers.get(said.writer)
        if known is None or known.has(said.number) or said.number > max(known.low, known.last) + _FURTHEST:
            return None
        whole: Data | None = said
        if said.first:
            payload = self._complete(known, said)
            whole = None if payload is None else replace(said, payload=payload, first=0)
        if whole is not None:
            known.add(said.number)
            known.last = max(known.last, said.number)
        return whole

    def on_heartbeat(self, said: Heartbeat) -> list[Packet]:
        """The acknowledgement, with the numbers of missing samples."""
        known = self._writers.get(said.writer)
        if known is None:
            return []
        if known.heard_at is None:
            known.heard_at = time.monotonic()
        known.last = max(known.last, said.last)
        known.start_at(said.first)
        if said.final and not known.missing():
            return []
        return [self._answer(said.writer, known)]

    def on_gap(self, said: Gap) -> None:
        """Handle a GAP: samples that the writer no longer has, or that are not for this reader, count as received."""
        known = self._writers.get(said.writer)
        if known is None:
            return
        if said.start <= known.low:
            known.start_at(said.base)
        else:
            for number in range(said.start, min(said.base, said.start + _FURTHEST)):
                known.add(number)
        for number in said.others:
            if not known.has(number):
                known.add(number)

    def remind(self, now: float) -> list[Packet]:
        """The packets that ask silent writers again, where it is time."""
        silent = [item for item in self._writers.items() if item[1].heard_at is None and now >= item[1].due]
        return [self._ask(writer, known, now) for writer, known in silent]

    def next_reminder(self) -> float | None:
        """When `remind` is to be called; None while all have been heard."""
        return min((known.due for known in self._writers.values() if known.heard_at is None), default=None)

    @staticmethod
    def _complete(known: _Writer, said: Data) -> bytes | None:
        if said.payload is None or said.size > _LARGEST:
            return None
        part = known.incomplete.get(said.number)
        if part is None or (part.size, part.fragment) != (said.size, said.fragment):
            while len(known.incomplete) >= _MOST_INCOMPLETE:
                known.incomplete.pop(min(known.incomplete))
            part = known.incomplete[said.number] = _Incomplete(said.size, said.fragment)
        return part.add(said.first, said.payload)

    def _ask(self, writer: bytes, known: _Writer, now: float) -> Packet:
        """An acknowledgement of nothing, base 0, which Fast DDS answers with a heartbeat; not one with base 1."""
        known.due, known.repeat = now + known.repeat, min(known.repeat * 2, _LAST_REPEAT)
        return self._acknack(writer, known, 0, [], final=False)

    def _answer(self, writer: bytes, known: _Writer) -> Packet:
        return self._acknack(writer, known, known.low, known.missing(), final=True)

    def _acknack(self, writer: bytes, known: _Writer, base: int, missing: list[int], *, final: bool) -> Packet:
        known.count += 1
        answer = acknack(self.guid[PREFIX:], writer[PREFIX:], base, missing, known.count, final=final)
        return message(self.guid[:PREFIX], answer, to=writer[:PREFIX]), known.addresses
