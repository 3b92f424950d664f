"""Read MCAP files that also contain data of other systems, such as recordings of Foxglove.

The library rosbags rejects the whole file if its profile is not ``ros2``, or if a schema is in a language that ROS 2
does not use (JSON, Protobuf, ROS 1 ...). The library therefore receives a patched file, in which these pieces are
replaced by others of equal length: the profile ``ros2``, and empty schemas. `BagReader` omits topics with other
encodings, and reports them.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import BinaryIO

MAGIC = b"\x89MCAP0\r\n"
RECORD_HEAD = struct.Struct("<BQ")
"""The head of a record: its type, and the length of its content."""
FOOTER_BODY = struct.Struct("<QQI")

_HEADER_TYPE, _SCHEMA_TYPE = 0x01, 0x03
_PROFILE = b"ros2"
_ROS_LANGUAGES = (b"ros2msg", b"ros2idl", b"omgidl", b"")
_LENGTH, _ID_SIZE = struct.Struct("<I"), 2


def find_patches(path: Path) -> dict[int, bytes]:
    """Return the patches that let the library read a complete file with an index, by offset.

    Each offset in the file is mapped to the bytes that replace those at the offset.
    """
    with path.open("rb") as file:
        patches = make_header_patch(file)
        file.seek(-RECORD_HEAD.size - FOOTER_BODY.size - len(MAGIC), 2)
        end = file.tell()
        (offset, *_) = FOOTER_BODY.unpack_from(file.read(), RECORD_HEAD.size)
        while offset + RECORD_HEAD.size <= end:
            file.seek(offset)
            record_type, length = RECORD_HEAD.unpack(file.read(RECORD_HEAD.size))
            offset += RECORD_HEAD.size
            if record_type == _SCHEMA_TYPE:
                patches |= make_schema_patch(offset, file.read(length))
            offset += length
    return patches


def make_header_patch(file: BinaryIO) -> dict[int, bytes]:
    """Return the patch that sets the profile to ``ros2``.

    The result is empty if no patch is needed.

    The profile takes bytes from the name of the program that wrote the file.
    """
    file.seek(len(MAGIC))
    head = file.read(RECORD_HEAD.size)
    if len(head) < RECORD_HEAD.size:
        return {}
    record_type, length = RECORD_HEAD.unpack(head)
    profile_and_library = _read_strings(file.read(min(length, 1 << 16)), 0, 2)
    if record_type != _HEADER_TYPE or profile_and_library is None or profile_and_library[0] == _PROFILE:
        return {}
    library = b"".join(profile_and_library)[: -len(_PROFILE)]
    if len(library) + len(_PROFILE) != sum(map(len, profile_and_library)):
        return {}
    return {len(MAGIC) + RECORD_HEAD.size: _encode_text(_PROFILE) + _encode_text(library)}


def make_schema_patch(offset: int, content: bytes) -> dict[int, bytes]:
    """Return the patch that empties a schema if ROS 2 does not use its language.

    The result is empty for any other schema.

    The length of the schema record stays the same.

    Args:
        offset: the offset of the record's content in the file.
        content: the content of the record.
    """
    fields = _read_strings(content, _ID_SIZE, 3)
    if fields is None or fields[1] in _ROS_LANGUAGES:
        return {}
    name, language, text = fields
    return {
        offset + _ID_SIZE: _encode_text(name) + _encode_text(b"") + _encode_text(b" " * (len(language) + len(text)))
    }


def make_schema_readable(content: bytes) -> bytes:
    """Return the content of a schema record, patched if the library could not read it."""
    return content[:_ID_SIZE] + make_schema_patch(0, content).get(_ID_SIZE, content[_ID_SIZE:])


def _read_strings(content: bytes, offset: int, count: int) -> list[bytes] | None:
    """Return `count` consecutive length-prefixed strings, or None if the content is truncated."""
    strings = []
    for _ in range(count):
        if offset + _LENGTH.size > len(content):
            return None
        (length,) = _LENGTH.unpack_from(content, offset)
        offset += _LENGTH.size
        if offset + length > len(content):
            return None
        strings.append(content[offset : offset + length])
        offset += length
    return strings


def _encode_text(text: bytes) -> bytes:
    return _LENGTH.pack(len(text)) + text
