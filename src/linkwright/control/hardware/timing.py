"""Statistics of the durations (in microseconds) and rates (in Hz) of cycles.

Source: the statistics of ros2_control's controller manager (their selection and names).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import inf, nan, sqrt
from time import perf_counter_ns


class _Statistics:
    """The statistics of a measured quantity."""

    def __init__(self) -> None:
        self._count = 0
        self._mean = self._squares = 0.0
        self._least, self._most, self._last = inf, -inf, nan

    def add(self, value: float) -> None:
        """Update the statistics with a value."""
        self._count += 1
        before = value - self._mean
        self._mean += before / self._count
        self._squares += before * (value - self._mean)
        self._least, self._most, self._last = min(self._least, value), max(self._most, value), value

    def items(self) -> Iterator[tuple[str, float]]:
        """Iterate over the names and values of the statistics; without values, they are NaN."""
        known = self._count > 0
        yield "average", self._mean if known else nan
        yield "min", self._least if known else nan
        yield "max", self._most if known else nan
        yield "standard_deviation", sqrt(self._squares / self._count) if known else nan
        yield "sample_count", float(self._count)
        yield "current_value", self._last


class Timing:
    """The durations and the rate of an activity that is performed in each cycle."""

    def __init__(self) -> None:
        self._execution, self._periodicity = _Statistics(), _Statistics()
        self._before_ns = 0

    def measure(self, work: Callable[[int, float], object], time_ns: int, period_s: float) -> None:
        """Call a function, and measure its duration.

        Args:
            work: the function, called with the other two arguments.
            time_ns: the time, in nanoseconds.
            period_s: the time since the last cycle, in seconds.
        """
        before_ns, self._before_ns = self._before_ns, time_ns
        if 0 < before_ns < time_ns:
            self._periodicity.add(1e9 / (time_ns - before_ns))
        began = perf_counter_ns()
        try:
            work(time_ns, period_s)
        finally:
            self._execution.add((perf_counter_ns() - began) / 1e3)

    def items(self) -> Iterator[tuple[str, float]]:
        """Iterate over the names and values of the statistics."""
        for kind, measured in (("execution_time", self._execution), ("periodicity", self._periodicity)):
            for name, value in measured.items():
                yield f"{kind}/{name}", value
