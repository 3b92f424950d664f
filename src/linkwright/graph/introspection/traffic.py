"""The rate and bandwidth of a topic, measured over its most recent messages."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND


@dataclass(frozen=True, slots=True)
class Traffic:
    """Statistics of the most recent messages of a topic.

    Attributes:
        messages_per_second: the message rate.
        bytes_per_second: the bandwidth.
        mean_size: the mean message size, in bytes.
        min_size: the size of the smallest message, in bytes.
        max_size: the size of the largest message, in bytes.
        count: the number of messages in the statistics.
        age_ns: the age of the oldest message in the statistics, in nanoseconds.
    """

    messages_per_second: float
    bytes_per_second: float
    mean_size: float
    min_size: int
    max_size: int
    count: int
    age_ns: int


class TrafficWindow:
    """A window over the sizes and arrival times of the most recent messages of a topic.

    Args:
        size: the maximum number of messages.
        max_age_ns: the maximum age of the messages, in nanoseconds; None for no limit. The last two messages are always
            kept, so that statistics also exist for slow topics.
    """

    def __init__(self, size: int, max_age_ns: int | None = None) -> None:
        self._messages: deque[tuple[int, int]] = deque(maxlen=size)
        self._max_age_ns = max_age_ns

    def add(self, now_ns: int, size: int) -> None:
        """Add a message of `size` bytes that arrived at `now_ns`."""
        self._messages.append((now_ns, size))

    def measure(self, now_ns: int) -> Traffic | None:
        """Return the statistics, or None while there are fewer than two messages.

        As in ``ros2 topic bw``, the bandwidth is averaged from the first message until now, so it decreases when no
        more messages arrive. The rate is averaged from the first message to the last one, or until now if the
        last message is older than twice the mean interval.
        """
        messages = self._messages
        if self._max_age_ns is not None:
            while len(messages) > 2 and now_ns - messages[0][0] > self._max_age_ns:
                messages.popleft()
        if len(messages) < 2:
            return None
        first_ns, last_ns = messages[0][0], messages[-1][0]
        if now_ns <= first_ns:
            messages.clear()
            return None
        sizes = [size for _, size in messages]
        interval_count = len(sizes) - 1
        is_silent = now_ns - last_ns > 2 * (last_ns - first_ns) / interval_count or last_ns == first_ns
        span_ns = (now_ns if is_silent else last_ns) - first_ns
        return Traffic(
            messages_per_second=interval_count * NANOSECONDS_PER_SECOND / span_ns,
            bytes_per_second=sum(sizes) * NANOSECONDS_PER_SECOND / (now_ns - first_ns),
            mean_size=sum(sizes) / len(sizes),
            min_size=min(sizes),
            max_size=max(sizes),
            count=len(sizes),
            age_ns=now_ns - first_ns,
        )
