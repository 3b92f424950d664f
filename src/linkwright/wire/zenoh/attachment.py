"""The attachment of each message, request and reply, in rmw_zenoh_cpp's format.

The format is that of zenoh-ext: 33 bytes with a sequence number, the time of sending, and the gid of the sender. A
receiving rmw_zenoh_cpp terminates its process if the attachment is malformed, so each sample has one.
"""

from __future__ import annotations

from struct import Struct
from typing import NamedTuple

GID_SIZE = 16

_LAYOUT = Struct("<qqB16s")
"""Little-endian, without padding. A sequence begins with its length, in LEB128."""


class Attachment(NamedTuple):
    """The attachment of a sample.

    Attributes:
        sequence_number: the sequence number, starting at 1; a reply has the number of its request.
        sent_ns: when the sample was sent, in nanoseconds since the epoch.
        gid: the gid of the publisher or the client, 16 bytes.
    """

    sequence_number: int
    sent_ns: int
    gid: bytes


def write(sequence_number: int, sent_ns: int, gid: bytes) -> bytes:
    """Encode an attachment."""
    return _LAYOUT.pack(sequence_number, sent_ns, GID_SIZE, gid)


def read(data: bytes | None) -> Attachment | None:
    """Decode an attachment, or return None if it is missing or malformed."""
    if data is None or len(data) != _LAYOUT.size:
        return None
    sequence_number, sent_ns, size, gid = _LAYOUT.unpack(data)
    return Attachment(sequence_number, sent_ns, gid) if size == GID_SIZE else None
