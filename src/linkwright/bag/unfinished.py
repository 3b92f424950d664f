"""Reads MCAP files without an end or an index.

Such files come from a recorder that was killed, from a truncated copy or from a stream. A file is a sequence of
records, each with a kind and a length (the MCAP specification), and all complete records are usable. The missing
summary, which lists the chunks, is created in memory and appended to the bytes of the file for readers. The file is
therefore not copied, and seeking is as fast as in other files. Records that do not belong to ROS 2 are replaced in the
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

from linkwright.bag.foreign import FOOTER_BODY, HEAD, MAGIC, header_patch, known_schema, patches_of, schema_patch

if TYPE_CHECKING:
    from typing_extensions import Buffer

_HEADER, _FOOTER, _SCHEMA, _CHANNEL, _MESSAGE, _CHUNK, _MESSAGE_INDEX, _CHUNK_INDEX = range(0x01, 0x09)
_STATISTICS, _DATA_END = 0x0B, 0x0F
_SUMMARY_KINDS = frozenset({_FOOTER, _CHUNK_INDEX, _STATISTICS, 0x0D, 0x0E, _DATA_END})
"""Records that only the end of a file has; a damaged end is left out and made again."""

_CHUNK_HEAD = struct.Struct("<QQQII")
"""The head of a chunk: times of first and last message, unpacked size, checksum, length of the compression's name."""
_NUMBER, _PAIR, _ENTRY, _WORD = struct.Struct("<H"), struct.Struct("<HQ"), struct.Struct("<QQ"), struct.Struct("<I")
_LONG = struct.Struct("<Q")
_MESSAGE_HEAD = struct.Struct("<HIQ")
_COUNTS = struct.Struct("<QHIIIIQQ")


def is_unfinished(path: Path) -> bool:
    """Return whether a file begins like an MCAP file but does not end like an MCAP file."""
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
    length = HEAD.size + FOOTER_BODY.size
    with path.open("rb") as file:
        if path.stat().st_size < length + 2 * len(MAGIC):
            return False
        file.seek(-length - len(MAGIC), 2)
        footer = file.read(length)
    return bool(FOOTER_BODY.unpack_from(footer, HEAD.size)[0])


def make_readable(path: Path) -> ReadableFile | None:
    """Return a view of a file that the library can read, or None if the library can read the file itself."""
    if not is_unfinished(path) and has_index(path):
        patches = patches_of(path)
        return ReadableFile(path, path.stat().st_size, b"", patches) if patches else None
    with path.open("rb") as file:
        scan = _scan(file, path.stat().st_size)
        tail = _summary_of(scan, file)
        return ReadableFile(path, scan.end, tail, header_patch(file) | scan.patches)


