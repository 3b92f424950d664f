"""Finds the state of a recording at a time: the last message of each topic, and the transforms."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from functools import cached_property
from math import ceil
from typing import TYPE_CHECKING, Any

from linkwright.bag.names import STATIC_TRANSFORMS, TRANSFORMS, TRANSFORMS_NS, Recorded
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from rosbags.interfaces import Connection
    from rosbags.rosbag2 import Reader

    from linkwright.bag.lookup import McapLookup
    from linkwright.bag.rows import RowLookup

_MOST_COUNTED = 100_000
"""Messages whose times are looked up, so that they are counted in the part of the recording in which they came."""

_FIRST_WINDOW_NS = NANOSECONDS_PER_SECOND
_WIDER = 8
"""The factor between the lengths of two looks back, in files without an index by topic."""


class Moments:
    """Finds the state of an open recording at any time.

    Args:
        reader: the library's reader, which is open.
    """

    def __init__(self, reader: Reader) -> None:
        self._reader = reader

    def state_at(self, topics: Collection[str], at_ns: int) -> list[Recorded]:
        """Return the last message of each topic up to a time.

        For ``/tf``, the result contains the messages of the last two seconds, or of the two seconds before a pause that
        is longer than that; for ``/tf_static``, all messages. Topics with these names in a namespace are
        treated in the same way.

        Args:
            topics: the names of the topics.
            at_ns: the time, in nanoseconds since the epoch.

        Returns:
            The messages ordered by time, after the static transforms.
        """
        found: list[Recorded] = []
        moving: list[Recorded] = []
        others = []
        for topic in topics:
            if topic.endswith(STATIC_TRANSFORMS):
                found += self._between(topic, 0, at_ns)
            elif topic.endswith(TRANSFORMS):
                moving += self._transforms_before(topic, at_ns)
            else:
                others.append(topic)
        moving += self._latest(others, at_ns)
        return found + sorted(moving, key=lambda item: item[1])

    def time_before(self, topics: Collection[str], at_ns: int) -> int | None:
        """Return the reception time of the last message before a time, or None if there is none.

        Times are in nanoseconds since the epoch.
        """
        return max((stamp for _, stamp, _ in self._latest(topics, at_ns - 1)), default=None)

    def counts(self, parts: int) -> dict[str, list[int]]:
        """Return the number of messages of each topic in equal parts of the recording's duration.

        The result is empty for a file without an index. In a long recording, the messages of a chunk, or of a short
        interval, are counted as if they were evenly distributed.
        """
        start, duration = self._reader.start_time, max(1, self._reader.duration)

        def part(stamp: int) -> int:
            return min(parts - 1, max(0, (stamp - start) * parts // duration))

        exact = self._reader.message_count <= _MOST_COUNTED
        found: dict[str, list[float]] = {}
        for storage, lookup in self._lookups:
            for connection in storage.connections:
                for first_ns, last_ns, count in lookup.counts(connection.id, exact=exact):
                    row = found.setdefault(connection.topic, [0.0] * parts)
                    first, last = part(first_ns), part(last_ns)
                    for index in range(first, last + 1):
                        row[index] += count / (last - first + 1)
        return {name: [ceil(value) for value in row] for name, row in found.items()}

    @cached_property
    def _lookups(self) -> list[tuple[Any, McapLookup | RowLookup]]:
        """The lookups of the files, or an empty list if a file cannot be searched.

        A file without an index, or with messages that are compressed one by one, cannot be searched.
        """
        storage: Any = self._reader.storage
        found: list[tuple[Any, McapLookup | RowLookup]] = []
        for part in getattr(storage, "storages", [storage]):
            if hasattr(part, "dbconn"):
                from linkwright.bag.rows import RowLookup

                found.append((part, RowLookup(part)))
            elif part.chunks:
                from linkwright.bag.lookup import McapLookup

                found.append((part, McapLookup(part)))
            else:
                return []
        return [] if self._reader.compression_mode == "message" else found

    def _latest(self, topics: Collection[str], at_ns: int) -> list[Recorded]:
        if not self._lookups:
            return list(self._latest_without_index(topics, at_ns))
        found = []
        for topic in topics:
            last = [lookup.latest(_channels(storage, topic), at_ns) for storage, lookup in self._lookups]
            best = max((item for item in last if item is not None), key=lambda item: item[0], default=None)
            if best is not None:
                found.append((topic, *best))
        return found

    def _transforms_before(self, topic: str, at_ns: int) -> list[Recorded]:
        near = self._between(topic, at_ns - TRANSFORMS_NS, at_ns)
        if near:
            return near
        last = next((stamp for _, stamp, _ in self._latest([topic], at_ns)), None)
        return [] if last is None else self._between(topic, last - TRANSFORMS_NS, last)

    def _between(self, topic: str, start_ns: int, end_ns: int) -> list[Recorded]:
        if not self._lookups:
            connections = [connection for connection in self._reader.connections if connection.topic == topic]
            read = self._reader.messages(connections, max(0, start_ns), end_ns + 1) if connections else iter(())
            return [(topic, stamp, data) for _, stamp, data in read]
        return [
            (topic, *item)
            for storage, lookup in self._lookups
            for item in lookup.between(_channels(storage, topic), start_ns, end_ns)
        ]

    def _latest_without_index(self, topics: Collection[str], at_ns: int) -> Iterator[Recorded]:
        """Yield the last message of each topic, by reading increasingly long intervals before the time."""
        missing = set(topics)
        end, length = at_ns + 1, _FIRST_WINDOW_NS
        while missing and end > self._reader.start_time:
            begin = max(end - length, self._reader.start_time)
            connections = [connection for connection in self._reader.connections if connection.topic in missing]
            if not connections:
                return
            found = _last_of_each(self._reader.messages(connections, begin, end))
            yield from found
            missing.difference_update(topic for topic, _, _ in found)
            end, length = begin, length * _WIDER


def _last_of_each(messages: Iterable[tuple[Connection, int, bytes]]) -> list[Recorded]:
    found: dict[str, Recorded] = {}
    for connection, stamp, data in messages:
        found[connection.topic] = connection.topic, stamp, data
    return list(found.values())


def _channels(storage: Any, topic: str) -> list[int]:
    return [connection.id for connection in storage.connections if connection.topic == topic]
