"""The statistics of ``topic hz``, ``topic delay`` and ``topic bw``, and their output."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from linkwright.graph.introspection.traffic import TrafficWindow
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND


@dataclass(frozen=True, slots=True)
class Spread:
    """The statistics of a window of durations, in nanoseconds.

    Attributes:
        mean: the average duration.
        minimum: the shortest duration.
        maximum: the longest duration.
        deviation: the standard deviation.
        count: the number of durations.
    """

    mean: float
    minimum: float
    maximum: float
    deviation: float
    count: int

    @classmethod
    def of(cls, durations: Iterable[float]) -> Spread:
        """Compute the statistics of at least one duration in nanoseconds."""
        values = list(durations)
        mean = sum(values) / len(values)
        deviation = math.sqrt(sum((value - mean) ** 2 for value in values) / len(values))
        return cls(mean, min(values), max(values), deviation, len(values))

    @property
    def rate(self) -> float:
        """The rate in hertz, if the durations are the times between messages."""
        return NANOSECONDS_PER_SECOND / self.mean if self.mean > 0 else 0.0

    def format_bounds(self) -> str:
        """Return the line of ``topic hz`` and ``topic delay`` with minimum, maximum and deviation."""
        return (
            f"\tmin: {self.minimum / NANOSECONDS_PER_SECOND:.3f}s max: {self.maximum / NANOSECONDS_PER_SECOND:.3f}s "
            f"std dev: {self.deviation / NANOSECONDS_PER_SECOND:.5f}s window: {self.count}"
        )


class RateWindow:
    """The times between the most recent messages of a topic.

    Args:
        size: the number of messages in the window.
    """

    def __init__(self, size: int) -> None:
        self._times: deque[int] = deque(maxlen=size)
        self._last_time_ns: int | None = None
        self._has_new_message = False

    def add(self, now_ns: int) -> bool:
        """Add the arrival of a message.

        Returns:
            Whether the time jumped back, which resets the window.
        """
        previous_ns, self._last_time_ns, self._has_new_message = self._last_time_ns, now_ns, True
        if previous_ns is None:
            return False
        if now_ns < previous_ns:
            self._times.clear()
            return True
        self._times.append(now_ns - previous_ns)
        return False

    def pop_spread(self) -> Spread | None:
        """Return the statistics, or None if no message arrived since the last call."""
        if not self._has_new_message or not self._times:
            return None
        self._has_new_message = False
        return Spread.of(self._times)


class DelayWindow:
    """The delays of the most recent messages of a topic.

    Args:
        size: the number of messages in the window.
    """

    def __init__(self, size: int) -> None:
        self._delays: deque[int] = deque(maxlen=size)
        self._last_time_ns: int | None = None
        self._has_new_message = False

    def add(self, now_ns: int, stamp_ns: int) -> None:
        """Add the delay of a message, from its stamp to its arrival."""
        if self._last_time_ns is not None and now_ns < self._last_time_ns:
            self._delays.clear()
        self._last_time_ns, self._has_new_message = now_ns, True
        self._delays.append(now_ns - stamp_ns)

    def format_report(self) -> str | None:
        """Return the output of ``topic delay``, or None before the first message."""
        if not self._delays:
            return None
        if not self._has_new_message:
            return "no new messages"
        self._has_new_message = False
        spread = Spread.of(self._delays)
        return f"average delay: {spread.mean / NANOSECONDS_PER_SECOND:.3f}\n{spread.format_bounds()}"


class BandwidthWindow(TrafficWindow):
    """The sizes of the most recent messages of a topic, for ``topic bw``."""

    def format_report(self, now_ns: int) -> str | None:
        """Return the output of ``topic bw``, or None if fewer than two messages have arrived."""
        traffic = self.measure(now_ns)
        if traffic is None:
            return None
        size_text = _create_size_formatter(traffic.bytes_per_second)
        sizes = {"mean": traffic.mean_size, "min": traffic.min_size, "max": traffic.max_size}
        figures = " ".join(f"{name}: {size_text(value)}" for name, value in sizes.items())
        return f"{size_text(traffic.bytes_per_second)}/s from {traffic.count} messages\n\tMessage size {figures}"


def _create_size_formatter(bytes_per_second: float) -> Callable[[float], str]:
    """Return a function that formats byte counts as ros2 does, in the unit for a bandwidth."""
    scale, digits, name = next(unit for limit, unit in _UNITS if bytes_per_second < limit)
    return lambda size: f"{size / scale:.{digits}f} {name}"


_UNITS = ((1e3, (1.0, 0, "B")), (1e6, (1e3, 2, "KB")), (math.inf, (1e6, 2, "MB")))


def format_rate(spread: Spread) -> str:
    """Return the output of ``topic hz`` for one topic."""
    return f"average rate: {spread.rate:.3f}\n{spread.format_bounds()}"


_COLUMN_NAMES = ("topic", "rate", "min_delta", "max_delta", "stddev", "window")


def format_rate_table(spreads: Mapping[str, Spread]) -> str:
    """Return the output of ``topic hz`` for several topics, as a table."""
    rows = [
        (
            topic,
            f"{spread.rate:.3f}",
            f"{spread.minimum / NANOSECONDS_PER_SECOND:.3f}",
            f"{spread.maximum / NANOSECONDS_PER_SECOND:.3f}",
            f"{spread.deviation / NANOSECONDS_PER_SECOND:.5f}",
            str(spread.count),
        )
        for topic, spread in spreads.items()
    ]
    widths = [max(len(name), *(len(row[column]) for row in rows)) for column, name in enumerate(_COLUMN_NAMES)]
    header_line = "   ".join(name.center(width + 2) for name, width in zip(_COLUMN_NAMES, widths, strict=True))
    separator_line = "=" * (sum(widths) + 3 * (len(_COLUMN_NAMES) - 1))
    body_lines = ["   ".join(cell.ljust(width + 2) for cell, width in zip(row, widths, strict=True)) for row in rows]
    return "\n".join([header_line, separator_line, *body_lines, ""])
