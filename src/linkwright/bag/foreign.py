"""Reads MCAP files that also contain data of other systems, such as recordings of Foxglove.

The library rejects the whole file if the file's profile is not ``ros2``, or if a schema is in a language that ROS 2
does not use (JSON, Protobuf, ROS 1 ...). The library therefore receives a patched file, in which these parts are
replaced by others of equal length: the profile ``ros2``, and empty schemas. `BagReader` omits topics with other
encodings, and reports them.
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
    """Return the patches that let the library read a complete file with an index.

    The result maps the offset of each patch in the file to the bytes to insert there.
    """
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
    """Return the patch that sets the profile to ``ros2``, or an empty dict if none is needed.

    The profile replaces a part of the name of the program that wrote the file.
    """
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
    """Return the patch that empties a schema in a language that ROS 2 does not use.

    The result is an empty dict for any other schema.

    Args:
        place: the offset of the record's body in the file.
        body: the body of the record.
    """
    parts = _texts(body, _ID, 3)
    if parts is None or parts[1] in _LANGUAGES:
        return {}
    name, language, text = parts
    return {place + _ID: _text(name) + _text(b"") + _text(b" " * (len(language) + len(text)))}


def known_schema(body: bytes) -> bytes:
    """Return the body of a schema record, patched if the library cannot read it otherwise."""
    return body[:_ID] + schema_patch(0, body).get(_ID, body[_ID:])


def _texts(body: bytes, place: int, count: int) -> list[bytes] | None:
    """Return `count` consecutive length-prefixed strings, or None if the body is truncated."""
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
