"""Read MCAP files that contain more than ROS 2 data, such as those of Foxglove and users' own programs.

The library refuses the whole file if its profile is not ``ros2``, or if a schema is in a language other than those of
ROS 2 (JSON, Protobuf, ROS 1 ...). Therefore the library reads substitutes of equal length instead: the profile
``ros2``, and empty schemas. `BagReader` leaves out topics with other encodings, and reports them.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import BinaryIO

MAGIC = b"\x89MCAP0\r\n"
HEAD = struct.Struct("<BQ")
"""The head of a record: its kind, and the length of its content."""
FOOTER_BODY = struct.Struct("<QQI")

_HEADER, _SCHEMA = 0x01, 0x03
_PROFILE = b"ros2"
_LANGUAGES = (b"ros2msg", b"ros2idl", b"omgidl", b"")
_LENGTH, _ID = struct.Struct("<I"), 2


def patches_of(path: Path) -> dict[int, bytes]:
    """Return the patches, offset -> bytes, that let the library read a finished file with an index."""
    with path.open("rb") as file:
        patches = header_patch(file)
        file.seek(-HEAD.size - FOOTER_BODY.size - len(MAGIC), 2)
        end = file.tell()
        (place, *_) = FOOTER_BODY.unpack_from(file.read(), HEAD.size)
        while place + HEAD.size <= end:
            file.seek(place)
            kind, length = HEAD.unpack(file.read(HEAD.size))
            place += HEAD.size
            if kind == _SCHEMA:
                patches |= schema_patch(place, file.read(length))
            place += length
    return patches


def header_patch(file: BinaryIO) -> dict[int, bytes]:
    """Return the patch that sets the profile to ``ros2``, using the space of the name of the writing program."""
    file.seek(len(MAGIC))
    head = file.read(HEAD.size)
    if len(head) < HEAD.size:
        return {}
    kind, length = HEAD.unpack(head)
    parts = _texts(file.read(min(length, 1 << 16)), 0, 2)
    if kind != _HEADER or parts is None or parts[0] == _PROFILE:
        return {}
    rest = b"".join(parts)[: -len(_PROFILE)]
    if len(rest) + len(_PROFILE) != sum(map(len, parts)):
        return {}
    return {len(MAGIC) + HEAD.size: _text(_PROFILE) + _text(rest)}


def schema_patch(place: int, body: bytes) -> dict[int, bytes]:
    """Return the patch that removes the text of a schema that is not in a language of ROS 2.

    Args:
        place: the offset of the body of its record in the file.
        body: the body of its record.
    """
    parts = _texts(body, _ID, 3)
    if parts is None or parts[1] in _LANGUAGES:
        return {}
    name, language, text = parts
    return {place + _ID: _text(name) + _text(b"") + _text(b" " * (len(language) + len(text)))}


def known_schema(body: bytes) -> bytes:
    """Return the body of a schema's record in a form that the library can read."""
    return body[:_ID] + schema_patch(0, body).get(_ID, body[_ID:])


def _texts(body: bytes, place: int, count: int) -> list[bytes] | None:
    """Return consecutive length-prefixed strings; None if they are truncated."""
    found = []
    for _ in range(count):
        if place + _LENGTH.size > len(body):
            return None
        (length,) = _LENGTH.unpack_from(body, place)
        place += _LENGTH.size
        if place + length > len(body):
            return None
        found.append(body[place : place + length])
        place += length
    return found


def _text(text: bytes) -> bytes:
    return _LENGTH.pack(len(text)) + text
