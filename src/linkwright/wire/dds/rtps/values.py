"""Identifiers, parameter lists and locators of RTPS (DDSI-RTPS 2.5, 9.3 and 9.4)."""

from __future__ import annotations

import socket
import struct

Address = tuple[str, int]
"""An IPv4 address and a port."""

PREFIX_SIZE = 12
"""The number of bytes of a GUID that identify the participant. Four more identify its entity."""

UNKNOWN_ENTITY = bytes(4)
PARTICIPANT = b"\x00\x00\x01\xc1"
SPDP_WRITER, SPDP_READER = b"\x00\x01\x00\xc2", b"\x00\x01\x00\xc7"
PUBLICATIONS_WRITER, PUBLICATIONS_READER = b"\x00\x00\x03\xc2", b"\x00\x00\x03\xc7"
SUBSCRIPTIONS_WRITER, SUBSCRIPTIONS_READER = b"\x00\x00\x04\xc2", b"\x00\x00\x04\xc7"
WRITER_KIND, READER_KIND = b"\x03", b"\x04"
"""The last byte of the entity id of a writer or reader of a type without keys."""

FAST_DDS_VENDOR = b"\x01\x0f"
OWN_VENDOR = b"\x4c\x57"
"""Linkwright's vendor id, which no other vendor uses (the OMG keeps the list)."""

VERSION = b"\x02\x03"

PID_LEASE = 0x0002
PID_TOPIC_NAME = 0x0005
PID_TYPE_NAME = 0x0007
PID_PROTOCOL_VERSION = 0x0015
PID_VENDOR = 0x0016
PID_RELIABILITY = 0x001A
PID_DURABILITY = 0x001D
PID_USER_DATA = 0x002C
PID_UNICAST_LOCATOR = 0x002F
PID_DEFAULT_UNICAST_LOCATOR = 0x0031
PID_METATRAFFIC_UNICAST_LOCATOR = 0x0032
PID_PARTICIPANT_GUID = 0x0050
PID_BUILTIN_ENDPOINTS = 0x0058
PID_ENDPOINT_GUID = 0x005A
PID_ENTITY_NAME = 0x0062
PID_KEY_HASH = 0x0070
PID_STATUS_INFO = 0x0071
PID_RELATED_SAMPLE_IDENTITY = 0x0083
PID_RELATED_SAMPLE_IDENTITY_OF_FAST_DDS = 0x800F
"""The related sample identity as Fast DDS before 2.14 writes it."""

_PID_SENTINEL = 0x0001

BUILTIN_ENDPOINTS = 0x3F
"""SPDP, and SEDP for publications and subscriptions: writers and readers of each."""

RELIABLE = struct.pack("<IiI", 2, 0, 0x1999_9999)
"""RELIABILITY: reliable, blocking 100 ms at most."""

VOLATILE = bytes(4)
NO_NUMBER = -1 << 32
"""SEQUENCENUMBER_UNKNOWN."""

_UDP_V4 = 1
_LOCATOR = struct.Struct("<iI")
_IDENTITY = struct.Struct("<iI")

Parameters = dict[int, list[bytes]]


class MalformedError(ValueError):
    """Raised when a packet does not follow the RTPS specification."""


def encode_parameter(pid: int, value: bytes) -> bytes:
    """Encode a parameter, padded to a multiple of four bytes."""
    value += bytes(-len(value) % 4)
    return struct.pack("<HH", pid, len(value)) + value


def encode_parameters(*pairs: tuple[int, bytes]) -> bytes:
    """Encode a list of parameters, including its end."""
    return b"".join(encode_parameter(*pair) for pair in pairs) + struct.pack("<HH", _PID_SENTINEL, 0)


def read_parameters(data: bytes, offset: int, order: str) -> tuple[Parameters, int]:
    """Parse the parameter list at an offset.

    Returns:
        The parameters, each with all its values, and the offset after the list.

    Raises:
        MalformedError: the list has no end marker.
    """
    values: Parameters = {}
    while offset + 4 <= len(data):
        pid, size = struct.unpack_from(order + "HH", data, offset)
        offset += 4
        if pid == _PID_SENTINEL:
            return values, offset
        if offset + size > len(data):
            break
        values.setdefault(pid, []).append(data[offset : offset + size])
        offset += size
    raise MalformedError("a parameter list without a sentinel")


def encode_text(value: str) -> bytes:
    """Encode a string as CDR."""
    encoded = value.encode() + b"\0"
    return struct.pack("<I", len(encoded)) + encoded


def encode_octets(value: bytes) -> bytes:
    """Encode a sequence of octets as CDR."""
    return struct.pack("<I", len(value)) + value


def read_text(value: bytes, order: str) -> str:
    """Decode a CDR string.

    Raises:
        MalformedError: the string is truncated.
    """
    if len(value) < 4:
        raise MalformedError("a string without a length")
    (size,) = struct.unpack_from(order + "I", value)
    if size > len(value) - 4:
        raise MalformedError("a truncated string")
    return value[4 : 4 + size].rstrip(b"\0").decode(errors="replace")


def encode_locator(address: Address) -> bytes:
    """Encode a UDPv4 locator."""
    return _LOCATOR.pack(_UDP_V4, address[1]) + bytes(12) + socket.inet_aton(address[0])


def read_locators(values: list[bytes], order: str) -> list[Address]:
    """Return the UDPv4 addresses among locators.

    Others, such as shared memory, are ignored.
    """
    addresses = []
    for value in values:
        if len(value) >= 24:
            locator_kind, port = struct.unpack_from(order + "iI", value)
            if locator_kind == _UDP_V4 and 0 < port < 0x1_0000:
                addresses.append((socket.inet_ntoa(value[20:24]), port))
    return addresses


def encode_related_identity(guid: bytes, sequence_number: int) -> bytes:
    """Return inline QoS that identifies the related sample by a GUID and a sequence number.

    The GUID belongs to the related sample's writer or reader. The inline QoS has the forms that all versions of Fast
    DDS understand.
    """
    value = guid + _IDENTITY.pack(sequence_number >> 32, sequence_number & 0xFFFF_FFFF)
    return encode_parameters((PID_RELATED_SAMPLE_IDENTITY, value), (PID_RELATED_SAMPLE_IDENTITY_OF_FAST_DDS, value))


def read_related_identity(inline: Parameters, order: str) -> tuple[bytes, int] | None:
    """Return the GUID and sequence number of the related sample in inline QoS, or None."""
    for pid in (PID_RELATED_SAMPLE_IDENTITY, PID_RELATED_SAMPLE_IDENTITY_OF_FAST_DDS):
        for value in inline.get(pid, ()):
            if len(value) >= 24:
                high, low = struct.unpack_from(order + "iI", value, 16)
                return value[:16], (high << 32) + low
    return None


def is_reader(guid: bytes) -> bool:
    """Return whether a GUID belongs to a reader (9.3.1.2)."""
    return bool(guid[15] & 0x04)
