"""RTPS writers, which ensure that every reader receives every sample (DDSI-RTPS 2.5, 8.4.9)."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from linkwright.wire.dds.rtps.messages import (
    FRAGMENT,
    AckNack,
    NackFrag,
    data,
    data_fragment,
    fragment_count,
    gap,
    heartbeat,
    info_timestamp,
    message,
)
from linkwright.wire.dds.rtps.values import PREFIX, Address

_FIRST_REPEAT, _LAST_REPEAT = 0.1, 2.0
"""Seconds after which a reader that has not acknowledged is reminded, and to which that grows."""

_MOST = 1000
_MOST_BYTES = 64 << 20
"""How many samples wait for acknowledgement at most, and how many bytes of them; then the oldest is forgotten."""

Packet = tuple[bytes, tuple[Address, ...]]
"""A message and its addresses."""


@dataclass(frozen=True, slots=True)
class _Change:
    payload: bytes | None
    inline: bytes
    to: bytes
    time: int

    def is_for(self, reader: bytes) -> bool:
        return reader.startswith(self.to)


@dataclass(slots=True)
class _Reader:
    addresses: tuple[Address, ...]
    base: int
    """Everything before it was acknowledged, or is not for this reader."""
    due: float = 0.0
    repeat: float = _FIRST_REPEAT
    heard: bool = False


class Writer:
    """An RTPS writer.

    Args:
        guid: the writer's GUID, 16 bytes.
        lasting: whether late-joining readers receive earlier samples.
    """

    def __init__(self, guid: bytes, *, lasting: bool = False) -> None:
        self.guid = guid
        self._lasting = lasting
        self._changes: dict[int, _Change] = {}
        self._bytes = 0
        self._last = 0
        self._count = 0
        self._readers: dict[bytes, _Reader] = {}

    @property
    def readers(self) -> Iterable[bytes]:
        """The GUIDs of the matched readers."""
        return self._readers.keys()

    def has_heard(self, reader: bytes) -> bool:
        """Return whether a reader has answered, which shows that the reader has matched this writer."""
        matched = self._readers.get(reader)
        return matched is not None and matched.heard

    def match(self, reader: bytes, addresses: tuple[Address, ...]) -> list[Packet]:
        """Match a reader, and return the first packets for it.

        If the writer is `lasting`, these are the samples of its history, otherwise a heartbeat.
        """
        if reader in self._readers:
            self._readers[reader].addresses = addresses
            return []
        matched = self._readers[reader] = _Reader(addresses, 1 if self._lasting else self._last + 1)
        if not self._lasting:
            return [self._packet(reader, matched, self._beat(reader, matched))]
        return self._history_packets(reader, matched)

    def unmatch(self, reader: bytes) -> None:
        """Remove a reader, to which nothing more is written."""
        self._readers.pop(reader, None)
        self._forget_acknowledged()

    def write(self, payload: bytes | None, *, inline: bytes = b"", to: bytes = b"") -> list[Packet]:
        """Write a new sample.

        Args:
            payload: the serialized payload; None to announce the end of the entity whose key is in `inline`.
            inline: the inline QoS.
            to: the GUID prefix of the readers that the sample is for; empty for all. Other readers receive a GAP.

        Returns:
            The packets to send.
        """
        self._last += 1
        number = self._last
        self._changes[number] = _Change(payload, inline, to, time.time_ns())
        self._bytes += len(payload or b"")
        while len(self._changes) > 1 and (len(self._changes) > _MOST or self._bytes > _MOST_BYTES):
            self._drop(min(self._changes))
        packets: list[Packet] = []
        for reader, matched in self._readers.items():
            matched.due, matched.repeat = time.monotonic() + _FIRST_REPEAT, _FIRST_REPEAT
            packets += self._sample(reader, matched, number)
        return packets

    def withdraw(self, number: int) -> None:
        """Remove a sample from the history for late-joining readers."""
        self._drop(number)

    @property
    def last(self) -> int:
        """The sequence number of the newest sample."""
        return self._last

    def on_acknack(self, acknack: AckNack) -> list[Packet]:
        """Handle an ACKNACK; return the packets that resend the missing samples."""
        matched = self._readers.get(acknack.reader)
        if matched is None:
            return []
        matched.heard = True
        if acknack.base > matched.base:
            matched.base = min(acknack.base, self._last + 1)
            matched.repeat = _FIRST_REPEAT
            matched.due = time.monotonic() + matched.repeat
            self._forget_acknowledged()
        packets = [packet for number in acknack.missing for packet in self._again(acknack.reader, matched, number)]
        if packets or (not acknack.final and not acknack.missing):
            packets.append(self._packet(acknack.reader, matched, self._beat(acknack.reader, matched)))
        return packets

    def on_nack_frag(self, nack: NackFrag) -> list[Packet]:
        """Handle a NACK_FRAG; return the packets that resend the missing fragments."""
        matched, change = self._readers.get(nack.reader), self._changes.get(nack.number)
        if matched is None or change is None or change.payload is None or not change.is_for(nack.reader):
            return []
        most = fragment_count(change.payload)
        fragments = [fragment for fragment in nack.missing if 1 <= fragment <= most]
        packets = [
            self._fragment(nack.reader, matched, nack.number, change, change.payload, fragment)
            for fragment in fragments
        ]
        return [*packets, self._packet(nack.reader, matched, self._beat(nack.reader, matched))]

    def remind(self, now: float) -> list[Packet]:
        """Return heartbeats for the readers that have not acknowledged all samples, if they are due."""
        packets = []
        for reader, matched in self._readers.items():
            if matched.base <= self._last and now >= matched.due:
                matched.due = now + matched.repeat
                matched.repeat = min(matched.repeat * 2, _LAST_REPEAT)
                packets.append(self._packet(reader, matched, self._beat(reader, matched)))
        return packets

    def next_reminder(self) -> float | None:
        """Return when to call `remind` next, in seconds of the steady clock.

        Returns None if everything has been acknowledged.
        """
        return min((matched.due for matched in self._readers.values() if matched.base <= self._last), default=None)

    # --- inside ------------------------------------------------------------------------------------------------------

    def _history_packets(self, reader: bytes, matched: _Reader) -> list[Packet]:
        matched.due = time.monotonic() + _FIRST_REPEAT
        packets = [packet for number in sorted(self._changes) for packet in self._sample(reader, matched, number)]
        return packets or [self._packet(reader, matched, self._beat(reader, matched))]

    def _sample(self, reader: bytes, matched: _Reader, number: int) -> Iterator[Packet]:
        change = self._changes[number]
        beat = self._beat(reader, matched)
        entity = reader[PREFIX:]
        if not change.is_for(reader):
            yield self._packet(reader, matched, gap(entity, self.guid[PREFIX:], number, number + 1), beat)
        elif change.payload is not None and len(change.payload) > FRAGMENT:
            for which in range(1, fragment_count(change.payload) + 1):
                yield self._fragment(reader, matched, number, change, change.payload, which)
            yield self._packet(reader, matched, beat)
        else:
            sample = data(entity, self.guid[PREFIX:], number, change.payload, change.inline)
            yield self._packet(reader, matched, info_timestamp(change.time), sample, beat)

    def _again(self, reader: bytes, matched: _Reader, number: int) -> Iterator[Packet]:
        if number in self._changes:
            yield from self._sample(reader, matched, number)
        elif number <= self._last:
            yield self._packet(reader, matched, gap(reader[PREFIX:], self.guid[PREFIX:], number, number + 1))

    def _fragment(
        self, reader: bytes, matched: _Reader, number: int, change: _Change, payload: bytes, which: int
    ) -> Packet:
        part = data_fragment(reader[PREFIX:], self.guid[PREFIX:], number, payload, which, change.inline)
        return self._packet(reader, matched, info_timestamp(change.time), part)

    def _beat(self, reader: bytes, matched: _Reader) -> bytes:
        self._count += 1
        first = min(self._changes, default=self._last + 1) if self._lasting else min(matched.base, self._last + 1)
        return heartbeat(reader[PREFIX:], self.guid[PREFIX:], first, self._last, self._count)

    def _packet(self, reader: bytes, matched: _Reader, *submessages: bytes) -> Packet:
        return message(self.guid[:PREFIX], *submessages, to=reader[:PREFIX]), matched.addresses

    def _forget_acknowledged(self) -> None:
        base = min((matched.base for matched in self._readers.values()), default=self._last + 1)
        for number in [change for change in self._changes if change < base]:
            if not self._lasting or self._changes[number].payload is None:
                self._drop(number)

    def _drop(self, number: int) -> None:
        change = self._changes.pop(number, None)
        if change is not None:
            self._bytes -= len(change.payload or b"")
