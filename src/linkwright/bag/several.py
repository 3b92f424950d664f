"""Reads the files of a recording without ``metadata.yaml`` as one recording, ordered by time."""

from __future__ import annotations

import heapq
from collections.abc import Collection, Generator, Iterator, Sequence
from typing import Any

from rosbags.interfaces import Connection
from rosbags.rosbag2 import Reader
from rosbags.rosbag2.metadata import ReaderMetadata

_NEVER_NS = 2**63 - 1

_Message = tuple[Connection, int, bytes]


class SeveralReader(Reader):
    """Reads several files as if they were one.

    Args:
        readers: the open readers of the files; the caller closes them.
    """

    def __init__(self, readers: Sequence[Reader]) -> None:  # the constructor of the library's class expects a path
        self.path = readers[0].path
        self.storage = _Storages(sorted(readers, key=lambda reader: reader.start_time))
        self.is_open = True


class _Storages:
    """A storage of several files, with the interface that the library expects.

    Attributes:
        storages: the storages of the files.
        connections: one connection for each topic and type.
        metadata: the combined metadata of all files.
    """

    def __init__(self, readers: Sequence[Reader]) -> None:
        self.storages: list[Any] = [reader.storage for reader in readers]
        self._readers = readers
        found: dict[tuple[str, str], Connection] = {}
        for entry in (connection for reader in readers for connection in reader.connections):
            known = found.get(_key(entry))
            count = entry.msgcount if known is None else known.msgcount + entry.msgcount
            found[_key(entry)] = (known or entry)._replace(id=known.id if known else len(found) + 1, msgcount=count)
        self.connections = list(found.values())
        count = sum(reader.message_count for reader in readers)
        start = min(reader.start_time for reader in readers)
        end = max(reader.end_time for reader in readers)
        packed = [reader.storage.metadata for reader in readers if reader.compression_mode]
        self.metadata = ReaderMetadata(
            duration=end - start if count else 0,
            start_time=start,
            end_time=end,
            message_count=count,
            compression_format=packed[0].compression_format if packed else None,
            compression_mode=packed[0].compression_mode if packed else None,
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
        """Yield the messages of all files ordered by time; a file is opened when its first message is next."""
        wanted = {_key(connection): connection for connection in connections}
        waiting = [
            reader for reader in self._readers if reader.message_count and (start is None or reader.end_time > start)
        ]
        waiting.reverse()
        streams: list[tuple[int, int, _Message, Iterator[_Message]]] = []
        number = 0
        while streams or waiting:
            next_ns = streams[0][0] if streams else _NEVER_NS
            if waiting and (not streams or waiting[-1].start_time <= next_ns):
                stream = self._stream(waiting.pop(), wanted, start, stop)
            else:
                _, _, message, stream = heapq.heappop(streams)
                yield message
            first = next(stream, None)
            if first is not None:
                number += 1
                heapq.heappush(streams, (first[1], number, first, stream))

    @staticmethod
    def _stream(
        reader: Reader, wanted: dict[tuple[str, str], Connection], start: int | None, stop: int | None
    ) -> Iterator[_Message]:
        own = [connection for connection in reader.connections if _key(connection) in wanted]
        for connection, stamp_ns, data in reader.messages(own, start, stop) if own else ():
            yield wanted[_key(connection)], stamp_ns, data


def _key(connection: Connection) -> tuple[str, str]:
    return connection.topic, connection.msgtype
