"""RTPS readers that request missing samples (DDSI-RTPS 2.5, 8.4.12).

A sample is passed on when it arrives, even if an earlier sample is missing. The order of requests and responses does
not matter, and no call waits for another call.
"""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from linkwright.wire.dds.rtps.messages import Data, Gap, Heartbeat, acknack, build_message
from linkwright.wire.dds.rtps.values import PREFIX_SIZE, Address
from linkwright.wire.dds.rtps.writer import Packet

_FIRST_REPEAT_S, _LAST_REPEAT_S = 0.05, 2.0
"""Seconds after which a silent writer is asked for its samples, and the limit to which that interval grows."""

_MAX_MISSING = 256
_MAX_AHEAD = 100_000
"""The maximum distance of a sample's number from the next expected number. Later samples are ignored."""

_MAX_SAMPLE_SIZE = 1 << 30
_MAX_INCOMPLETE = 8


@dataclass(slots=True)
class _Incomplete:
    """A sample whose fragments have not all arrived."""

    size: int
    fragment: int
    parts: dict[int, bytes] = field(default_factory=dict)

    def add(self, first: int, payload: bytes) -> bytes | None:
        """Add consecutive fragments, and return the complete sample or None.

        Args:
            first: the number of the first fragment.
            payload: the bytes of the fragments.
        """
        count = (self.size + self.fragment - 1) // self.fragment
        for start in range(0, len(payload), self.fragment):
            fragment_number = first + start // self.fragment
            if fragment_number <= count:
                self.parts.setdefault(fragment_number, payload[start : start + self.fragment])
        if len(self.parts) < count or any(fragment_number not in self.parts for fragment_number in range(1, count + 1)):
            return None
        return b"".join(self.parts[fragment_number] for fragment_number in range(1, count + 1))[: self.size]


@dataclass(slots=True)
class _WriterState:
    addresses: tuple[Address, ...]
    low: int = 1
    """All samples before this number have arrived, or are not available."""
    later: set[int] = field(default_factory=set)
    incomplete: dict[int, _Incomplete] = field(default_factory=dict)
    count: int = 0
    heard_at: float | None = None
    last: int = 0
    due_at: float = 0.0
    repeat: float = _FIRST_REPEAT_S

    def has(self, sequence_number: int) -> bool:
        return sequence_number < self.low or sequence_number in self.later

    def add(self, sequence_number: int) -> None:
        self.later.add(sequence_number)
        self.incomplete.pop(sequence_number, None)
        self._advance_low()

    def start_at(self, sequence_number: int) -> None:
        if sequence_number > self.low:
            self.low = sequence_number
            self.later = {value for value in self.later if value >= sequence_number}
            self.incomplete = {
                incomplete_number: incomplete_sample
                for incomplete_number, incomplete_sample in self.incomplete.items()
                if incomplete_number >= sequence_number
            }
        self._advance_low()

    def _advance_low(self) -> None:
        while self.low in self.later:
            self.later.discard(self.low)
            self.low += 1

    def missing(self) -> list[int]:
        end = min(self.last + 1, self.low + _MAX_MISSING)
        return [sequence_number for sequence_number in range(self.low, end) if sequence_number not in self.later]


