"""Keep the messages of the last minutes in memory, as a recording of limited size.

Three measures save memory. First, repeated states are stored sparsely: of messages that differ only in their stamps,
only the first and the newest are stored. Second, messages of a simulated clock are stored only if they are close to
messages of other topics. Third, if the memory is full, old large messages (images, clouds) are thinned out: the older
they are, the more.

A thread compresses large messages with Zstandard in memory, if compression makes them clearly smaller. Images and
clouds of a simulation shrink to a tenth or a hundredth of their size, while the noisy data of a real sensor hardly
shrink. The fastest compression level is sufficient to distinguish the two cases.
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
from linkwright.bag.stillness import Content, interpolate_clock
from linkwright.graph.simulated_time import CLOCK_TOPIC
from linkwright.messages import TFMessage, deserialize
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_MIN_BYTES = 16_384
"""The minimum size of a message to compress."""

_MAX_COMPRESSION_RATIO = 0.8
"""The maximum size of a compressed message, as a share of its size: decompression also takes time."""

_MAX_QUEUED_BYTES = 64_000_000
"""The maximum number of bytes that wait for compression. Messages beyond that stay uncompressed."""

_COMPRESSION_LEVEL = 1

K = TypeVar("K")


class CompressedMessage(bytes):
    """The bytes of a compressed message."""

    __slots__ = ()


@cache
def _import_zstd() -> Any:
    """Return the compression library, or None if the extra `bag` is not installed."""
    if sys.version_info >= (3, 14):
        from compression import zstd
    else:
        try:
            from backports import zstd
        except ModuleNotFoundError:
            return None
    return zstd


def decompress(data: bytes) -> bytes:
    """Return a serialized message, decompressed if it is `CompressedMessage`."""
    return bytes(_import_zstd().decompress(data)) if type(data) is CompressedMessage else data


class Shrinker(Generic[K]):
    """A thread that compresses large messages.

    The thread starts when the first large message arrives.

    Args:
        done: called in that thread with the key of a message and its compressed form.
    """

    def __init__(self, done: Callable[[K, CompressedMessage], object]) -> None:
        self._done = done
        self._queue: SimpleQueue[tuple[K, bytes] | None] = SimpleQueue()
        self._thread: threading.Thread | None = None
        self._waiting = 0
        self._lock = threading.Lock()

    def offer(self, key: K, data: bytes) -> None:
        """Queue a message for compression if it is large and there is room in the queue."""
        if len(data) < _MIN_BYTES or _import_zstd() is None:
            return
        with self._lock:
            if self._waiting + len(data) > _MAX_QUEUED_BYTES:
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
        while (item := self._queue.get()) is not None:
            key, data = item
            packed = _import_zstd().compress(data, _COMPRESSION_LEVEL)
            if len(packed) < _MAX_COMPRESSION_RATIO * len(data):
                self._done(key, CompressedMessage(packed))
            with self._lock:
                self._waiting -= len(data)


_OVERHEAD_BYTES = 200
"""The bytes that a message takes in addition to its data: a tuple, two numbers and two list entries."""

_MAX_UNUSED = 1024
"""The number of unused entries at the beginning of a list that are deleted together."""

_MAX_REPEAT_NS = 10_000_000_000
"""The time after which an unchanged state is stored again, so that a search need not look further back."""

_LARGE_MEAN_BYTES = 6000
"""The minimum mean size of a topic's messages for which they are thinned before any message is dropped."""

_MAX_THINNED_NS = 600_000_000_000
"""The maximum time span of a topic's messages for which they are thinned."""

_FREED_DIVISOR = 20
"""Thinning frees one n-th of the maximum memory at once."""

_Entry = tuple[int, int, bytes]
"""A message: reception time in ns since the epoch, number of messages before it, and serialized data."""


