"""Parse incoming RTPS messages and build outgoing ones (DDSI-RTPS 2.5, 9.4).

Only the submessages that Linkwright uses are supported.
"""

from __future__ import annotations

import struct
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.wire.dds.rtps.values import (
    OWN_VENDOR,
    PREFIX_SIZE,
    UNKNOWN_ENTITY,
    VERSION,
    MalformedError,
    Parameters,
    read_parameters,
)

_HEADER_SIZE = 20
_LITTLE, _FINAL = 0x01, 0x02
_ACKNACK, _HEARTBEAT, _GAP, _INFO_TS, _INFO_SRC, _INFO_DST = 0x06, 0x07, 0x08, 0x09, 0x0C, 0x0E
_NACK_FRAG, _DATA, _DATA_FRAG = 0x12, 0x15, 0x16
_HAS_INLINE_QOS = 0x02
_HAS_DATA = 0x04
_MAX_MISSING = 256
FRAGMENT_SIZE = 60_000
"""The maximum number of bytes of a sample in one datagram, which holds 65 507 bytes."""


@dataclass(frozen=True, slots=True)
class Data:
    """A sample, or a fragment of one.

    Attributes:
        source: the GUID prefix of the sender's participant.
        reader: the entity that the sample is for; `UNKNOWN_ENTITY` for all matching readers.
        writer: the GUID of the writer.
        sequence_number: the sequence number.
        order: the byte order of `inline`, ``<`` or ``>``.
        inline: the inline QoS.
        payload: the serialized payload; None if there is only a key.
        time: when the sample was written, in ns since the epoch; 0 if that is not known.
        first: for fragments, the number of the first one, from 1; 0 for a whole sample.
        fragment: for fragments, the size of each, in bytes.
        size: for fragments, the size of the sample, in bytes.
    """

    source: bytes
    reader: bytes
    writer: bytes
    sequence_number: int
    order: str
    inline: Parameters
    payload: bytes | None
    time: int = 0
    first: int = 0
    fragment: int = 0
    size: int = 0


@dataclass(frozen=True, slots=True)
class Heartbeat:
    """HEARTBEAT: a writer has the samples from `first` to `last`, both inclusive.

    If the writer has no samples, `first` is `last` plus one.
    """

    source: bytes
    reader: bytes
    writer: bytes
    first: int
    last: int
    final: bool


@dataclass(frozen=True, slots=True)
class Gap:
    """GAP: some samples are not for a reader, or are no longer available.

    These are the samples from `start` to before `base`, and the samples in `other_numbers`.
    """

    source: bytes
    reader: bytes
    writer: bytes
    start: int
    base: int
    other_numbers: Collection[int]


@dataclass(frozen=True, slots=True)
class AckNack:
    """ACKNACK: a reader has all samples before `base`, except the samples in `missing`."""

    source: bytes
    reader: bytes
    writer: bytes
    base: int
    missing: Collection[int]
    final: bool


@dataclass(frozen=True, slots=True)
class NackFrag:
    """NACK_FRAG: the fragments of a sample that a reader lacks."""

    source: bytes
    reader: bytes
    writer: bytes
    sequence_number: int
    missing: Collection[int]


Submessage = Data | Heartbeat | Gap | AckNack | NackFrag


@dataclass(slots=True)
class _Context:
    source: bytes
    is_for_us: bool = True
    time: int = 0
    own_prefix: bytes = field(default=b"")


def read_vendor(packet: bytes) -> bytes:
    """Return the vendor id of a message's sender.

    Return empty bytes if the packet is not an RTPS message.
    """
    return packet[6:8] if packet[:4] == b"RTPS" and len(packet) >= _HEADER_SIZE else b""


def parse(packet: bytes, own_prefix: bytes) -> Iterator[Submessage]:
    """Yield the submessages for a participant, up to the first malformed one."""
    if not read_vendor(packet):
        return
    context = _Context(packet[8:_HEADER_SIZE], own_prefix=own_prefix)
    offset = _HEADER_SIZE
    while offset + 4 <= len(packet):
        kind, flags = packet[offset], packet[offset + 1]
        order = "<" if flags & _LITTLE else ">"
        (size,) = struct.unpack_from(order + "H", packet, offset + 2)
        start = offset + 4
        end = start + size if size or kind == _INFO_TS else len(packet)
        try:
            submessage = _read_submessage(kind, flags, order, packet[start:end], context)
        except (struct.error, MalformedError):
            return
        if submessage is not None and context.is_for_us:
            yield submessage
        offset = end


