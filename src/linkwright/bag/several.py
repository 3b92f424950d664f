"""Read the files of a recording without ``metadata.yaml`` as one, ordered by time."""

from __future__ import annotations

import heapq
from collections.abc import Collection, Generator, Iterator, Sequence
from typing import Any

from rosbags.interfaces import Connection
from rosbags.rosbag2 import Reader
from rosbags.rosbag2.metadata import ReaderMetadata

_MAX_NS = 2**63 - 1

_Message = tuple[Connection, int, bytes]


class SeveralReader(Reader):
    """A reader of several files as one recording.

    Args:
        readers: the open readers of the files; the caller must close them.
    """

    def __init__(self, readers: Sequence[Reader]) -> None:  # the constructor of the library's class expects a path
        self.path = readers[0].path
        self.storage = _Storages(sorted(readers, key=lambda reader: reader.start_time))
        self.is_open = True


class _Storages:
    """The combined storage of several files, with the interface that the library expects.

    Attributes:
        storages: the storages of the files.
        connections: one connection for each pair of topic and type.
        metadata: the combined metadata of all files.
    """

    def __init__(self, readers: Sequence[Reader]) -> None:
        self.storages: list[Any] = [reader.storage for reader in readers]
        self._readers = readers
        merged_connections: dict[tuple[str, str], Connection] = {}
        for entry in (connection for reader in readers for connection in reader.connections):
            merged = merged_connections.get(_make_key(entry))
            count = entry.msgcount if merged is None else merged.msgcount + entry.msgcount
            merged_connections[_make_key(entry)] = (merged or entry)._replace(
                id=merged.id if merged else len(merged_connections) + 1, msgcount=count
            )
        self.connections = list(merged_connections.values())
        count = sum(reader.message_count for reader in readers)
        start = min(reader.start_time for reader in readers)
        end = max(reader.end_time for reader in readers)
        compressed_metadata = [reader.storage.metadata for reader in readers if reader.compression_mode]
        self.metadata = ReaderMetadata(
            duration=end - start if count else 0,
            start_time=start,
            end_time=end,
            message_count=count,
            compression_format=compressed_metadata[0].compression_format if compressed_metadata else None,
            compression_mode=compressed_metadata[0].compression_mode if compressed_metadata else None,
            ros_distro=readers[0].ros_distro,
            custom=None,
        )

    def open(self) -> None:
        """Do nothing, because the files are already open."""

    def close(self) -> None:
        """Do nothing, because the caller that opened the files closes them."""

    def messages(
        self, connections: Collection[Connection], start: int | None = None, stop: int | None = None
    ) -> Generator[_Message, None, None]:
        """Yield the messages of all files, ordered by time.

        A file is opened only when its first message is due.
        """
        connection_by_key = {_make_key(connection): connection for connection in connections}
        unopened = [
            reader for reader in self._readers if reader.message_count and (start is None or reader.end_time > start)
        ]
        unopened.reverse()
        streams: list[tuple[int, int, _Message, Iterator[_Message]]] = []
        sequence = 0
        while streams or unopened:
            next_ns = streams[0][0] if streams else _MAX_NS
            if unopened and (not streams or unopened[-1].start_time <= next_ns):
                stream = self._iterate_messages(unopened.pop(), connection_by_key, start, stop)
            else:
                _, _, message, stream = heapq.heappop(streams)
                yield message
            first = next(stream, None)
            if first is not None:
                sequence += 1
                heapq.heappush(streams, (first[1], sequence, first, stream))

    @staticmethod
    def _iterate_messages(
        reader: Reader, connection_by_key: dict[tuple[str, str], Connection], start: int | None, stop: int | None
    ) -> Iterator[_Message]:
        file_connections = [
            connection for connection in reader.connections if _make_key(connection) in connection_by_key
        ]
        for connection, stamp_ns, data in reader.messages(file_connections, start, stop) if file_connections else ():
            yield connection_by_key[_make_key(connection)], stamp_ns, data


def _make_key(connection: Connection) -> tuple[str, str]:
    return connection.topic, connection.msgtype
