"""Encode ``ros_discovery_info`` messages: a participant's nodes and their endpoints.

The encoding is implemented here because the layout depends on the peer: a gid has 24 bytes up to Humble and 16 from
Iron on (`rmw_dds_common/msg/Gid`), and one process may receive both.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass, field

OLD_GID_SIZE = 24
"""The size of a gid up to Humble: the 16 bytes of the GUID and eight zeros."""

GID_SIZE = 16
"""The size of a gid from Iron on: the 16 bytes of the GUID."""

_HEADER = b"\x00\x01\x00\x00"


@dataclass(frozen=True, slots=True)
class NodeEntities:
    """A node and the GUIDs of its endpoints, 16 bytes each."""

    namespace: str
    name: str
    readers: Sequence[bytes] = ()
    writers: Sequence[bytes] = ()


@dataclass(frozen=True, slots=True)
class ParticipantEntities:
    """A participant's announcement of its nodes and their endpoints."""

    participant: bytes
    nodes: Sequence[NodeEntities] = field(default=())


def encode(info: ParticipantEntities, gid_size: int) -> bytes:
    """Encode an announcement as CDR with its header.

    Args:
        info: the announcement.
        gid_size: the size of each gid, in bytes.
    """
    buffer = bytearray(info.participant.ljust(gid_size, b"\0"))
    padding = bytes(gid_size - GID_SIZE)
    _write_count(buffer, len(info.nodes))
    for node in info.nodes:
        _write_string(buffer, node.namespace)
        _write_string(buffer, node.name)
        for gids in (node.readers, node.writers):
            _write_count(buffer, len(gids))
            for gid in gids:
                buffer += gid + padding
    buffer += bytes(-len(buffer) % 4)
    return _HEADER + bytes(buffer)


def decode(data: bytes) -> ParticipantEntities | None:
    """Decode an announcement of either gid size, or return None if it has neither.

    A size is correct if decoding ends at the end of the data, apart from padding. The older size is tried first.
    """
    for gid_size in (OLD_GID_SIZE, GID_SIZE):
        try:
            reader = _Reader(data, gid_size)
            info = reader.participant()
        except (struct.error, IndexError, UnicodeDecodeError):
            continue
        if reader.is_at_end():
            return info
    return None


def _write_count(buffer: bytearray, count: int) -> None:
    buffer += bytes(-len(buffer) % 4) + struct.pack("<I", count)


def _write_string(buffer: bytearray, text: str) -> None:
    encoded = text.encode() + b"\0"
    _write_count(buffer, len(encoded))
    buffer += encoded


class _Reader:
    def __init__(self, data: bytes, gid_size: int) -> None:
        self._data = data[4:]
        self._order = "<" if data[1] & 1 else ">"
        self._gid_size = gid_size
        self._offset = 0

    def participant(self) -> ParticipantEntities:
        gid = self._read_gid()
        return ParticipantEntities(gid, [self._read_node() for _ in range(self._read_count())])

    def is_at_end(self) -> bool:
        return 0 <= len(self._data) - self._offset < 4

    def _read_node(self) -> NodeEntities:
        return NodeEntities(self._read_string(), self._read_string(), self._read_gids(), self._read_gids())

    def _read_gids(self) -> list[bytes]:
        return [self._read_gid() for _ in range(self._read_count())]

    def _read_gid(self) -> bytes:
        gid = self._read_bytes(self._gid_size)
        if any(gid[GID_SIZE:]):
            raise IndexError("the bytes after a GUID must be zeros")
        return gid[:GID_SIZE]

    def _read_string(self) -> str:
        return self._read_bytes(self._read_count(limit=1))[:-1].decode()

    def _read_count(self, limit: int = 4) -> int:
        """Read the length of a sequence.

        Raise an error if the remaining bytes are too few for that many items.
        """
        self._offset += -self._offset % 4
        (count,) = struct.unpack_from(self._order + "I", self._data, self._offset)
        self._offset += 4
        if count * limit > len(self._data) - self._offset:
            raise IndexError("a sequence is longer than the sample")
        return int(count)

    def _read_bytes(self, size: int) -> bytes:
        end = self._offset + size
        if end > len(self._data):
            raise IndexError("a sequence is longer than the sample")
        value = self._data[self._offset : end]
        self._offset = end
        return value