class Reader:
    """An RTPS reader.

    Args:
        guid: the reader's GUID, 16 bytes.
    """

    def __init__(self, guid: bytes) -> None:
        self.guid = guid
        self._writers: dict[bytes, _WriterState] = {}

    @property
    def writers(self) -> Iterable[bytes]:
        """The GUIDs of the matched writers."""
        return self._writers.keys()

    def heard_at(self, writer: bytes) -> float | None:
        """Return when the first heartbeat of a writer arrived, in seconds of the steady clock.

        Returns None if none has arrived. A heartbeat shows that the writer has matched this reader.
        """
        writer_state = self._writers.get(writer)
        return writer_state.heard_at if writer_state is not None else None

    def get_last_number(self, writer: bytes) -> int:
        """Return the highest sequence number that a writer has announced to this reader."""
        writer_state = self._writers.get(writer)
        return writer_state.last if writer_state is not None else 0

    def match(self, writer: bytes, addresses: tuple[Address, ...]) -> list[Packet]:
        """Match a writer, and return the packets that request its samples."""
        if writer in self._writers:
            self._writers[writer].addresses = addresses
            return []
        writer_state = self._writers[writer] = _WriterState(addresses)
        return [self._request_heartbeat(writer, writer_state, time.monotonic())]

    def unmatch(self, writer: bytes) -> None:
        """Unmatch a writer."""
        self._writers.pop(writer, None)

    def on_data(self, sample: Data) -> Data | None:
        """Handle a sample or fragment.

        Return the sample if it is new and complete, otherwise None.
        """
        writer_state = self._writers.get(sample.writer)
        if (
            writer_state is None
            or writer_state.has(sample.sequence_number)
            or sample.sequence_number > max(writer_state.low, writer_state.last) + _MAX_AHEAD
        ):
            return None
        complete: Data | None = sample
        if sample.first:
            payload = self._complete(writer_state, sample)
            complete = None if payload is None else replace(sample, payload=payload, first=0)
        if complete is not None:
            writer_state.add(sample.sequence_number)
            writer_state.last = max(writer_state.last, sample.sequence_number)
        return complete

    def on_heartbeat(self, heartbeat: Heartbeat) -> list[Packet]:
        """Handle a heartbeat, and return its acknowledgment with the numbers of missing samples."""
        writer_state = self._writers.get(heartbeat.writer)
        if writer_state is None:
            return []
        if writer_state.heard_at is None:
            writer_state.heard_at = time.monotonic()
        writer_state.last = max(writer_state.last, heartbeat.last)
        writer_state.start_at(heartbeat.first)
        if heartbeat.final and not writer_state.missing():
            return []
        return [self._acknowledge(heartbeat.writer, writer_state)]

    def on_gap(self, gap: Gap) -> None:
        """Handle a GAP by counting its samples as received.

        Such samples are not for this reader, or the writer no longer has them.
        """
        writer_state = self._writers.get(gap.writer)
        if writer_state is None:
            return
        if gap.start <= writer_state.low:
            writer_state.start_at(gap.base)
        else:
            for sequence_number in range(gap.start, min(gap.base, gap.start + _MAX_AHEAD)):
                writer_state.add(sequence_number)
        for sequence_number in gap.other_numbers:
            if not writer_state.has(sequence_number):
                writer_state.add(sequence_number)

    def remind(self, now: float) -> list[Packet]:
        """Return the packets that repeat a request to silent writers, if a request is due."""
        silent_writers = [item for item in self._writers.items() if item[1].heard_at is None and now >= item[1].due_at]
        return [self._request_heartbeat(writer, writer_state, now) for writer, writer_state in silent_writers]

    def next_reminder(self) -> float | None:
        """Return when to call `remind` next, in seconds of the steady clock.

        Returns None if all writers have sent a heartbeat.
        """
        return min(
            (writer_state.due_at for writer_state in self._writers.values() if writer_state.heard_at is None),
            default=None,
        )

    @staticmethod
    def _complete(writer_state: _WriterState, sample: Data) -> bytes | None:
        if sample.payload is None or sample.size > _MAX_SAMPLE_SIZE:
            return None
        incomplete_sample = writer_state.incomplete.get(sample.sequence_number)
        if incomplete_sample is None or (incomplete_sample.size, incomplete_sample.fragment) != (
            sample.size,
            sample.fragment,
        ):
            while len(writer_state.incomplete) >= _MAX_INCOMPLETE:
                writer_state.incomplete.pop(min(writer_state.incomplete))
            incomplete_sample = writer_state.incomplete[sample.sequence_number] = _Incomplete(
                sample.size, sample.fragment
            )
        return incomplete_sample.add(sample.first, sample.payload)

    def _request_heartbeat(self, writer: bytes, writer_state: _WriterState, now: float) -> Packet:
        """Return an acknowledgment of no samples (base 0), which requests a heartbeat.

        Fast DDS answers base 0, but not base 1, with a heartbeat.
        """
        writer_state.due_at, writer_state.repeat = (
            now + writer_state.repeat,
            min(writer_state.repeat * 2, _LAST_REPEAT_S),
        )
        return self._acknack(writer, writer_state, 0, [], final=False)

    def _acknowledge(self, writer: bytes, writer_state: _WriterState) -> Packet:
        return self._acknack(writer, writer_state, writer_state.low, writer_state.missing(), final=True)

    def _acknack(
        self, writer: bytes, writer_state: _WriterState, base: int, missing: list[int], *, final: bool
    ) -> Packet:
        writer_state.count += 1
        submessage = acknack(
            self.guid[PREFIX_SIZE:], writer[PREFIX_SIZE:], base, missing, writer_state.count, final=final
        )
        return build_message(self.guid[:PREFIX_SIZE], submessage, to=writer[:PREFIX_SIZE]), writer_state.addresses
