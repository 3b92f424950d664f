"""Find single messages of an MCAP file by its indexes, without reading other data.

The chunk index at the end of the file lists the chunks with messages of each channel, and the locations of their
message indexes. A message index contains times, and offsets in the chunk (the MCAP specification). So only one
chunk is decompressed per message, whatever the length of the file.
"""

from __future__ import annotations

import struct
from bisect import bisect_right
from collections import OrderedDict
from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rosbags.rosbag2.storage_mcap import ChunkInfo, McapReader

_MAX_CACHED_BYTES = 64 << 20
"""The maximum number of bytes of decompressed chunks in the cache, for several messages of one chunk."""

_MAX_CHUNKS = 64
"""The maximum number of chunks to read.

Of a longer list, half of them are read from its beginning and half from its end. Some recordings repeat static
transforms in every chunk.
"""

_CHUNK_HEAD = struct.Struct("<BQQQQI")
"""The head of a chunk: type, length, first and last time, decompressed size, checksum; then the compression's name."""
_INDEX_HEAD = struct.Struct("<BQHI")
"""The head of a channel's index in a chunk: record type, length, channel, number of bytes of the entries."""
_ENTRY = struct.Struct("<QQ")
"""The time of a message, and its offset in the chunk."""
_MESSAGE_HEAD = struct.Struct("<BQHIQQ")


class McapLookup:
    """A lookup of messages in an open MCAP file that has an index.

    Args:
        storage: the open file.
    """

    def __init__(self, storage: McapReader) -> None:
        self._storage = storage
        self._chunks_by_channel: dict[int, _ChannelChunks] = {}
        self._cached_chunks: OrderedDict[int, bytes] = OrderedDict()

    def latest(self, channels: Collection[int], at_ns: int) -> tuple[int, bytes] | None:
        """Return the time and the data of the last message of some channels up to a time.

        The time is in nanoseconds. Returns None if there is no message.
        """
        best: tuple[int, ChunkInfo, int] | None = None
        for channel in channels:
            for chunk, latest_end in self._get_channel_chunks(channel).iterate_backwards(at_ns):
                if best is not None and latest_end <= best[0]:
                    break
                entries = self._read_entries(chunk, channel)
                index = bisect_right(entries, (at_ns, 1 << 64)) - 1
                if index >= 0 and (best is None or entries[index][0] > best[0]):
                    best = entries[index][0], chunk, entries[index][1]
        return None if best is None else (best[0], self._read_message(best[1], best[2]))

    def between(self, channels: Collection[int], start_ns: int, end_ns: int) -> list[tuple[int, bytes]]:
        """Return the times and the data of the messages from one time to another.

        The messages are ordered by time, and the times are in nanoseconds.

        Both limits are inclusive.
        """
        locations = []
        for channel in channels:
            chunks = [
                chunk
                for chunk, _ in self._get_channel_chunks(channel).iterate_backwards(end_ns)
                if chunk.message_end_time >= start_ns
            ]
            if len(chunks) > _MAX_CHUNKS:
                chunks = [*chunks[: _MAX_CHUNKS // 2], *chunks[-(_MAX_CHUNKS // 2) :]]
            for chunk in chunks:
                locations += [
                    (stamp, chunk, offset)
                    for stamp, offset in self._read_entries(chunk, channel)
                    if start_ns <= stamp <= end_ns
                ]
        locations.sort(key=lambda item: (item[0], item[1].chunk_start_offset, item[2]))
        return [(stamp, self._read_message(chunk, offset)) for stamp, chunk, offset in locations]

    def counts(self, channel: int, *, exact: bool) -> Iterator[tuple[int, int, int]]:
        """Yield the start time, end time and message count of intervals of a channel.

        Times are in nanoseconds since the epoch. Each interval spans a chunk or a single message.

        Args:
            channel: the number of the channel.
            exact: whether to yield an interval for each message instead of each chunk.
        """
        for chunk in self._get_channel_chunks(channel).chunks:
            if exact:
                yield from ((stamp_ns, stamp_ns, 1) for stamp_ns, _ in self._read_entries(chunk, channel))
            else:
                yield chunk.message_start_time, chunk.message_end_time, chunk.channel_count.get(channel, 0)

    def _get_channel_chunks(self, channel: int) -> _ChannelChunks:
        if channel not in self._chunks_by_channel:
            chunks_of_channel = [chunk for chunk in self._storage.chunks if channel in chunk.message_index_offsets]
            self._chunks_by_channel[channel] = _ChannelChunks(chunks_of_channel)
        return self._chunks_by_channel[channel]

    def _read_entries(self, chunk: ChunkInfo, channel: int) -> list[tuple[int, int]]:
        """Return the times and offsets of a channel's messages in a chunk, in order of time."""
        file: Any = self._storage.bio
        file.seek(chunk.message_index_offsets[channel])
        _, _, _, size = _INDEX_HEAD.unpack(file.read(_INDEX_HEAD.size))
        return sorted(_ENTRY.iter_unpack(file.read(size)))

    def _read_message(self, chunk: ChunkInfo, offset: int) -> bytes:
        data = self._read_chunk(chunk)
        length = _MESSAGE_HEAD.unpack_from(data, offset)[1]
        return data[offset + _MESSAGE_HEAD.size : offset + 9 + length]

    def _read_chunk(self, chunk: ChunkInfo) -> bytes:
        offset = chunk.chunk_start_offset
        if offset in self._cached_chunks:
            self._cached_chunks.move_to_end(offset)
            return self._cached_chunks[offset]
        from rosbags.rosbag2.storage_mcap import decompress

        file: Any = self._storage.bio
        file.seek(offset)
        header = _CHUNK_HEAD.unpack(file.read(_CHUNK_HEAD.size))
        file.seek(4 + len(chunk.compression) + 8, 1)
        data = decompress(file.read(chunk.compressed_size), chunk.compression, chunk.uncompressed_size, header[5])
        self._cached_chunks[offset] = data
        while len(self._cached_chunks) > 1 and sum(map(len, self._cached_chunks.values())) > _MAX_CACHED_BYTES:
            self._cached_chunks.popitem(last=False)
        return data


class _ChannelChunks:
    """The chunks that contain messages of a channel, ordered by their start times."""

    def __init__(self, chunks: Collection[ChunkInfo]) -> None:
        self.chunks = sorted(chunks, key=lambda chunk: chunk.message_start_time)
        self._starts = [chunk.message_start_time for chunk in self.chunks]
        self._latest_ends: list[int] = []
        for chunk in self.chunks:
            self._latest_ends.append(max(chunk.message_end_time, self._latest_ends[-1] if self._latest_ends else 0))

    def iterate_backwards(self, at_ns: int) -> Iterator[tuple[ChunkInfo, int]]:
        """Yield the chunks that start at or before a time, from the last to the first.

        Each chunk is yielded with the latest end time among it and all chunks before it.
        """
        for index in range(bisect_right(self._starts, at_ns) - 1, -1, -1):
            yield self.chunks[index], self._latest_ends[index]