def _read_submessage(kind: int, flags: int, order: str, body: bytes, context: _Context) -> Submessage | None:
    if kind == _INFO_DST:
        context.is_for_us = body[:PREFIX_SIZE] in (context.own_prefix, bytes(PREFIX_SIZE))
    elif kind == _INFO_SRC:
        context.source = body[8 : 8 + PREFIX_SIZE]
    elif kind == _INFO_TS:
        context.time = 0 if flags & _FINAL else _read_time(body, order)
    elif kind in (_DATA, _DATA_FRAG):
        return _read_data(kind, flags, order, body, context)
    elif kind == _HEARTBEAT:
        first, last = _read_sequence_number(body, 8, order), _read_sequence_number(body, 16, order)
        return Heartbeat(context.source, body[:4], context.source + body[4:8], first, last, bool(flags & _FINAL))
    elif kind == _GAP:
        base, other_numbers = _read_number_set(body, 16, order)
        return Gap(
            context.source,
            body[:4],
            context.source + body[4:8],
            _read_sequence_number(body, 8, order),
            base,
            other_numbers,
        )
    elif kind == _ACKNACK:
        base, missing = _read_number_set(body, 8, order)
        return AckNack(context.source, context.source + body[:4], body[4:8], base, missing, bool(flags & _FINAL))
    elif kind == _NACK_FRAG:
        base, count = struct.unpack_from(order + "II", body, 16)
        missing = _read_bits(body, 24, base, count, order)
        return NackFrag(
            context.source, context.source + body[:4], body[4:8], _read_sequence_number(body, 8, order), missing
        )
    return None


def _read_data(kind: int, flags: int, order: str, body: bytes, context: _Context) -> Data:
    (inline_offset,) = struct.unpack_from(order + "H", body, 2)
    offset = 4 + inline_offset
    first = fragment = size = 0
    has_data = bool(flags & _HAS_DATA)
    if kind == _DATA_FRAG:
        first, _, fragment, size = struct.unpack_from(order + "IHHI", body, 20)
        has_data = True
        if not first or not fragment:
            raise MalformedError("a fragment without a sequence number or a fragment number")
    inline: Parameters = {}
    if flags & _HAS_INLINE_QOS:
        inline, offset = read_parameters(body, offset, order)
    payload = body[offset:] if has_data else None
    writer, sequence_number = context.source + body[8:12], _read_sequence_number(body, 12, order)
    return Data(
        context.source, body[4:8], writer, sequence_number, order, inline, payload, context.time, first, fragment, size
    )


def _read_time(body: bytes, order: str) -> int:
    seconds, fraction = struct.unpack_from(order + "II", body)
    return int(seconds) * NANOSECONDS_PER_SECOND + (int(fraction) * NANOSECONDS_PER_SECOND >> 32)


def _read_sequence_number(body: bytes, offset: int, order: str) -> int:
    high, low = struct.unpack_from(order + "iI", body, offset)
    return (int(high) << 32) + int(low)


def _read_number_set(body: bytes, offset: int, order: str) -> tuple[int, list[int]]:
    base = _read_sequence_number(body, offset, order)
    (count,) = struct.unpack_from(order + "I", body, offset + 8)
    return base, _read_bits(body, offset + 12, base, count, order)


