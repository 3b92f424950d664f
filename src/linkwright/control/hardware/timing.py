"""Statistics of the durations (in microseconds) and rates (in Hz) of cycles.

Source: the statistics of ros2_control's controller manager (selection and names).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import inf, nan, sqrt
from time import perf_counter_ns


class _Statistics:
    """The statistics of a measured quantity."""

    def __init__(self) -> None:
        self._count = 0
        self._mean = self._squared_deviations = 0.0
        self._minimum, self._maximum, self._latest = inf, -inf, nan

    def add(self, value: float) -> None:
        """Update the statistics with a value."""
        self._count += 1
        deviation = value - self._mean
        self._mean += deviation / self._count
        self._squared_deviations += deviation * (value - self._mean)
        self._minimum, self._maximum, self._latest = min(self._minimum, value), max(self._maximum, value), value

    def items(self) -> Iterator[tuple[str, float]]:
        """Yield the names and values of the statistics.

        Before the first value, all statistics except the count are NaN.
        """
        has_values = self._count > 0
        yield "average", self._mean if has_values else nan
        yield "min", self._minimum if has_values else nan
        yield "max", self._maximum if has_values else nan
        yield "standard_deviation", sqrt(self._squared_deviations / self._count) if has_values else nan
        yield "sample_count", float(self._count)
        yield "current_value", self._latest


class Timing:
    """The durations and the rate of an activity that is performed in each cycle."""

    def __init__(self) -> None:
        self._execution, self._periodicity = _Statistics(), _Statistics()
        self._last_time_ns = 0

    def measure(self, work: Callable[[int, float], object], time_ns: int, period_s: float) -> None:
        """Call a function, and measure its duration.

        Args:
            work: the function, called with the other two arguments.
            time_ns: the time, in nanoseconds.
            period_s: the time since the last cycle, in seconds.
        """
        last_time_ns, self._last_time_ns = self._last_time_ns, time_ns
        if 0 < last_time_ns < time_ns:
            self._periodicity.add(1e9 / (time_ns - last_time_ns))
        start_ns = perf_counter_ns()
        try:
            work(time_ns, period_s)
        finally:
            self._execution.add((perf_counter_ns() - start_ns) / 1e3)

    def items(self) -> Iterator[tuple[str, float]]:
        """Yield the names and values of the statistics."""
        for kind, statistics in (("execution_time", self._execution), ("periodicity", self._periodicity)):
            for name, value in statistics.items():
                yield f"{kind}/{name}", value
