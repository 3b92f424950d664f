"""Finds single messages of an MCAP file by its indexes, without reading the data in between.

The chunk index at the end of the file lists the chunks with messages of each channel, and the locations of their
message indexes. A message index contains the times and the offsets within the chunk (the MCAP specification). Only one
chunk is therefore decompressed per message, regardless of the length of the file.
"""

from __future__ import annotations

import struct
from bisect import bisect_right
from collections import OrderedDict
from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rosbags.rosbag2.storage_mcap import ChunkInfo, McapReader

_KEPT_BYTES = 64 << 20
"""The bytes of unpacked chunks that are cached, so that several messages of one chunk unpack it once."""

_MOST_CHUNKS = 64
"""The greatest number of chunks to read; of more only the first and the last: some repeat static transforms."""

_CHUNK_HEAD = struct.Struct("<BQQQQI")
"""The head of a chunk: kind, length, times of first and last message, unpacked size, checksum; compression follows."""
_INDEX_HEAD = struct.Struct("<BQHI")
"""The head of a channel's index in a chunk: kind, length, channel, bytes of the entries."""
_ENTRY = struct.Struct("<QQ")
"""Time and place within the chunk."""
_MESSAGE_HEAD = struct.Struct("<BQHIQQ")


class McapLookup:
    """Finds messages of an open MCAP file that has an index.

    Args:
        storage: the open file.
    """

    def __init__(self, storage: McapReader) -> None:
        self._storage = storage
        self._chunks: dict[int, _ChannelChunks] = {}
        self._unpacked: OrderedDict[int, bytes] = OrderedDict()

    def latest(self, channels: Collection[int], at_ns: int) -> tuple[int, bytes] | None:
        """Return the time and data of the last message of channels up to a time, or None."""
        best: tuple[int, ChunkInfo, int] | None = None
        for channel in channels:
            for chunk, latest_end in self._of(channel).backwards(at_ns):
                if best is not None and latest_end <= best[0]:
                    break
                entries = self._entries(chunk, channel)
                place = bisect_right(entries, (at_ns, 1 << 64)) - 1
                if place >= 0 and (best is None or entries[place][0] > best[0]):
                    best = entries[place][0], chunk, entries[place][1]
        return None if best is None else (best[0], self._message(best[1], best[2]))

    def between(self, channels: Collection[int], start_ns: int, end_ns: int) -> list[tuple[int, bytes]]:
        """Return the times and data of the messages from one time to another, both inclusive, in order."""
        found = []
        for channel in channels:
            chunks = [each for each, _ in self._of(channel).backwards(end_ns) if each.message_end_time >= start_ns]
            if len(chunks) > _MOST_CHUNKS:
                chunks = [*chunks[: _MOST_CHUNKS // 2], *chunks[-(_MOST_CHUNKS // 2) :]]
            for chunk in chunks:
                found += [
                    (stamp, chunk, offset)
                    for stamp, offset in self._entries(chunk, channel)
                    if start_ns <= stamp <= end_ns
                ]
        found.sort(key=lambda item: (item[0], item[1].chunk_start_offset, item[2]))
        return [(stamp, self._message(chunk, offset)) for stamp, chunk, offset in found]

    def counts(self, channel: int, *, exact: bool) -> Iterator[tuple[int, int, int]]:
        """Yield the start, the end and the number of messages of time intervals of a channel.

        Times are in nanoseconds.

        Args:
            channel: the number of the channel.
            exact: whether to yield an interval for each message instead of each chunk.
        """
        for chunk in self._of(channel).chunks:
            if exact:
                yield from ((stamp_ns, stamp_ns, 1) for stamp_ns, _ in self._entries(chunk, channel))
            else:
                yield chunk.message_start_time, chunk.message_end_time, chunk.channel_count.get(channel, 0)

    def _of(self, channel: int) -> _ChannelChunks:
        if channel not in self._chunks:
            with_it = [chunk for chunk in self._storage.chunks if channel in chunk.message_index_offsets]
            self._chunks[channel] = _ChannelChunks(with_it)
        return self._chunks[channel]

    def _entries(self, chunk: ChunkInfo, channel: int) -> list[tuple[int, int]]:
        """Return the times and offsets of a channel's messages in a chunk, ordered by time."""
        file: Any = self._storage.bio
        file.seek(chunk.message_index_offsets[channel])
        _, _, _, size = _INDEX_HEAD.unpack(file.read(_INDEX_HEAD.size))
        return sorted(_ENTRY.iter_unpack(file.read(size)))

    def _message(self, chunk: ChunkInfo, offset: int) -> bytes:
        data = self._data(chunk)
        length = _MESSAGE_HEAD.unpack_from(data, offset)[1]
        return data[offset + _MESSAGE_HEAD.size : offset + 9 + length]

    def _data(self, chunk: ChunkInfo) -> bytes:
        place = chunk.chunk_start_offset
        if place in self._unpacked:
            self._unpacked.move_to_end(place)
            return self._unpacked[place]
        from rosbags.rosbag2.storage_mcap import decompress

        file: Any = self._storage.bio
        file.seek(place)
        head = _CHUNK_HEAD.unpack(file.read(_CHUNK_HEAD.size))
        file.seek(4 + len(chunk.compression) + 8, 1)
        data = decompress(file.read(chunk.compressed_size), chunk.compression, chunk.uncompressed_size, head[5])
        self._unpacked[place] = data
        while len(self._unpacked) > 1 and sum(map(len, self._unpacked.values())) > _KEPT_BYTES:
            self._unpacked.popitem(last=False)
        return data


class _ChannelChunks:
    """The chunks with messages of a channel, ordered by their first messages."""

    def __init__(self, chunks: Collection[ChunkInfo]) -> None:
        self.chunks = sorted(chunks, key=lambda chunk: chunk.message_start_time)
        self._starts = [chunk.message_start_time for chunk in self.chunks]
        self._latest_ends: list[int] = []
        for chunk in self.chunks:
            self._latest_ends.append(max(chunk.message_end_time, self._latest_ends[-1] if self._latest_ends else 0))

    def backwards(self, at_ns: int) -> Iterator[tuple[ChunkInfo, int]]:
        """Yield the chunks that begin at or before a time, from the last to the first.

        Each chunk is yielded with the latest end time of this chunk and all earlier chunks.
        """
        for place in range(bisect_right(self._starts, at_ns) - 1, -1, -1):
            yield self.chunks[place], self._latest_ends[place]