def _read_bits(body: bytes, offset: int, base: int, count: int, order: str) -> list[int]:
    if count > _MAX_MISSING:
        raise MalformedError("a set with more than 256 numbers")
    words = struct.unpack_from(f"{order}{(count + 31) // 32}I", body, offset)
    return [base + bit for bit in range(count) if words[bit // 32] >> (31 - bit % 32) & 1]


# --- building messages -----------------------------------------------------------------------------------------------


def build_message(prefix: bytes, *submessages: bytes, to: bytes = b"") -> bytes:
    """Return an RTPS message from a participant to another, whose prefix is `to`, or to all."""
    destination = _build_submessage(_INFO_DST, 0, to) if to else b""
    return b"RTPS" + VERSION + OWN_VENDOR + prefix + destination + b"".join(submessages)


def build_info_timestamp(nanoseconds: int) -> bytes:
    """Return an INFO_TS submessage with the time of the following submessages.

    The time is in nanoseconds since the epoch.
    """
    seconds, remainder = divmod(nanoseconds, NANOSECONDS_PER_SECOND)
    return _build_submessage(_INFO_TS, 0, struct.pack("<II", seconds, (remainder << 32) // NANOSECONDS_PER_SECOND))


def data(reader: bytes, writer: bytes, sequence_number: int, payload: bytes | None, inline: bytes = b"") -> bytes:
    """Return a DATA submessage. Without a payload, it contains only the key in `inline`."""
    flags = (_HAS_INLINE_QOS if inline else 0) | (0 if payload is None else _HAS_DATA)
    head = struct.pack("<HH", 0, 16) + reader + writer + _pack_sequence_number(sequence_number)
    return _build_submessage(_DATA, flags, head + inline + (payload or b""))


def count_fragments(payload: bytes) -> int:
    """Return the number of fragments of a payload."""
    return (len(payload) + FRAGMENT_SIZE - 1) // FRAGMENT_SIZE


def build_data_fragment(
    reader: bytes, writer: bytes, sequence_number: int, payload: bytes, fragment_number: int, inline: bytes = b""
) -> bytes:
    """Return a DATA_FRAG submessage with one fragment of a payload.

    Fragments are counted from 1.
    """
    head = _build_fragment_head(reader, writer, sequence_number, len(payload), fragment_number)
    fragment = payload[(fragment_number - 1) * FRAGMENT_SIZE : fragment_number * FRAGMENT_SIZE]
    return _build_submessage(_DATA_FRAG, _HAS_INLINE_QOS if inline else 0, head + inline + fragment)


def build_fragment_start(
    reader: bytes, writer: bytes, sequence_number: int, size: int, fragment_number: int, length: int
) -> bytes:
    """Return the beginning of a DATA_FRAG submessage.

    The caller appends the bytes of the fragment.

    Args:
        reader: the entity that the fragment is for.
        writer: the entity that wrote the payload.
        sequence_number: the sequence number.
        size: the size of the payload in bytes.
        fragment_number: the number of the fragment, counted from 1.
        length: the length of the fragment in bytes, a multiple of four.
    """
    head = _build_fragment_head(reader, writer, sequence_number, size, fragment_number)
    return struct.pack("<BBH", _DATA_FRAG, _LITTLE, len(head) + length) + head


def _build_fragment_head(reader: bytes, writer: bytes, sequence_number: int, size: int, fragment_number: int) -> bytes:
    head = struct.pack("<HH", 0, 28) + reader + writer + _pack_sequence_number(sequence_number)
    return head + struct.pack("<IHHI", fragment_number, 1, FRAGMENT_SIZE, size)


def heartbeat(reader: bytes, writer: bytes, first: int, last: int, count: int, *, final: bool = False) -> bytes:
    """Return a HEARTBEAT submessage that announces the samples that a writer has.

    Args:
        reader: the entity ID of the reader; `ALL` for all readers.
        writer: the entity ID of the writer.
        first: the sequence number of the first sample.
        last: the sequence number of the last sample.
        count: the number of this heartbeat, which increases.
        final: whether the reader need not respond.
    """
    body = reader + writer + _pack_sequence_number(first) + _pack_sequence_number(last) + struct.pack("<I", count)
    return _build_submessage(_HEARTBEAT, _FINAL if final else 0, body)


def gap(reader: bytes, writer: bytes, start: int, base: int) -> bytes:
    """Return a GAP submessage: the samples from `start` to before `base` do not exist."""
    return _build_submessage(
        _GAP, 0, reader + writer + _pack_sequence_number(start) + _pack_sequence_number(base) + struct.pack("<I", 0)
    )


def acknack(
    reader: bytes, writer: bytes, base: int, missing: Collection[int], count: int, *, final: bool = True
) -> bytes:
    """Return an ACKNACK submessage of a reader that lacks the samples in `missing`.

    All samples before `base` have arrived. At most the first 256 sequence numbers from `base` can be listed as missing.
    """
    size = max(missing) - base + 1 if missing else 0
    words = [0] * ((size + 31) // 32)
    for sequence_number in missing:
        words[(sequence_number - base) // 32] |= 1 << (31 - (sequence_number - base) % 32)
    body = reader + writer + _pack_sequence_number(base) + struct.pack(f"<I{len(words)}II", size, *words, count)
    return _build_submessage(_ACKNACK, _FINAL if final else 0, body)


def _pack_sequence_number(sequence_number: int) -> bytes:
    return struct.pack("<iI", sequence_number >> 32, sequence_number & 0xFFFF_FFFF)


def _build_submessage(kind: int, flags: int, body: bytes) -> bytes:
    body += bytes(-len(body) % 4)
    return struct.pack("<BBH", kind, flags | _LITTLE, len(body) if len(body) < 0x1_0000 else 0) + body


ALL = UNKNOWN_ENTITY
"""The entity id that means all readers."""
