"""Finds single messages of an SQLite recording, without reading the data in between.

rosbag2's files have an index of times but none of topics. One pass over the rows, without reading the messages,
determines the intervals in which each topic has messages. A search then reads only such an interval.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Collection, Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rosbags.rosbag2.storage_sqlite3 import Sqlite3Reader

_PARTS = 4800
"""The number of parts into which the time of a file is divided."""


class RowLookup:
    """Finds messages of an open SQLite file.

    Args:
        storage: the open file.
    """

    def __init__(self, storage: Sqlite3Reader) -> None:
        self._storage = storage
        self._start_ns = storage.metadata.start_time
        self._part_ns = storage.metadata.duration // _PARTS + 1

    def latest(self, topics: Collection[int], at_ns: int) -> tuple[int, bytes] | None:
        """Return the time and data of the last message of topics up to a time, or None."""
        best = max((item for topic in topics for item in self._latest(topic, at_ns)), default=None)
        if best is None:
            return None
        ((data,),) = self._rows("SELECT data FROM messages WHERE id = ?", best[1])
        return best[0], data

    def between(self, topics: Collection[int], start_ns: int, end_ns: int) -> list[tuple[int, bytes]]:
        """Return the times and data of the messages from one time to another, both inclusive, in order."""
        words = "SELECT timestamp, data FROM messages WHERE timestamp BETWEEN ? AND ? AND topic_id = ?"
        found = []
        for topic in topics:
            for first_ns, last_ns in self._spans(topic, start_ns, end_ns):
                found += self._rows(f"{words} ORDER BY timestamp, id", first_ns, last_ns, topic)
        return sorted(found, key=lambda row: row[0])

    def counts(self, topic: int, *, exact: bool) -> Iterator[tuple[int, int, int]]:
        """Yield the start, the end and the number of messages of time intervals of a topic.

        Times are in nanoseconds.

        Args:
            topic: the ID of the topic.
            exact: whether to yield an interval for each message.
        """
        if exact:
            for (stamp_ns,) in self._rows("SELECT timestamp FROM messages WHERE topic_id = ?", topic):
                yield stamp_ns, stamp_ns, 1
            return
        for part, count in self._parts.get(topic, {}).items():
            begin_ns = self._begin_ns(part)
            yield begin_ns, begin_ns + self._part_ns - 1, count

    def _latest(self, topic: int, at_ns: int) -> Iterator[tuple[int, int]]:
        """Yield the time and the row ID of the last message of a topic up to a time, if there is one."""
        words = "SELECT timestamp, id FROM messages WHERE timestamp BETWEEN ? AND ? AND topic_id = ?"
        parts = list(self._parts.get(topic, {}))
        for part in reversed(parts[: bisect_right(parts, (at_ns - self._start_ns) // self._part_ns)]):
            begin_ns = self._begin_ns(part)
            last_ns = min(at_ns, begin_ns + self._part_ns - 1)
            rows = self._rows(f"{words} ORDER BY timestamp DESC, id DESC LIMIT 1", begin_ns, last_ns, topic)
            if rows:
                yield rows[0]
                return

    def _spans(self, topic: int, start_ns: int, end_ns: int) -> list[tuple[int, int]]:
        """Return the parts of a time interval that can contain messages of a topic, in nanoseconds.

        Adjacent parts are merged.
        """
        spans: list[tuple[int, int]] = []
        for part in self._parts.get(topic, {}):
            begin_ns = self._begin_ns(part)
            first_ns, last_ns = max(begin_ns, start_ns), min(begin_ns + self._part_ns - 1, end_ns)
            if first_ns > last_ns:
                continue
            if spans and spans[-1][1] + 1 == first_ns:
                first_ns = spans.pop()[0]
            spans.append((first_ns, last_ns))
        return spans

    def _begin_ns(self, part: int) -> int:
        return self._start_ns + part * self._part_ns

    @cached_property
    def _parts(self) -> dict[int, dict[int, int]]:
        """The number of messages of each topic in the parts of the recording's duration.

        The result maps the topic's ID to a dict of part -> count, in order, without empty parts.
        """
        words = "SELECT topic_id, (timestamp - ?) / ? AS part, count(*) FROM messages GROUP BY topic_id, part"
        found: dict[int, dict[int, int]] = {}
        for topic, part, count in self._rows(f"{words} ORDER BY part", self._start_ns, self._part_ns):
            found.setdefault(topic, {})[part] = count
        return found

    def _rows(self, words: str, *values: int) -> list[Any]:
        connection: Any = self._storage.dbconn
        return list(connection.execute(words, values))