class _Track:
    """The stored messages of one topic.

    The last dropped message is also stored, because it is the state at the beginning of the remaining messages.

    Args:
        name: the name of the topic.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self.entries: list[_Entry] = []
        self.first_index = 0
        self.size = 0
        self.before: dict[object, _Entry] = {}
        self.is_queued = False
        self._runs: dict[str, _Run] = {}
        self._repeated_numbers: set[int] = set()

    def __len__(self) -> int:
        return len(self.entries) - self.first_index

    @property
    def can_be_thinned(self) -> bool:
        """Whether there are enough large messages in a short enough time.

        The value is always False for transforms.
        """
        if (
            len(self) < _FREED_DIVISOR
            or self.size < _LARGE_MEAN_BYTES * len(self)
            or self.name in (TRANSFORMS, STATIC_TRANSFORMS)
        ):
            return False
        return self.entries[-1][0] - self.entries[self.first_index][0] < _MAX_THINNED_NS

    def append(self, stamp_ns: int, number: int, data: bytes) -> None:
        """Append a message."""
        self.entries.append((stamp_ns, number, data))
        self.size += _compute_stored_size(data)

    def repeat(self, stamp_ns: int, number: int, data: bytes, content: Content) -> int | None:
        """Replace an earlier message with equal content by a new one.

        Of a run of equal messages, two are stored: the first one, and a second entry that always has the newest
        data and the time at which the second message arrived. A reader between the two gets the state at that
        time, with a stamp that is not too old. For a clock, the second entry also has the newest time, because
        the clock ran evenly between the two (see `clock_at`).

        Returns:
            The number of additional bytes; None if there is no message to replace, so that it must be appended.
        """
        run = self._runs.get(content.child_frames)
        if run is None or not run.content.is_repeated_by(content) or stamp_ns - run.since_ns >= _MAX_REPEAT_NS:
            self._runs[content.child_frames] = _Run(stamp_ns, content)
            return None
        index = None if run.second is None else self._find_index(run.second)
        is_clock = content.clock_ns is not None
        if index is None or (is_clock and index != len(self.entries) - 1):
            run.second = number
            self._repeated_numbers.add(number)
            return None
        arrival_ns, number, old_data = self.entries[index]
        self.entries[index] = stamp_ns if is_clock else arrival_ns, number, data
        self.size += len(data) - len(old_data)
        return len(data) - len(old_data)

    def drop(self) -> int:
        """Drop the oldest message, and return the number of freed bytes."""
        oldest = self.entries[self.first_index]
        self.entries[self.first_index] = (oldest[0], oldest[1], b"")
        self.first_index += 1
        self.size -= _compute_stored_size(oldest[2])
        self._repeated_numbers.discard(oldest[1])
        if self.first_index >= _MAX_UNUSED:
            del self.entries[: self.first_index]
            self.first_index = 0
        if self.name == TRANSFORMS:
            return _compute_stored_size(
                oldest[2]
            )  # dropped transforms are not stored, because only the last seconds are useful
        key = deserialize(decompress(oldest[2]), TFMessage).batch.children if self.name == STATIC_TRANSFORMS else None
        replaced_entry = self.before.pop(key, None)
        self.before[key] = oldest
        return 0 if replaced_entry is None else _compute_stored_size(replaced_entry[2])

    def thin(self, bytes_to_free: int) -> int:
        """Drop messages that are close to their neighbors in relation to their age.

        Args:
            bytes_to_free: the number of bytes to free.

        Returns:
            The number of freed bytes.
        """
        kept_entries = self.entries[self.first_index :]
        now_ns = kept_entries[-1][0] + NANOSECONDS_PER_SECOND
        gaps = [
            ((next_entry[0] - previous_entry[0]) / (now_ns - entry[0]), index)
            for index, (previous_entry, entry, next_entry) in enumerate(
                zip(kept_entries, kept_entries[1:], kept_entries[2:], strict=False), 1
            )
        ]
        dropped: set[int] = set()
        freed = 0
        for _, place in sorted(gaps):
            if freed >= bytes_to_free:
                break
            if place - 1 not in dropped and place + 1 not in dropped:
                dropped.add(place)
                freed += _compute_stored_size(kept_entries[place][2])
        self._repeated_numbers.difference_update(kept_entries[place][1] for place in dropped)
        self.entries = [entry for place, entry in enumerate(kept_entries) if place not in dropped]
        self.first_index = 0
        self.size -= freed
        return freed

    def replace(self, number: int, packed: CompressedMessage) -> int:
        """Replace a message with its compressed form, and return the number of freed bytes."""
        index = self._find_index(number)
        if index is None:
            return 0  # the message was dropped in the meantime
        stamp_ns, _, data = self.entries[index]
        self.entries[index] = stamp_ns, number, packed
        self.size -= len(data) - len(packed)
        return len(data) - len(packed)

    def _find_index(self, number: int) -> int | None:
        """Return the index of the message with a number, or None if it was dropped."""
        index = bisect_left(self.entries, number, lo=self.first_index, key=lambda item: item[1])
        return index if index < len(self.entries) and self.entries[index][1] == number else None

    def repeated_after(self, start_ns: int, end_ns: int) -> list[_Entry]:
        """Return the messages in a time interval that also represent equal later messages."""
        return [item for item in self.between(start_ns, end_ns) if item[1] in self._repeated_numbers]

    def repeated_until(self, at_ns: int) -> list[_Entry]:
        """Return the messages whose content is still repeated at a given time.

        For transforms these are all repeated messages; for other topics, the last message if it is repeated.
        """
        repeated = self.repeated_after(at_ns - _MAX_REPEAT_NS, at_ns)
        if self.name == TRANSFORMS:
            return repeated
        return repeated[-1:] if repeated[-1:] == self.until(at_ns, 1) else []

    def until(self, at_ns: int, count: int) -> list[_Entry]:
        """Return the last `count` messages up to a time, or fewer if there are not as many."""
        end = bisect_right(self.entries, (at_ns, sys.maxsize), lo=self.first_index)
        return self.entries[max(self.first_index, end - count) : end]

    def clock_at(self, at_ns: int) -> list[_Entry]:
        """Return the last message of a clock up to a time, in a list.

        The list is empty if there is no message.

        If the message represents several clock messages, the time is interpolated.
        """
        entries = self.until(at_ns, 1)
        next_index = bisect_right(self.entries, (at_ns, sys.maxsize), lo=self.first_index)
        if not entries or next_index == len(self.entries) or self.entries[next_index][1] not in self._repeated_numbers:
            return entries
        (start_ns, number, earlier), (end_ns, _, later) = entries[0], self.entries[next_index]
        return [(at_ns, number, interpolate_clock(earlier, later, (at_ns - start_ns) / (end_ns - start_ns)))]

    def between(self, start_ns: int, end_ns: int) -> list[_Entry]:
        """Return the messages from one time to another, both inclusive."""
        start_index = bisect_left(self.entries, (start_ns,), lo=self.first_index)
        return self.entries[start_index : bisect_right(self.entries, (end_ns, sys.maxsize), lo=self.first_index)]


class _Run:
    """A run of equal messages of a topic: its start time, and the number of its second message.

    The number is None while only one message is stored.
    """

    __slots__ = ("content", "second", "since_ns")

    def __init__(self, since_ns: int, content: Content) -> None:
        self.since_ns = since_ns
        self.content = content
        self.second: int | None = None


class History:
    """A store of the most recent messages, limited to a number of bytes.

    The history can be played while messages are added.

    Messages may be added from any thread. The recorded times never decrease, even if the clock goes back. Large
    messages are compressed if that makes them smaller.

    Args:
        max_bytes: the maximum number of bytes in use; a message that is larger than this is not stored.
        now_ns: returns the current time, in nanoseconds since the epoch.

    Attributes:
        lock: held while a message is added; holding it prevents changes.
        size: the number of bytes in use.
        count: the number of messages that were ever added.
    """

    def __init__(self, max_bytes: int, now_ns: Callable[[], int]) -> None:
        self.max_bytes = max_bytes
        self.lock = threading.RLock()
        self.size = 0
        self.count = 0
        self._now_ns = now_ns
        self._newest_ns = 0
        self._tracks: dict[str, _Track] = {}
        self._queue_by_oldest: list[tuple[int, str, _Track]] = []
        self._largest_track: _Track | None = None
        self._clock_ns = 0
        self._changes = 0
        self._shrinker = Shrinker(self._replace)

    def add(self, topic: str, data: bytes, at_ns: int | None = None, content: Content | None = None) -> None:
        """Add a message.

        Args:
            topic: the name of the topic.
            data: the serialized message.
            at_ns: the reception time; None for the current time. A time before the newest message's is replaced
                by the newest message's time.
            content: the content of the message (see `stillness`), so that a message that only repeats earlier ones
                needs no additional memory; None if the content is not compared.
        """
        size = _compute_stored_size(data)
        if size > self.max_bytes:
            return
        with self.lock:
            self._newest_ns = max(self._newest_ns, self._now_ns() if at_ns is None else at_ns)
            track = self._tracks.get(topic)
            if track is None:
                track = self._tracks[topic] = _Track(topic)
            if content is not None and content.clock_ns is not None:
                content = self._make_comparable_clock(content, content.clock_ns)
            added_bytes = None if content is None else track.repeat(self._newest_ns, self.count, data, content)
            if added_bytes is not None:
                self.size += added_bytes
                return
            track.append(self._newest_ns, self.count, data)
            if content is None or content.clock_ns is None:
                self._changes += 1
            self._queue(track)
            if self._largest_track is None or track.size > self._largest_track.size:
                self._largest_track = track
            self.count += 1
            self.size += size
            while self.size > self.max_bytes and self._free_memory():
                pass
            number = self.count - 1
        self._shrinker.offer((track, number), data)

    def close(self) -> None:
        """Stop compressing.

        The stored messages remain available.
        """
        self._shrinker.close()

    def _make_comparable_clock(self, content: Content, clock_ns: int) -> Content:
        """Return the content of a clock message for comparison with earlier ones.

        The state in it decides whether the message repeats an earlier one.

        Clock messages count as repeated while no other message arrives and the clock is not reset.
        """
        if clock_ns < self._clock_ns:
            self._changes += 1
        self._clock_ns = clock_ns
        return content._replace(state=b"%d" % self._changes)

    def _free_memory(self) -> bool:
        """Thin out large messages, or drop the oldest message.

        Return False if nothing could be freed.
        """
        largest = self._largest_track
        if largest is not None and largest.size > self.max_bytes // 2 and largest.can_be_thinned:
            freed = largest.thin(self.max_bytes // _FREED_DIVISOR)
            self.size -= freed
            return freed > 0
        oldest = self._find_oldest_track()
        if oldest is None:
            return False
        self.size -= oldest.drop()
        return True

    def _queue(self, track: _Track) -> None:
        """Add a track to the queue.

        The queue is ordered by the oldest message of each track.
        """
        if not track.is_queued and len(track) > 0:
            track.is_queued = True
            heappush(self._queue_by_oldest, (track.entries[track.first_index][1], track.name, track))

    def _find_oldest_track(self) -> _Track | None:
        """Return the track with the oldest message, or None if there are no messages."""
        while self._queue_by_oldest:
            number, _, track = self._queue_by_oldest[0]
            if len(track) > 0 and track.entries[track.first_index][1] == number:
                return track
            heappop(self._queue_by_oldest)
            track.is_queued = False
            self._queue(track)
        return None

    def _replace(self, key: tuple[_Track, int], packed: CompressedMessage) -> None:
        track, number = key
        with self.lock:
            self.size -= track.replace(number, packed)

    @property
    def start_ns(self) -> int:
        """The time of the oldest message, in ns since the epoch.

        If there is no message, this is the current time.
        """
        with self.lock:
            oldest = self._find_oldest_track()
            return self.end_ns if oldest is None else oldest.entries[oldest.first_index][0]

    @property
    def end_ns(self) -> int:
        """The current time, in ns since the epoch, because a topic's last message remains valid."""
        return max(self._newest_ns, self._now_ns())

    def messages(self, topics: Collection[str], start_ns: int) -> Iterator[Recorded]:
        """Yield the messages of topics that were received at or after a time.

        When the iterator is exhausted, it can continue after new messages have arrived.
        """
        return _LiveIterator(self, topics, start_ns)

    def state_at(self, topics: Collection[str], at_ns: int) -> list[Recorded]:
        """Return the last message of each topic up to a time.

        For ``/tf``, the result has the messages of the last two seconds; for ``/tf_static``, all messages.
        """
        static: list[Recorded] = []
        recent: list[Recorded] = []
        with self.lock:
            for name in topics:
                track = self._tracks.get(name)
                if track is None:
                    continue
                if name == TRANSFORMS:
                    near_ns = at_ns - TRANSFORMS_NS
                    entries = track.repeated_after(near_ns - _MAX_REPEAT_NS, near_ns - 1) + track.between(
                        near_ns, at_ns
                    )
                else:
                    count = sys.maxsize if name == STATIC_TRANSFORMS else 1
                    entries = track.clock_at(at_ns) if name == CLOCK_TOPIC else track.until(at_ns, count)
                    dropped_states = [item for item in track.before.values() if item[0] <= at_ns]
                    if name == STATIC_TRANSFORMS:
                        entries = dropped_states + entries
                    entries = entries or dropped_states
                target = static if name == STATIC_TRANSFORMS else recent
                target += [(name, stamp, decompress(data)) for stamp, _, data in entries]
        return static + sorted(recent, key=lambda item: item[1])

    def time_before(self, topics: Collection[str], at_ns: int) -> int | None:
        """Return the reception time of the last message before a time, or None.

        Times are in nanoseconds since the epoch.
        """
        with self.lock:
            last_entries = [self._tracks[name].until(at_ns - 1, 1) for name in topics if name in self._tracks]
            return max((item[0][0] for item in last_entries if item), default=None)

    def messages_between(self, start_ns: int, end_ns: int) -> list[Recorded]:
        """Return the messages from one time to another, both inclusive, ordered by time.

        The result begins with the state at the start (see `state_at`); the times of its messages are set to the
        start. It ends with the messages that are still repeated at the end. Compressed messages stay
        compressed, because together they could be too large (see `decompress`).
        """
        with self.lock:
            initial_state = self.state_at(list(self._tracks), start_ns - 1)
            received = [
                (name, *item) for name, track in self._tracks.items() for item in track.between(start_ns, end_ns)
            ]
            repeated = [
                (name, item[2]) for name, track in self._tracks.items() for item in track.repeated_until(end_ns)
            ]
        received.sort(key=lambda item: item[2])
        return [
            *((name, start_ns, data) for name, _, data in initial_state),
            *((name, stamp_ns, data) for name, stamp_ns, _, data in received),
            *((name, end_ns, data) for name, data in repeated),
        ]

    def after(self, topics: Collection[str], start_ns: int, number: int) -> tuple[int, Recorded] | None:
        """Return the first message of topics at or after a time, and its number, or None.

        Messages with a number below `number` are skipped.
        """
        best: tuple[_Entry, str] | None = None
        with self.lock:
            for name in topics:
                track = self._tracks.get(name)
                if track is None:
                    continue
                index = bisect_left(track.entries, (start_ns, number), lo=track.first_index)
                if index < len(track.entries) and (best is None or track.entries[index][:2] < best[0][:2]):
                    best = track.entries[index], name
        if best is None:
            return None
        (stamp, found_number, data), name = best
        return found_number, (name, stamp, decompress(data))


class _LiveIterator(Iterator[Recorded]):
    """An iterator over the messages of a history in order of time.

    When it is exhausted, it can continue after new messages have arrived.
    """

    def __init__(self, history: History, topics: Collection[str], start_ns: int) -> None:
        self._history = history
        self._topics = topics
        self._start_ns = start_ns
        self._number = 0

    def __next__(self) -> Recorded:
        numbered_message = self._history.after(self._topics, self._start_ns, self._number)
        if numbered_message is None:
            raise StopIteration
        number, recorded = numbered_message
        self._start_ns, self._number = recorded[1], number + 1
        return recorded


def _compute_stored_size(data: bytes) -> int:
    return len(data) + _OVERHEAD_BYTES
