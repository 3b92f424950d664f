"""The rate and bandwidth of a topic over its last messages."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND


@dataclass(frozen=True, slots=True)
class Traffic:
    """Statistics of the last messages of a topic.

    Attributes:
        messages_per_second: how many come in a second.
        bytes_per_second: how many bytes come in a second.
        mean_size: the average size of a message, bytes.
        least_size: that of the smallest.
        most_size: that of the largest.
        count: over how many messages this is.
        age_ns: the age of the first of them, nanoseconds.
    """

    messages_per_second: float
    bytes_per_second: float
    mean_size: float
    least_size: int
    most_size: int
    count: int
    age_ns: int


class TrafficWindow:
    """The sizes of the last messages of a topic, and their times of arrival.

    Args:
        size: how many are kept at most.
        longest_ns: how old they may become, nanoseconds; the last two are always kept, so that a slow topic has figures
            too. None for any age.
    """

    def __init__(self, size: int, longest_ns: int | None = None) -> None:
        self._messages: deque[tuple[int, int]] = deque(maxlen=size)
        self._longest_ns = longest_ns

    def add(self, now_ns: int, size: int) -> None:
        """Count a message of `size` bytes."""
        self._messages.append((now_ns, size))

    def traffic(self, now_ns: int) -> Traffic | None:
        """The figures; None while there are fewer than two messages.

        Bytes are counted from the first message until now, as ``ros2 topic bw`` does, and so become fewer when the
        topic falls silent. Messages are counted from the first to the last, until the silence is longer than twice
        their usual distance.
        """
        messages = self._messages
        if self._longest_ns is not None:
            while len(messages) > 2 and now_ns - messages[0][0] > self._longest_ns:
                messages.popleft()
        if len(messages) < 2:
            return None
        first, last = messages[0][0], messages[-1][0]
        if now_ns <= first:
            messages.clear()
            return None
        sizes = [size for _, size in messages]
        intervals = len(sizes) - 1
        silent = now_ns - last > 2 * (last - first) / intervals or last == first
        span = (now_ns if silent else last) - first
        return Traffic(
            messages_per_second=intervals * NANOSECONDS_PER_SECOND / span,
            bytes_per_second=sum(sizes) * NANOSECONDS_PER_SECOND / (now_ns - first),
            mean_size=sum(sizes) / len(sizes),
            least_size=min(sizes),
            most_size=max(sizes),
            count=len(sizes),
            age_ns=now_ns - first,
        )
