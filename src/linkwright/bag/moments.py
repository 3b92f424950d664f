"""The state of a recording at a time: the last message of each topic, and the transforms."""

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

_MAX_EXACT_MESSAGES = 100_000
"""The maximum number of messages whose times are all looked up, so that they are counted exactly."""

_FIRST_WINDOW_NS = NANOSECONDS_PER_SECOND
_WINDOW_GROWTH = 8
"""The factor by which the intervals that are read backwards grow, in files without an index by topic."""


class StateLookup:
    """A lookup of the state of an open recording at any time.

    Args:
        reader: the library's reader; it must be open.
    """

    def __init__(self, reader: Reader) -> None:
        self._reader = reader

    def state_at(self, topics: Collection[str], at_ns: int) -> list[Recorded]:
        """Return the last message of each topic up to a time.

        For ``/tf``, the result contains the messages of the last two seconds. If there are none, it contains the
        messages of the two seconds up to the last message. For ``/tf_static``, it contains all messages. Topics with
        these names in a namespace are treated in the same way.

        Args:
            topics: the names of the topics.
            at_ns: the time, in nanoseconds since the epoch.

        Returns:
            The static transforms, then the other messages ordered by time.
        """
        static: list[Recorded] = []
        moving: list[Recorded] = []
        other_topics = []
        for topic in topics:
            if topic.endswith(STATIC_TRANSFORMS):
                static += self._between(topic, 0, at_ns)
            elif topic.endswith(TRANSFORMS):
                moving += self._transforms_before(topic, at_ns)
            else:
                other_topics.append(topic)
        moving += self._latest(other_topics, at_ns)
        return static + sorted(moving, key=lambda item: item[1])

    def time_before(self, topics: Collection[str], at_ns: int) -> int | None:
        """Return the reception time of the last message before a time, or None.

        Times are in nanoseconds since the epoch.
        """
        return max((stamp for _, stamp, _ in self._latest(topics, at_ns - 1)), default=None)

    def counts(self, intervals: int) -> dict[str, list[int]]:
        """Return the number of messages of each topic in equal intervals of the recording.

        The result is empty for a file without an index. In a long recording, the messages of a chunk, or of a short
        interval, are counted as if they were evenly distributed.
        """
        start, duration = self._reader.start_time, max(1, self._reader.duration)

        def part(stamp: int) -> int:
            return min(intervals - 1, max(0, (stamp - start) * intervals // duration))

        is_exact = self._reader.message_count <= _MAX_EXACT_MESSAGES
        counts_by_topic: dict[str, list[float]] = {}
        for storage, lookup in self._lookups:
            for connection in storage.connections:
                for first_ns, last_ns, count in lookup.counts(connection.id, exact=is_exact):
                    row = counts_by_topic.setdefault(connection.topic, [0.0] * intervals)
                    first, last = part(first_ns), part(last_ns)
                    for index in range(first, last + 1):
                        row[index] += count / (last - first + 1)
        return {name: [ceil(value) for value in row] for name, row in counts_by_topic.items()}

    @cached_property
    def _lookups(self) -> list[tuple[Any, McapLookup | RowLookup]]:
        """The lookups of the files.

        The list is empty if one of the files cannot be searched. A file cannot be searched if it has no index, or if
        its messages are compressed one by one.
        """
        storage: Any = self._reader.storage
        lookups: list[tuple[Any, McapLookup | RowLookup]] = []
        for file_storage in getattr(storage, "storages", [storage]):
            if hasattr(file_storage, "dbconn"):
                from linkwright.bag.rows import RowLookup

                lookups.append((file_storage, RowLookup(file_storage)))
            elif file_storage.chunks:
                from linkwright.bag.lookup import McapLookup

                lookups.append((file_storage, McapLookup(file_storage)))
            else:
                return []
        return [] if self._reader.compression_mode == "message" else lookups

    def _latest(self, topics: Collection[str], at_ns: int) -> list[Recorded]:
        if not self._lookups:
            return list(self._latest_without_index(topics, at_ns))
        messages = []
        for topic in topics:
            candidates = [lookup.latest(_channels(storage, topic), at_ns) for storage, lookup in self._lookups]
            best = max((item for item in candidates if item is not None), key=lambda item: item[0], default=None)
            if best is not None:
                messages.append((topic, *best))
        return messages

    def _transforms_before(self, topic: str, at_ns: int) -> list[Recorded]:
        recent = self._between(topic, at_ns - TRANSFORMS_NS, at_ns)
        if recent:
            return recent
        last_ns = next((stamp for _, stamp, _ in self._latest([topic], at_ns)), None)
        return [] if last_ns is None else self._between(topic, last_ns - TRANSFORMS_NS, last_ns)

    def _between(self, topic: str, start_ns: int, end_ns: int) -> list[Recorded]:
        if not self._lookups:
            connections = [connection for connection in self._reader.connections if connection.topic == topic]
            messages = self._reader.messages(connections, max(0, start_ns), end_ns + 1) if connections else iter(())
            return [(topic, stamp, data) for _, stamp, data in messages]
        return [
            (topic, *item)
            for storage, lookup in self._lookups
            for item in lookup.between(_channels(storage, topic), start_ns, end_ns)
        ]

    def _latest_without_index(self, topics: Collection[str], at_ns: int) -> Iterator[Recorded]:
        """Yield the last message of each topic, by reading ever longer intervals before the time."""
        remaining_topics = set(topics)
        end, length = at_ns + 1, _FIRST_WINDOW_NS
        while remaining_topics and end > self._reader.start_time:
            begin = max(end - length, self._reader.start_time)
            connections = [
                connection for connection in self._reader.connections if connection.topic in remaining_topics
            ]
            if not connections:
                return
            messages = _last_by_topic(self._reader.messages(connections, begin, end))
            yield from messages
            remaining_topics.difference_update(topic for topic, _, _ in messages)
            end, length = begin, length * _WINDOW_GROWTH


def _last_by_topic(messages: Iterable[tuple[Connection, int, bytes]]) -> list[Recorded]:
    last_messages: dict[str, Recorded] = {}
    for connection, stamp, data in messages:
        last_messages[connection.topic] = connection.topic, stamp, data
    return list(last_messages.values())


def _channels(storage: Any, topic: str) -> list[int]:
    return [connection.id for connection in storage.connections if connection.topic == topic]
