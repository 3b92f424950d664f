"""Read MCAP files without an end or an index.

Such files come from a recorder that was killed, from a truncated copy, or from a stream. A file is a sequence of
records, each with a type and a length (the MCAP specification), and all complete records are usable. The missing
summary, which lists the chunks, is created in memory and appended to the bytes of the file for readers. The
file is not copied, and seeking is as fast as in other files. Records that do not belong to ROS 2 are replaced in the
same way.
"""

from __future__ import annotations

import io
import struct
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, cast

from linkwright.bag.foreign import (
    FOOTER_BODY,
    MAGIC,
    RECORD_HEAD,
    find_patches,
    make_header_patch,
    make_schema_patch,
    make_schema_readable,
)

if TYPE_CHECKING:
    from typing_extensions import Buffer

_HEADER, _FOOTER, _SCHEMA, _CHANNEL, _MESSAGE, _CHUNK, _MESSAGE_INDEX, _CHUNK_INDEX = range(0x01, 0x09)
_STATISTICS, _DATA_END = 0x0B, 0x0F
_SUMMARY_TYPES = frozenset({_FOOTER, _CHUNK_INDEX, _STATISTICS, 0x0D, 0x0E, _DATA_END})
"""The types of records that only occur at the end of a file. A damaged end is left out and created again."""

_CHUNK_HEAD = struct.Struct("<QQQII")
"""The head of a chunk: first and last time, decompressed size, checksum, length of the compression's name."""
_UINT16, _UINT16_UINT64, _ENTRY, _UINT32 = (
    struct.Struct("<H"),
    struct.Struct("<HQ"),
    struct.Struct("<QQ"),
    struct.Struct("<I"),
)
_UINT64 = struct.Struct("<Q")
_MESSAGE_HEAD = struct.Struct("<HIQ")
_STATISTICS_HEAD = struct.Struct("<QHIIIIQQ")


def is_unfinished(path: Path) -> bool:
    """Return whether a file begins like an MCAP file, but does not end like one."""
    with path.open("rb") as file:
        if file.read(len(MAGIC)) != MAGIC:
            return False
        size = path.stat().st_size
        if size < 2 * len(MAGIC):
            return True
        file.seek(-len(MAGIC), 2)
        return file.read() != MAGIC


def has_index(path: Path) -> bool:
    """Return whether a complete MCAP file has a summary."""
    length = RECORD_HEAD.size + FOOTER_BODY.size
    with path.open("rb") as file:
        if path.stat().st_size < length + 2 * len(MAGIC):
            return False
        file.seek(-length - len(MAGIC), 2)
        footer = file.read(length)
    return bool(FOOTER_BODY.unpack_from(footer, RECORD_HEAD.size)[0])


def make_readable(path: Path) -> ReadableFile | None:
    """Return a view of a file that the library can read.

    Return None if the library can read the file itself.
    """
    if not is_unfinished(path) and has_index(path):
        patches = find_patches(path)
        return ReadableFile(path, path.stat().st_size, b"", patches) if patches else None
    with path.open("rb") as file:
        scan = _scan(file, path.stat().st_size)
        tail = _make_summary(scan, file)
        return ReadableFile(path, scan.end, tail, make_header_patch(file) | scan.patches)


class ReadableFile:
    """The complete records of an MCAP file with a summary.

    The library accepts it as a path.

    Args:
        path: the file; it is not modified.
        size: the number of bytes of the file that are visible.
        tail: the bytes that follow the visible bytes.
        patches: the bytes that replace bytes of the file, by offset.

    Attributes:
        name: the name of the file.
        suffix: ``.mcap``.
    """

    def __init__(self, path: Path, size: int, tail: bytes, patches: Mapping[int, bytes]) -> None:
        self.name = path.name
        self.suffix = path.suffix
        self._path = path
        self._size, self._tail, self._patches = size, tail, patches

    def __str__(self) -> str:
        return str(self._path)

    def exists(self) -> bool:
        """Return whether the file exists."""
        return self._path.exists()

    def is_dir(self) -> bool:
        """Return False, because the object represents a file."""
        return False

    def open(self, mode: str = "rb") -> BinaryIO:
        """Open a stream of the visible bytes of the file followed by the summary."""
        assert mode == "rb"
        return cast(
            "BinaryIO", io.BufferedReader(_PatchedStream(self._path, self._size, self._tail, self._patches), 1 << 16)
        )


