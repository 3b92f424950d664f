"""Find single messages of an SQLite recording, without reading other data.

Files of rosbag2 have an index of times, but not of topics. One pass over the rows, which does not read the messages,
determines the intervals in which each topic has messages. A search then reads only such an interval.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Collection, Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rosbags.rosbag2.storage_sqlite3 import Sqlite3Reader

_INTERVALS = 4800
"""The number of intervals into which the duration of a file is divided."""


class RowLookup:
    """A lookup of messages in an open SQLite file.

    Args:
        storage: the open file.
    """

    def __init__(self, storage: Sqlite3Reader) -> None:
        self._storage = storage
        self._start_ns = storage.metadata.start_time
        self._interval_ns = storage.metadata.duration // _INTERVALS + 1

    def latest(self, topics: Collection[int], at_ns: int) -> tuple[int, bytes] | None:
        """Return the time and the data of the last message of some topics up to a time.

        The time is in nanoseconds. Returns None if there is no message.
        """
        best = max((item for topic in topics for item in self._latest(topic, at_ns)), default=None)
        if best is None:
            return None
        ((data,),) = self._query("SELECT data FROM messages WHERE id = ?", best[1])
        return best[0], data

    def between(self, topics: Collection[int], start_ns: int, end_ns: int) -> list[tuple[int, bytes]]:
        """Return the times and the data of the messages from one time to another.

        The messages are ordered by time, and the times are in nanoseconds.

        Both limits are inclusive.
        """
        query = "SELECT timestamp, data FROM messages WHERE timestamp BETWEEN ? AND ? AND topic_id = ?"
        messages = []
        for topic in topics:
            for first_ns, last_ns in self._find_sections(topic, start_ns, end_ns):
                messages += self._query(f"{query} ORDER BY timestamp, id", first_ns, last_ns, topic)
        return sorted(messages, key=lambda row: row[0])

    def counts(self, topic: int, *, exact: bool) -> Iterator[tuple[int, int, int]]:
        """Yield the start time, end time and message count of intervals of a topic.

        Times are in nanoseconds since the epoch. An interval is a fixed share of the file's duration, or a single
        message.

        Args:
            topic: the ID of the topic.
            exact: whether to yield an interval for each message.
        """
        if exact:
            for (stamp_ns,) in self._query("SELECT timestamp FROM messages WHERE topic_id = ?", topic):
                yield stamp_ns, stamp_ns, 1
            return
        for interval, count in self._counts_by_topic.get(topic, {}).items():
            start_ns = self._compute_interval_start(interval)
            yield start_ns, start_ns + self._interval_ns - 1, count

    def _latest(self, topic: int, at_ns: int) -> Iterator[tuple[int, int]]:
        """Yield the time and row ID of a topic's last message up to a time, if there is one."""
        query = "SELECT timestamp, id FROM messages WHERE timestamp BETWEEN ? AND ? AND topic_id = ?"
        intervals = list(self._counts_by_topic.get(topic, {}))
        for interval in reversed(intervals[: bisect_right(intervals, (at_ns - self._start_ns) // self._interval_ns)]):
            interval_start_ns = self._compute_interval_start(interval)
            last_ns = min(at_ns, interval_start_ns + self._interval_ns - 1)
            rows = self._query(f"{query} ORDER BY timestamp DESC, id DESC LIMIT 1", interval_start_ns, last_ns, topic)
            if rows:
                yield rows[0]
                return

    def _find_sections(self, topic: int, start_ns: int, end_ns: int) -> list[tuple[int, int]]:
        """Return the parts of a time interval that can contain messages of a topic.

        The bounds are in ns. Adjacent parts are merged.
        """
        sections: list[tuple[int, int]] = []
        for interval in self._counts_by_topic.get(topic, {}):
            interval_start_ns = self._compute_interval_start(interval)
            first_ns, last_ns = max(interval_start_ns, start_ns), min(interval_start_ns + self._interval_ns - 1, end_ns)
            if first_ns > last_ns:
                continue
            if sections and sections[-1][1] + 1 == first_ns:
                first_ns = sections.pop()[0]
            sections.append((first_ns, last_ns))
        return sections

    def _compute_interval_start(self, interval: int) -> int:
        return self._start_ns + interval * self._interval_ns

    @cached_property
    def _counts_by_topic(self) -> dict[int, dict[int, int]]:
        """The number of messages of each topic in the intervals of the file's duration.

        It maps the ID of a topic to the counts by interval, in order, without empty intervals.
        """
        query = "SELECT topic_id, (timestamp - ?) / ? AS part, count(*) FROM messages GROUP BY topic_id, part"
        counts_by_topic: dict[int, dict[int, int]] = {}
        for topic, interval, count in self._query(f"{query} ORDER BY part", self._start_ns, self._interval_ns):
            counts_by_topic.setdefault(topic, {})[interval] = count
        return counts_by_topic

    def _query(self, sql: str, *values: int) -> list[Any]:
        connection: Any = self._storage.dbconn
        return list(connection.execute(sql, values))
