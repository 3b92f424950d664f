"""RTPS writers that resend samples until the readers have acknowledged them.

Source: DDSI-RTPS 2.5, 8.4.9.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from linkwright.wire.dds.rtps.messages import (
    FRAGMENT_SIZE,
    AckNack,
    NackFrag,
    build_data_fragment,
    build_info_timestamp,
    build_message,
    count_fragments,
    data,
    gap,
    heartbeat,
)
from linkwright.wire.dds.rtps.values import PREFIX_SIZE, Address

_FIRST_REPEAT_S, _LAST_REPEAT_S = 0.1, 2.0
"""The first and the longest interval, in seconds, between reminders to a reader that has not acknowledged."""

_MAX_SAMPLES = 1000
_MAX_BYTES = 64 << 20
"""The maximum number and size of samples that wait for acknowledgment.

When a limit is exceeded, the oldest samples are dropped.
"""

Packet = tuple[bytes, tuple[Address, ...]]
"""A message and its addresses."""


@dataclass(frozen=True, slots=True)
class _Change:
    payload: bytes | None
    inline: bytes
    to: bytes
    written_ns: int

    def is_for(self, reader: bytes) -> bool:
        return reader.startswith(self.to)


@dataclass(slots=True)
class _ReaderState:
    addresses: tuple[Address, ...]
    base: int
    """All samples before this number were acknowledged, or are not for this reader."""
    due_at: float = 0.0
    repeat: float = _FIRST_REPEAT_S
    heard: bool = False


class Writer:
    """An RTPS writer.

    Args:
        guid: the writer's GUID, 16 bytes.
        keeps_history: whether late-joining readers receive earlier samples.
    """

    def __init__(self, guid: bytes, *, keeps_history: bool = False) -> None:
        self.guid = guid
        self._keeps_history = keeps_history
        self._changes: dict[int, _Change] = {}
        self._byte_count = 0
        self._last_sequence_number = 0
        self._count = 0
        self._readers: dict[bytes, _ReaderState] = {}

    @property
    def readers(self) -> Iterable[bytes]:
        """The GUIDs of the matched readers."""
        return self._readers.keys()

    def has_answered(self, reader: bytes) -> bool:
        """Return whether a reader has answered.

        An answer shows that it has matched this writer.
        """
        reader_state = self._readers.get(reader)
        return reader_state is not None and reader_state.heard

    def match(self, reader: bytes, addresses: tuple[Address, ...]) -> list[Packet]:
        """Match a reader, and return the first packets for it.

        If the writer keeps its history, these are the samples of the history, otherwise a heartbeat.
        """
        if reader in self._readers:
            self._readers[reader].addresses = addresses
            return []
        reader_state = self._readers[reader] = _ReaderState(
            addresses, 1 if self._keeps_history else self._last_sequence_number + 1
        )
        if not self._keeps_history:
            return [self._make_packet(reader, reader_state, self._make_heartbeat(reader, reader_state))]
        return self._make_history_packets(reader, reader_state)

    def unmatch(self, reader: bytes) -> None:
        """Remove a reader.

        No more samples are written to it.
        """
        self._readers.pop(reader, None)
        self._drop_acknowledged()

    def write(self, payload: bytes | None, *, inline: bytes = b"", to: bytes = b"") -> list[Packet]:
        """Write a new sample.

        Args:
            payload: the serialized payload; None to announce the end of the entity whose key is in `inline`.
            inline: the inline QoS.
            to: the GUID prefix of the readers that the sample is for; empty for all. Other readers receive a GAP.

        Returns:
            The packets to send.
        """
        self._last_sequence_number += 1
        sequence_number = self._last_sequence_number
        self._changes[sequence_number] = _Change(payload, inline, to, time.time_ns())
        self._byte_count += len(payload or b"")
        while len(self._changes) > 1 and (len(self._changes) > _MAX_SAMPLES or self._byte_count > _MAX_BYTES):
            self._drop(min(self._changes))
        packets: list[Packet] = []
        for reader, reader_state in self._readers.items():
            reader_state.due_at, reader_state.repeat = time.monotonic() + _FIRST_REPEAT_S, _FIRST_REPEAT_S
            packets += self._make_sample_packets(reader, reader_state, sequence_number)
        return packets

    def withdraw(self, sequence_number: int) -> None:
        """Remove a sample from the history for late-joining readers."""
        self._drop(sequence_number)

    @property
    def last(self) -> int:
        """The sequence number of the newest sample."""
        return self._last_sequence_number

    def on_acknack(self, acknack: AckNack) -> list[Packet]:
        """Handle an ACKNACK, and return the packets that resend the missing samples."""
        reader_state = self._readers.get(acknack.reader)
        if reader_state is None:
            return []
        reader_state.heard = True
        if acknack.base > reader_state.base:
            reader_state.base = min(acknack.base, self._last_sequence_number + 1)
            reader_state.repeat = _FIRST_REPEAT_S
            reader_state.due_at = time.monotonic() + reader_state.repeat
            self._drop_acknowledged()
        packets = [
            packet
            for sequence_number in acknack.missing
            for packet in self._repeat_sample(acknack.reader, reader_state, sequence_number)
        ]
        if packets or (not acknack.final and not acknack.missing):
            packets.append(
                self._make_packet(acknack.reader, reader_state, self._make_heartbeat(acknack.reader, reader_state))
            )
        return packets

    def on_nack_frag(self, nack: NackFrag) -> list[Packet]:
        """Handle a NACK_FRAG, and return the packets that resend the missing fragments."""
        reader_state, change = self._readers.get(nack.reader), self._changes.get(nack.sequence_number)
        if reader_state is None or change is None or change.payload is None or not change.is_for(nack.reader):
            return []
        fragment_total = count_fragments(change.payload)
        fragments = [fragment for fragment in nack.missing if 1 <= fragment <= fragment_total]
        packets = [
            self._make_fragment_packet(
                nack.reader, reader_state, nack.sequence_number, change, change.payload, fragment
            )
            for fragment in fragments
        ]
        return [*packets, self._make_packet(nack.reader, reader_state, self._make_heartbeat(nack.reader, reader_state))]

    def remind(self, now: float) -> list[Packet]:
        """Return the heartbeats that are due, for readers with unacknowledged samples."""
        packets = []
        for reader, reader_state in self._readers.items():
            if reader_state.base <= self._last_sequence_number and now >= reader_state.due_at:
                reader_state.due_at = now + reader_state.repeat
                reader_state.repeat = min(reader_state.repeat * 2, _LAST_REPEAT_S)
                packets.append(self._make_packet(reader, reader_state, self._make_heartbeat(reader, reader_state)))
        return packets

    def next_reminder(self) -> float | None:
        """Return when to call `remind` next, in seconds of the steady clock.

        Returns None if everything has been acknowledged.
        """
        return min(
            (
                reader_state.due_at
                for reader_state in self._readers.values()
                if reader_state.base <= self._last_sequence_number
            ),
            default=None,
        )

    # --- inside ------------------------------------------------------------------------------------------------------

    def _make_history_packets(self, reader: bytes, reader_state: _ReaderState) -> list[Packet]:
        reader_state.due_at = time.monotonic() + _FIRST_REPEAT_S
        packets = [
            packet
            for sequence_number in sorted(self._changes)
            for packet in self._make_sample_packets(reader, reader_state, sequence_number)
        ]
        return packets or [self._make_packet(reader, reader_state, self._make_heartbeat(reader, reader_state))]

    def _make_sample_packets(self, reader: bytes, reader_state: _ReaderState, sequence_number: int) -> Iterator[Packet]:
        change = self._changes[sequence_number]
        heartbeat_submessage = self._make_heartbeat(reader, reader_state)
        entity = reader[PREFIX_SIZE:]
        if not change.is_for(reader):
            yield self._make_packet(
                reader,
                reader_state,
                gap(entity, self.guid[PREFIX_SIZE:], sequence_number, sequence_number + 1),
                heartbeat_submessage,
            )
        elif change.payload is not None and len(change.payload) > FRAGMENT_SIZE:
            for fragment_number in range(1, count_fragments(change.payload) + 1):
                yield self._make_fragment_packet(
                    reader, reader_state, sequence_number, change, change.payload, fragment_number
                )
            yield self._make_packet(reader, reader_state, heartbeat_submessage)
        else:
            sample = data(entity, self.guid[PREFIX_SIZE:], sequence_number, change.payload, change.inline)
            yield self._make_packet(
                reader, reader_state, build_info_timestamp(change.written_ns), sample, heartbeat_submessage
            )

    def _repeat_sample(self, reader: bytes, reader_state: _ReaderState, sequence_number: int) -> Iterator[Packet]:
        if sequence_number in self._changes:
            yield from self._make_sample_packets(reader, reader_state, sequence_number)
        elif sequence_number <= self._last_sequence_number:
            yield self._make_packet(
                reader,
                reader_state,
                gap(reader[PREFIX_SIZE:], self.guid[PREFIX_SIZE:], sequence_number, sequence_number + 1),
            )

    def _make_fragment_packet(
        self,
        reader: bytes,
        reader_state: _ReaderState,
        sequence_number: int,
        change: _Change,
        payload: bytes,
        fragment_number: int,
    ) -> Packet:
        submessage = build_data_fragment(
            reader[PREFIX_SIZE:], self.guid[PREFIX_SIZE:], sequence_number, payload, fragment_number, change.inline
        )
        return self._make_packet(reader, reader_state, build_info_timestamp(change.written_ns), submessage)

    def _make_heartbeat(self, reader: bytes, reader_state: _ReaderState) -> bytes:
        self._count += 1
        first_number = (
            min(self._changes, default=self._last_sequence_number + 1)
            if self._keeps_history
            else min(reader_state.base, self._last_sequence_number + 1)
        )
        return heartbeat(
            reader[PREFIX_SIZE:], self.guid[PREFIX_SIZE:], first_number, self._last_sequence_number, self._count
        )

    def _make_packet(self, reader: bytes, reader_state: _ReaderState, *submessages: bytes) -> Packet:
        return build_message(self.guid[:PREFIX_SIZE], *submessages, to=reader[:PREFIX_SIZE]), reader_state.addresses

    def _drop_acknowledged(self) -> None:
        base = min(
            (reader_state.base for reader_state in self._readers.values()), default=self._last_sequence_number + 1
        )
        for sequence_number in [change for change in self._changes if change < base]:
            if not self._keeps_history or self._changes[sequence_number].payload is None:
                self._drop(sequence_number)

    def _drop(self, sequence_number: int) -> None:
        change = self._changes.pop(sequence_number, None)
        if change is not None:
            self._byte_count -= len(change.payload or b"")