class _PatchedStream(io.RawIOBase):
    """A stream of the beginning of a file with some bytes replaced, followed by other bytes."""

    def __init__(self, path: Path, size: int, tail: bytes, patches: Mapping[int, bytes]) -> None:
        self._file = path.open("rb", buffering=0)
        self._size = size
        self._tail = tail
        self._patches = patches
        self._position = 0

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = 0) -> int:
        origin = (0, self._position, self._size + len(self._tail))[whence]
        self._position = max(0, origin + offset)
        return self._position

    def readinto(self, buffer: Buffer) -> int:
        view = memoryview(buffer)
        if self._position < self._size:
            self._file.seek(self._position)
            count = self._file.readinto(view[: self._size - self._position]) or 0
            for offset, patch in self._patches.items():
                start, end = max(offset, self._position), min(offset + len(patch), self._position + count)
                if start < end:
                    view[start - self._position : end - self._position] = patch[start - offset : end - offset]
        else:
            chunk = self._tail[self._position - self._size :][: len(view)]
            view[: len(chunk)] = chunk
            count = len(chunk)
        self._position += count
        return count

    def close(self) -> None:
        self._file.close()
        super().close()


@dataclass(slots=True)
class _Chunk:
    """A chunk: its position in the file, the values of its head, and its message indexes."""

    offset: int
    length: int
    start_ns: int
    end_ns: int
    compression: bytes
    compressed_size: int
    size: int
    indexes: dict[int, int] = field(default_factory=dict)
    counts: dict[int, int] = field(default_factory=dict)
    indexes_end: int = 0


@dataclass(slots=True)
class _Scan:
    """The records that were found in a file."""

    end: int = len(MAGIC)
    chunks: list[_Chunk] = field(default_factory=list)
    schemas: dict[int, bytes] = field(default_factory=dict)
    channels: dict[int, bytes] = field(default_factory=dict)
    patches: dict[int, bytes] = field(default_factory=dict)
    has_messages_outside_chunks: bool = False

    def declare(self, kind: int, content: bytes) -> None:
        """Add a schema or channel, unless its number is already in use."""
        records = self.schemas if kind == _SCHEMA else self.channels
        readable = make_schema_readable(content) if kind == _SCHEMA else content
        records.setdefault(_UINT16.unpack_from(content)[0], _pack_record(kind, readable))


def _make_summary(scan: _Scan, file: BinaryIO) -> bytes:
    """Return the bytes that must follow the complete records of a file."""
    if scan.has_messages_outside_chunks or not scan.chunks:
        # The library reads such a file sequentially, with or without a summary.
        return _pack_record(_DATA_END, bytes(4)) + _pack_record(_FOOTER, bytes(FOOTER_BODY.size)) + MAGIC
    message_indexes = bytearray()
    for chunk in scan.chunks:
        if not chunk.indexes or not scan.channels.keys() >= chunk.indexes.keys():
            _scan_chunk(file, chunk, scan, message_indexes)
    return _make_tail(scan, bytes(message_indexes))


def _scan(file: BinaryIO, size: int) -> _Scan:
    """Scan the records of a file without reading the content of chunks."""
    scan = _Scan()
    while True:
        file.seek(scan.end)
        header = file.read(RECORD_HEAD.size)
        if len(header) < RECORD_HEAD.size:
            return scan
        record_type, length = RECORD_HEAD.unpack(header)
        if record_type == 0 or record_type in _SUMMARY_TYPES or scan.end + RECORD_HEAD.size + length > size:
            return scan
        if record_type == _CHUNK and length >= _CHUNK_HEAD.size:
            scan.chunks.append(_read_chunk_head(file, scan.end, RECORD_HEAD.size + length))
        elif record_type == _MESSAGE_INDEX and scan.chunks:
            channel, entries = _UINT16.unpack(file.read(2))[0], _UINT32.unpack(file.read(4))[0]
            chunk = scan.chunks[-1]
            if entries:
                chunk.indexes[channel], chunk.counts[channel] = scan.end, entries // _ENTRY.size
            chunk.indexes_end = scan.end + RECORD_HEAD.size + length
        elif record_type in (_SCHEMA, _CHANNEL):
            content = file.read(length)
            scan.declare(record_type, content)
            if record_type == _SCHEMA:
                scan.patches |= make_schema_patch(scan.end + RECORD_HEAD.size, content)
        elif record_type == _MESSAGE:
            scan.has_messages_outside_chunks = True
        scan.end += RECORD_HEAD.size + length


