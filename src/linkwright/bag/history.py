"""The messages of the last minutes in memory, as a recording of limited size that can be played.

Three measures save memory. First, messages that repeat a state are stored sparsely: of messages that differ only in
their stamps, only the first and the newest are stored. Second, messages of a simulated clock are stored only if they
are close to messages of other topics. Third, if the memory is full, old large messages (images, clouds) are thinned
out: the older they are, the sparser.

A thread compresses large messages with Zstandard in memory, if compression makes them clearly smaller. Images and
clouds of a simulation shrink to a tenth or a hundredth, while those with the noise of a real sensor hardly shrink. The
fastest compression level is sufficient to distinguish the two.
"""

from __future__ import annotations

import sys
import threading
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Collection, Iterator
from functools import cache
from heapq import heappop, heappush
from queue import SimpleQueue
from typing import Any, Generic, TypeVar

from linkwright.bag.names import STATIC_TRANSFORMS, TRANSFORMS, TRANSFORMS_NS, Recorded
from linkwright.bag.stillness import Content, clock_between
from linkwright.graph.simulated_time import CLOCK_TOPIC
from linkwright.messages import TFMessage, deserialize
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_LEAST_BYTES = 16_384
"""Smaller messages stay as they are."""

_WORTH = 0.8
"""The part of its size below which a message is kept compressed: decompression takes time, too."""

_MOST_WAITING = 64_000_000
"""Bytes that wait for the thread; where more come than it can pack, the rest stays as it is."""

_LEVEL = 1

K = TypeVar("K")


class Packed(bytes):
    """A compressed message; its length is the number of compressed bytes."""

    __slots__ = ()


@cache
def _zstd() -> Any:
    """Return the compression library, or None if the extra `bag` is not installed."""
    if sys.version_info >= (3, 14):
        from compression import zstd
    else:
        try:
            from backports import zstd
        except ModuleNotFoundError:
            return None
    return zstd


def uncompressed_bytes(data: bytes) -> bytes:
    """Return the serialized message, decompressed if it is a `Packed`."""
    return bytes(_zstd().decompress(data)) if type(data) is Packed else data


class Shrinker(Generic[K]):
    """Compresses messages in a separate thread, which starts with the first large message.

    Args:
        done: called in that thread with the key of a message and the compressed message.
    """

    def __init__(self, done: Callable[[K, Packed], object]) -> None:
        self._done = done
        self._queue: SimpleQueue[tuple[K, bytes] | None] = SimpleQueue()
        self._thread: threading.Thread | None = None
        self._waiting = 0
        self._lock = threading.Lock()

    def offer(self, key: K, data: bytes) -> None:
        """Queue a message for compression if the message is large."""
        if len(data) < _LEAST_BYTES or _zstd() is None:
            return
        with self._lock:
            if self._waiting + len(data) > _MOST_WAITING:
                return
            self._waiting += len(data)
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="history", daemon=True)
                self._thread.start()
        self._queue.put((key, data))

    def close(self) -> None:
        """Stop the thread."""
        self._queue.put(None)

    def _run(self) -> None:
        while (offered := self._queue.get()) is not None:
            key, data = offered
            packed = _zstd().compress(data, _LEVEL)
            if len(packed) < _WORTH * len(data):
                self._done(key, Packed(packed))
            with self._lock:
                self._waiting -= len(data)


_OVERHEAD = 200
"""Bytes that a message takes besides its own: its tuple, two numbers, two places in lists."""

_UNUSED = 1024
"""Places at the beginning of a list that are given back together."""

_STILL_NS = 10_000_000_000
"""An unchanged state is stored again after this time, so that a search need not look further back."""

_LARGE = 6000
"""Mean bytes of a topic's packed messages above which it is thinned before any message is dropped."""

_LONGEST_NS = 600_000_000_000
"""The maximum age of thinned messages."""