class ReadableFile:
    """The complete records of an MCAP file and a summary, which the library accepts in place of a path.

    Args:
        path: the file, which is not modified.
        size: the number of bytes of the file that are visible.
        tail: the bytes that follow the visible bytes.
        patches: the bytes to replace, as offset -> bytes.

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
        return cast("BinaryIO", io.BufferedReader(_Patched(self._path, self._size, self._tail, self._patches), 1 << 16))


class _Patched(io.RawIOBase):
    """A stream of the beginning of a file with some bytes replaced, followed by other bytes."""

    def __init__(self, path: Path, size: int, tail: bytes, patches: Mapping[int, bytes]) -> None:
        self._file = path.open("rb", buffering=0)
        self._size = size
        self._tail = tail
        self._patches = patches
        self._at = 0

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = 0) -> int:
        begin = (0, self._at, self._size + len(self._tail))[whence]
        self._at = max(0, begin + offset)
        return self._at

    def readinto(self, buffer: Buffer) -> int:
        into = memoryview(buffer)
        if self._at < self._size:
            self._file.seek(self._at)
            count = self._file.readinto(into[: self._size - self._at]) or 0
            for offset, patch in self._patches.items():
                begin, end = max(offset, self._at), min(offset + len(patch), self._at + count)
                if begin < end:
                    into[begin - self._at : end - self._at] = patch[begin - offset : end - offset]
        else:
            part = self._tail[self._at - self._size :][: len(into)]
            into[: len(part)] = part
            count = len(part)
        self._at += count
        return count

    def close(self) -> None:
        self._file.close()
        super().close()


@dataclass(slots=True)
class _Chunk:
    """The position of a chunk in the file, its record, and the positions of its message indexes."""

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
    has_loose_messages: bool = False

    def declare(self, kind: int, body: bytes) -> None:
        """Register a schema or channel."""
        into = self.schemas if kind == _SCHEMA else self.channels
        known = known_schema(body) if kind == _SCHEMA else body
        into.setdefault(_NUMBER.unpack_from(body)[0], _record(kind, known))


def _summary_of(scan: _Scan, file: BinaryIO) -> bytes:
    """Return the bytes that must follow the complete records of a file."""
    if scan.has_loose_messages or not scan.chunks:
        # The library reads such a file sequentially, with or without a summary.
        return _record(_DATA_END, bytes(4)) + _record(_FOOTER, bytes(FOOTER_BODY.size)) + MAGIC
    made = bytearray()
    for chunk in scan.chunks:
        if not chunk.indexes or not scan.channels.keys() >= chunk.indexes.keys():
            _scan_chunk(file, chunk, scan, made)
    return _tail(scan, bytes(made))


def _scan(file: BinaryIO, size: int) -> _Scan:
    """Scan the records of a file without reading the content of chunks."""
    scan = _Scan()
    while True:
        file.seek(scan.end)
        head = file.read(HEAD.size)
        if len(head) < HEAD.size:
            return scan
        kind, length = HEAD.unpack(head)
        if kind == 0 or kind in _SUMMARY_KINDS or scan.end + HEAD.size + length > size:
            return scan
        if kind == _CHUNK and length >= _CHUNK_HEAD.size:
            scan.chunks.append(_chunk(file, scan.end, HEAD.size + length))
        elif kind == _MESSAGE_INDEX and scan.chunks:
            channel, entries = _NUMBER.unpack(file.read(2))[0], _WORD.unpack(file.read(4))[0]
            chunk = scan.chunks[-1]
            if entries:
                chunk.indexes[channel], chunk.counts[channel] = scan.end, entries // _ENTRY.size
            chunk.indexes_end = scan.end + HEAD.size + length
        elif kind in (_SCHEMA, _CHANNEL):
            body = file.read(length)
            scan.declare(kind, body)
            if kind == _SCHEMA:
                scan.patches |= schema_patch(scan.end + HEAD.size, body)
        elif kind == _MESSAGE:
            scan.has_loose_messages = True
        scan.end += HEAD.size + length


def _chunk(file: BinaryIO, offset: int, length: int) -> _Chunk:
    start_ns, end_ns, size, _, named = _CHUNK_HEAD.unpack(file.read(_CHUNK_HEAD.size))
    compression = file.read(named)
    (compressed,) = _LONG.unpack(file.read(8))
    return _Chunk(offset, length, start_ns, end_ns, compression, compressed, size, indexes_end=offset + length)


def _scan_chunk(file: BinaryIO, chunk: _Chunk, scan: _Scan, made: bytearray) -> None:
    """Read the schemas and channels in a chunk, and create missing message indexes."""
    from rosbags.rosbag2.storage_mcap import decompress

    file.seek(chunk.offset + chunk.length - chunk.compressed_size)
    data = decompress(file.read(chunk.compressed_size), chunk.compression.decode(), chunk.size, 0)
    entries: dict[int, list[bytes]] = defaultdict(list)
    for kind, place, length in _records(data):
        body = data[place + HEAD.size : place + HEAD.size + length]
        if kind in (_SCHEMA, _CHANNEL):
            scan.declare(kind, body)
        elif kind == _MESSAGE:
            channel, _, stamp_ns = _MESSAGE_HEAD.unpack_from(body)
            entries[channel].append(_ENTRY.pack(stamp_ns, place))
    if chunk.indexes:
        return
    for channel, packed in entries.items():
        chunk.indexes[channel], chunk.counts[channel] = scan.end + len(made), len(packed)
        joined = b"".join(packed)
        made += _record(_MESSAGE_INDEX, _NUMBER.pack(channel) + _WORD.pack(len(joined)) + joined)
    chunk.indexes_end = scan.end + len(made)


def _records(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Yield the kind, the position and the content length of each record in an uncompressed chunk."""
    place = 0
    while place + HEAD.size <= len(data):
        kind, length = HEAD.unpack_from(data, place)
        yield kind, place, length
        place += HEAD.size + length


def _tail(scan: _Scan, made: bytes) -> bytes:
    """Return the missing message indexes, the end of the data section, and the summary."""
    before = made + _record(_DATA_END, bytes(4))
    chunks = [chunk for chunk in scan.chunks if chunk.indexes]
    totals: dict[int, int] = defaultdict(int)
    for channel, count in chain.from_iterable(chunk.counts.items() for chunk in chunks):
        totals[channel] += count
    counts = b"".join(_PAIR.pack(*item) for item in totals.items())
    statistics = _COUNTS.pack(
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
            *(_record(_CHUNK_INDEX, _chunk_index(chunk)) for chunk in chunks),
            _record(_STATISTICS, statistics + _WORD.pack(len(counts)) + counts),
        )
    )
    footer = _record(_FOOTER, FOOTER_BODY.pack(scan.end + len(before), 0, 0))
    return before + summary + footer + MAGIC


def _chunk_index(chunk: _Chunk) -> bytes:
    offsets = b"".join(_PAIR.pack(*item) for item in chunk.indexes.items())
    return b"".join(
        (
            struct.pack("<QQQQ", chunk.start_ns, chunk.end_ns, chunk.offset, chunk.length),
            _WORD.pack(len(offsets)),
            offsets,
            _LONG.pack(chunk.indexes_end - chunk.offset - chunk.length),
            _WORD.pack(len(chunk.compression)),
            chunk.compression,
            _LONG.pack(chunk.compressed_size),
            _LONG.pack(chunk.size),
        )
    )


def _record(kind: int, body: bytes) -> bytes:
    return HEAD.pack(kind, len(body)) + body