def _read_chunk_head(file: BinaryIO, offset: int, length: int) -> _Chunk:
    start_ns, end_ns, size, _, name_length = _CHUNK_HEAD.unpack(file.read(_CHUNK_HEAD.size))
    compression = file.read(name_length)
    (compressed_size,) = _UINT64.unpack(file.read(8))
    return _Chunk(offset, length, start_ns, end_ns, compression, compressed_size, size, indexes_end=offset + length)


def _scan_chunk(file: BinaryIO, chunk: _Chunk, scan: _Scan, message_indexes: bytearray) -> None:
    """Read the schemas and channels in a chunk.

    The chunk's message indexes are appended if they are missing.
    """
    from rosbags.rosbag2.storage_mcap import decompress

    file.seek(chunk.offset + chunk.length - chunk.compressed_size)
    data = decompress(file.read(chunk.compressed_size), chunk.compression.decode(), chunk.size, 0)
    entries: dict[int, list[bytes]] = defaultdict(list)
    for record_type, offset, length in _read_records(data):
        content = data[offset + RECORD_HEAD.size : offset + RECORD_HEAD.size + length]
        if record_type in (_SCHEMA, _CHANNEL):
            scan.declare(record_type, content)
        elif record_type == _MESSAGE:
            channel, _, stamp_ns = _MESSAGE_HEAD.unpack_from(content)
            entries[channel].append(_ENTRY.pack(stamp_ns, offset))
    if chunk.indexes:
        return
    for channel, packed in entries.items():
        chunk.indexes[channel], chunk.counts[channel] = scan.end + len(message_indexes), len(packed)
        index = b"".join(packed)
        message_indexes += _pack_record(_MESSAGE_INDEX, _UINT16.pack(channel) + _UINT32.pack(len(index)) + index)
    chunk.indexes_end = scan.end + len(message_indexes)


def _read_records(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Yield the type, position and content length of each record in a decompressed chunk."""
    offset = 0
    while offset + RECORD_HEAD.size <= len(data):
        record_type, length = RECORD_HEAD.unpack_from(data, offset)
        yield record_type, offset, length
        offset += RECORD_HEAD.size + length


def _make_tail(scan: _Scan, message_indexes: bytes) -> bytes:
    """Return the created message indexes, the end of the data section, and the summary."""
    data_end = message_indexes + _pack_record(_DATA_END, bytes(4))
    chunks = [chunk for chunk in scan.chunks if chunk.indexes]
    totals: dict[int, int] = defaultdict(int)
    for channel, count in chain.from_iterable(chunk.counts.items() for chunk in chunks):
        totals[channel] += count
    counts = b"".join(_UINT16_UINT64.pack(*item) for item in totals.items())
    statistics = _STATISTICS_HEAD.pack(
        sum(totals.values()),
        len(scan.schemas),
        len(scan.channels),
        0,
        0,
        len(chunks),
        min((chunk.start_ns for chunk in chunks), default=0),
        max((chunk.end_ns for chunk in chunks), default=0),
    )
    summary = b"".join(
        (
            *scan.schemas.values(),
            *scan.channels.values(),
            *(_pack_record(_CHUNK_INDEX, _make_chunk_index(chunk)) for chunk in chunks),
            _pack_record(_STATISTICS, statistics + _UINT32.pack(len(counts)) + counts),
        )
    )
    footer = _pack_record(_FOOTER, FOOTER_BODY.pack(scan.end + len(data_end), 0, 0))
    return data_end + summary + footer + MAGIC


def _make_chunk_index(chunk: _Chunk) -> bytes:
    offsets = b"".join(_UINT16_UINT64.pack(*item) for item in chunk.indexes.items())
    return b"".join(
        (
            struct.pack("<QQQQ", chunk.start_ns, chunk.end_ns, chunk.offset, chunk.length),
            _UINT32.pack(len(offsets)),
            offsets,
            _UINT64.pack(chunk.indexes_end - chunk.offset - chunk.length),
            _UINT32.pack(len(chunk.compression)),
            chunk.compression,
            _UINT64.pack(chunk.compressed_size),
            _UINT64.pack(chunk.size),
        )
    )


def _pack_record(kind: int, content: bytes) -> bytes:
    return RECORD_HEAD.pack(kind, len(content)) + content