_FREED = 20
"""Thinning frees one part in this many of all memory at once."""

_Kept = tuple[int, int, bytes]
"""A message: time of reception in ns since the epoch, number of messages before it, CDR bytes."""


class _Track:
    """The stored messages of one topic.

    The last dropped message is stored as well, because it is the state at the beginning of the remaining messages.

    Args:
        name: the name of the topic.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self.kept: list[_Kept] = []
        self.first = 0
        self.size = 0
        self.before: dict[object, _Kept] = {}
        self.is_queued = False
        self._runs: dict[str, _Run] = {}
        self._lasting: set[int] = set()

    def __len__(self) -> int:
        return len(self.kept) - self.first

    @property
    def can_be_thinned(self) -> bool:
        """Whether the track has enough large messages and is short enough; False for transforms."""
        if len(self) < _FREED or self.size < _LARGE * len(self) or self.name in (TRANSFORMS, STATIC_TRANSFORMS):
            return False
        return self.kept[-1][0] - self.kept[self.first][0] < _LONGEST_NS

    def append(self, stamp_ns: int, number: int, data: bytes) -> None:
        """Append a message."""
        self.kept.append((stamp_ns, number, data))
        self.size += _size(data)

    def repeat(self, stamp_ns: int, number: int, data: bytes, content: Content) -> int | None:
        """Replace an earlier message with equal content by this one.

        Of a run of equal messages, two are stored: the first message, and a second entry that always has the newest
        data and the time at which the second message arrived. A reader between the two gets the state at that
        time, with a stamp that is not too old. For a clock, the second entry has the newest time too, because
        the clock ran evenly between the two (see `clock_at`).

        Returns:
            The number of additional bytes, or None if there is no message to replace.
        """
        run = self._runs.get(content.what)
        if run is None or not run.content.is_repeated_by(content) or stamp_ns - run.since_ns >= _STILL_NS:
            self._runs[content.what] = _Run(stamp_ns, content)
            return None
        place = None if run.second is None else self._place(run.second)
        is_clock = content.clock_ns is not None
        if place is None or (is_clock and place != len(self.kept) - 1):
            run.second = number
            self._lasting.add(number)
            return None
        came_ns, number, replaced = self.kept[place]
        self.kept[place] = stamp_ns if is_clock else came_ns, number, data
        self.size += len(data) - len(replaced)
        return len(data) - len(replaced)

    def drop(self) -> int:
        """Drop the oldest message, and return the number of freed bytes."""
        oldest = self.kept[self.first]
        self.kept[self.first] = (oldest[0], oldest[1], b"")
        self.first += 1
        self.size -= _size(oldest[2])
        self._lasting.discard(oldest[1])
        if self.first >= _UNUSED:
            del self.kept[: self.first]
            self.first = 0
        if self.name == TRANSFORMS:
            return _size(oldest[2])  # dropped transforms are not stored, because only the last seconds are useful
        key = (
            deserialize(uncompressed_bytes(oldest[2]), TFMessage).batch.children
            if self.name == STATIC_TRANSFORMS
            else None
        )
        replaced = self.before.pop(key, None)
        self.before[key] = oldest
        return 0 if replaced is None else _size(replaced[2])

    def thin(self, wanted: int) -> int:
        """Drop messages that are closer to their neighbours than their age requires.

        Args:
            wanted: the number of bytes to free.

        Returns:
            The number of freed bytes.
        """
        kept = self.kept[self.first :]
        now_ns = kept[-1][0] + NANOSECONDS_PER_SECOND
        gaps = [
            ((after[0] - before[0]) / (now_ns - each[0]), place)
            for place, (before, each, after) in enumerate(zip(kept, kept[1:], kept[2:], strict=False), 1)
        ]
        gone: set[int] = set()
        freed = 0
        for _, place in sorted(gaps):
            if freed >= wanted:
                break
            if place - 1 not in gone and place + 1 not in gone:
                gone.add(place)
                freed += _size(kept[place][2])
        self._lasting.difference_update(kept[place][1] for place in gone)
        self.kept = [each for place, each in enumerate(kept) if place not in gone]
        self.first = 0
        self.size -= freed
        return freed

    def replace(self, number: int, packed: Packed) -> int:
        """Replace a message by its compressed form, and return the number of freed bytes."""
        place = self._place(number)
        if place is None:
            return 0  # the message was dropped in the meantime
        stamp_ns, _, data = self.kept[place]
        self.kept[place] = stamp_ns, number, packed
        self.size -= len(data) - len(packed)
        return len(data) - len(packed)

    def _place(self, number: int) -> int | None:
        """Return the index of the message with a number, or None if the message was dropped."""
        place = bisect_left(self.kept, number, lo=self.first, key=lambda item: item[1])
        return place if place < len(self.kept) and self.kept[place][1] == number else None

    def repeated_after(self, start_ns: int, end_ns: int) -> list[_Kept]:
        """Return the messages in a time interval that were repeated after the interval."""
        return [item for item in self.between(start_ns, end_ns) if item[1] in self._lasting]

    def repeated_until(self, at_ns: int) -> list[_Kept]:
        """Return the messages whose content is still repeated at a time.

        For transforms these are all repeated messages; for another topic, the last message if it is repeated.
        """
        lasting = self.repeated_after(at_ns - _STILL_NS, at_ns)
        if self.name == TRANSFORMS:
            return lasting
        return lasting[-1:] if lasting[-1:] == self.until(at_ns, 1) else []

    def until(self, at_ns: int, count: int) -> list[_Kept]:
        """Return the last `count` messages up to a time, or fewer if there are not as many."""
        end = bisect_right(self.kept, (at_ns, sys.maxsize), lo=self.first)
        return self.kept[max(self.first, end - count) : end]

    def clock_at(self, at_ns: int) -> list[_Kept]:
        """Return the last message of a clock up to a time, in a list that is empty if there is none.

        If the message represents several clock messages, the time is interpolated.
        """
        before = self.until(at_ns, 1)
        place = bisect_right(self.kept, (at_ns, sys.maxsize), lo=self.first)
        if not before or place == len(self.kept) or self.kept[place][1] not in self._lasting:
            return before
        (began_ns, number, earlier), (end_ns, _, later) = before[0], self.kept[place]
        return [(at_ns, number, clock_between(earlier, later, (at_ns - began_ns) / (end_ns - began_ns)))]

    def between(self, start_ns: int, end_ns: int) -> list[_Kept]:
        """Return the messages from one time to another, both inclusive."""
        begin = bisect_left(self.kept, (start_ns,), lo=self.first)
        return self.kept[begin : bisect_right(self.kept, (end_ns, sys.maxsize), lo=self.first)]


class _Run:
    """A run of messages of a topic with equal content.

    The run records its start time and the number of its second message.
    """

    __slots__ = ("content", "second", "since_ns")

    def __init__(self, since_ns: int, content: Content) -> None:
        self.since_ns = since_ns
        self.content = content
        self.second: int | None = None


class History:
    """Stores messages until newer ones need their space; can be played while messages are added.

    Messages may be added from any thread. The recorded times never decrease, even if the clock goes back. Large
    messages are compressed if that makes them smaller.

    Args:
        most_bytes: the maximum number of bytes; a larger message is not stored.
        now_ns: returns the current time, in nanoseconds since the epoch.

    Attributes:
        lock: held while a message is added; hold the lock to prevent changes.
        size: the number of bytes in use.
        count: the number of messages that were ever added.
    """

    def __init__(self, most_bytes: int, now_ns: Callable[[], int]) -> None:
        self.most_bytes = most_bytes
        self.lock = threading.RLock()
        self.size = 0
        self.count = 0
        self._now_ns = now_ns
        self._newest_ns = 0
        self._tracks: dict[str, _Track] = {}
        self._oldest: list[tuple[int, str, _Track]] = []
        self._largest: _Track | None = None
        self._clock_ns = 0
        self._changes = 0
        self._shrinker = Shrinker(self._replace)

    def add(self, topic: str, data: bytes, at_ns: int | None = None, content: Content | None = None) -> None:
        """Add a message.

        Args:
            topic: the name of the topic.
            data: the serialized message.
            at_ns: the time of reception; None for the current time. A time earlier than the newest message is replaced
                by the time of that message.
            content: the content of the message (see `stillness`); a message that only repeats earlier ones then needs
                no additional memory.
        """
        size = _size(data)
        if size > self.most_bytes:
            return
        with self.lock:
            self._newest_ns = max(self._newest_ns, self._now_ns() if at_ns is None else at_ns)
            track = self._tracks.get(topic)
            if track is None:
                track = self._tracks[topic] = _Track(topic)
            if content is not None and content.clock_ns is not None:
                content = self._as_time_passes(content, content.clock_ns)
            more = None if content is None else track.repeat(self._newest_ns, self.count, data, content)
            if more is not None:
                self.size += more
                return
            track.append(self._newest_ns, self.count, data)
            if content is None or content.clock_ns is None:
                self._changes += 1
            self._queue(track)
            if self._largest is None or track.size > self._largest.size:
                self._largest = track
            self.count += 1
            self.size += size
            while self.size > self.most_bytes and self._make_room():
                pass
            number = self.count - 1
        self._shrinker.offer((track, number), data)

    def close(self) -> None:
        """Stop compressing; the stored messages remain available."""
        self._shrinker.close()

    def _as_time_passes(self, content: Content, clock_ns: int) -> Content:
        """Return the content of a clock message for the comparison with earlier clock messages.

        Clock messages count as repeated while no other message arrives and the time is not reset.
        """
        if clock_ns < self._clock_ns:
            self._changes += 1
        self._clock_ns = clock_ns
        return content._replace(state=b"%d" % self._changes)

    def _make_room(self) -> bool:
        """Thin out large messages or drop the oldest message; return False if there are no messages."""
        large = self._largest
        if large is not None and large.size > self.most_bytes // 2 and large.can_be_thinned:
            freed = large.thin(self.most_bytes // _FREED)
            self.size -= freed
            return freed > 0
        oldest = self._first()
        if oldest is None:
            return False
        self.size -= oldest.drop()
        return True

    def _queue(self, track: _Track) -> None:
        """Add a track to the queue that is ordered by the oldest message of each track."""
        if not track.is_queued and len(track) > 0:
            track.is_queued = True
            heappush(self._oldest, (track.kept[track.first][1], track.name, track))

    def _first(self) -> _Track | None:
        """Return the track with the oldest message, or None if there are no messages."""
        while self._oldest:
            number, _, track = self._oldest[0]
            if len(track) > 0 and track.kept[track.first][1] == number:
                return track
            heappop(self._oldest)
            track.is_queued = False
            self._queue(track)
        return None

    def _replace(self, key: tuple[_Track, int], packed: Packed) -> None:
        track, number = key
        with self.lock:
            self.size -= track.replace(number, packed)

    @property
    def start_ns(self) -> int:
        """The time of the oldest message, in ns since the epoch; the current time without messages."""
        with self.lock:
            oldest = self._first()
            return self.end_ns if oldest is None else oldest.kept[oldest.first][0]

    @property
    def end_ns(self) -> int:
        """The current time, in nanoseconds since the epoch, because the last message of a topic is still valid."""
        return max(self._newest_ns, self._now_ns())

    def messages(self, topics: Collection[str], start_ns: int) -> Iterator[Recorded]:
        """Yield the messages of topics that were received at or after a time.

        After the iterator is exhausted, it continues when new messages arrive.
        """
        return _LiveIterator(self, topics, start_ns)

    def state_at(self, topics: Collection[str], at_ns: int) -> list[Recorded]:
        """Return the last message of each topic up to a time.

        For ``/tf``, the result contains the messages of the last two seconds; for ``/tf_static``, all messages.
        """
        static: list[Recorded] = []
        found: list[Recorded] = []
        with self.lock:
            for name in topics:
                track = self._tracks.get(name)
                if track is None:
                    continue
                if name == TRANSFORMS:
                    near_ns = at_ns - TRANSFORMS_NS
                    kept = track.repeated_after(near_ns - _STILL_NS, near_ns - 1) + track.between(near_ns, at_ns)
                else:
                    count = sys.maxsize if name == STATIC_TRANSFORMS else 1
                    kept = track.clock_at(at_ns) if name == CLOCK_TOPIC else track.until(at_ns, count)
                    before = [item for item in track.before.values() if item[0] <= at_ns]
                    if name == STATIC_TRANSFORMS:
                        kept = before + kept
                    kept = kept or before
                into = static if name == STATIC_TRANSFORMS else found
                into += [(name, stamp, uncompressed_bytes(data)) for stamp, _, data in kept]
        return static + sorted(found, key=lambda item: item[1])

    def time_before(self, topics: Collection[str], at_ns: int) -> int | None:
        """Return the reception time of the last message before a time, or None if there is none.

        Times are in nanoseconds since the epoch.
        """
        with self.lock:
            last = [self._tracks[name].until(at_ns - 1, 1) for name in topics if name in self._tracks]
            return max((item[0][0] for item in last if item), default=None)

    def part(self, start_ns: int, end_ns: int) -> list[Recorded]:
        """Return the messages from one time to another, both inclusive, ordered by time.

        The result begins with the messages of the state at the start (see `state_at`), whose times are set to the
        start. It ends with the messages that are still repeated at the end. Compressed messages remain
        compressed, because they could be too large together (see `uncompressed_bytes`).
        """
        with self.lock:
            before = self.state_at(list(self._tracks), start_ns - 1)
            came = [(name, *item) for name, track in self._tracks.items() for item in track.between(start_ns, end_ns)]
            after = [(name, item[2]) for name, track in self._tracks.items() for item in track.repeated_until(end_ns)]
        came.sort(key=lambda item: item[2])
        return [
            *((name, start_ns, data) for name, _, data in before),
            *((name, at, data) for name, at, _, data in came),
            *((name, end_ns, data) for name, data in after),
        ]

    def after(self, topics: Collection[str], start_ns: int, number: int) -> tuple[int, Recorded] | None:
        """Return the first message of topics at or after a time, and its number.

        The first `number` messages are skipped. The result is None if there is no such message.
        """
        best: tuple[_Kept, str] | None = None
        with self.lock:
            for name in topics:
                track = self._tracks.get(name)
                if track is None:
                    continue
                place = bisect_left(track.kept, (start_ns, number), lo=track.first)
                if place < len(track.kept) and (best is None or track.kept[place][:2] < best[0][:2]):
                    best = track.kept[place], name
        if best is None:
            return None
        (stamp, found, data), name = best
        return found, (name, stamp, uncompressed_bytes(data))


class _LiveIterator(Iterator[Recorded]):
    """Iterates over messages ordered by time.

    After the iterator is exhausted, it continues when new messages arrive.
    """

    def __init__(self, history: History, topics: Collection[str], start_ns: int) -> None:
        self._history = history
        self._topics = topics
        self._start_ns = start_ns
        self._number = 0

    def __next__(self) -> Recorded:
        found = self._history.after(self._topics, self._start_ns, self._number)
        if found is None:
            raise StopIteration
        number, recorded = found
        self._start_ns, self._number = recorded[1], number + 1
        return recorded


def _size(data: bytes) -> int:
    return len(data) + _OVERHEAD
