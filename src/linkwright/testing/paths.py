"""The paths of robots in simulated worlds, recorded while a function runs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_INITIAL_PERIOD_NS = NANOSECONDS_PER_SECOND // 20
MAX_POINTS = 2_000
"""The maximum number of points. For a longer path, every second point is dropped and the period is doubled."""

Point = tuple[float, float, float]
"""A point of a path: the time since its start in s, and the position x and y in m."""


class RobotPath:
    """The true path of a robot as seen from above, with a point in each period.

    Attributes:
        points: the recorded positions, in the order of time.
    """

    def __init__(self) -> None:
        self.points: list[Point] = []
        self._period_ns = _INITIAL_PERIOD_NS
        self._start_ns = 0
        self._next_ns: int | None = None

    def is_due(self, time_ns: int) -> bool:
        """Return whether the next point is due at a time."""
        return self._next_ns is None or time_ns >= self._next_ns

    def add(self, time_ns: int, x: float, y: float) -> None:
        """Add a point.

        Args:
            time_ns: the time, which must be later than that of the last point.
            x: the position in m.
            y: the position in m.
        """
        if self._next_ns is None:
            self._start_ns = time_ns
        self.points.append(((time_ns - self._start_ns) / NANOSECONDS_PER_SECOND, x, y))
        if len(self.points) > MAX_POINTS:
            del self.points[1::2]
            self._period_ns *= 2
        self._next_ns = time_ns + self._period_ns


_recorded_paths: ContextVar[list[RobotPath] | None] = ContextVar("recorded_paths", default=None)


@contextmanager
def record_paths() -> Iterator[list[RobotPath]]:
    """Record the paths of the robots in simulations that start in the ``with`` block.

    The simulations are `SteppedSimulation` objects.

    Yields:
        A list that is filled during the block, in the order in which the paths start: one path for each simulation
        with a robot, and one more after each reset.
    """
    paths: list[RobotPath] = []
    token = _recorded_paths.set(paths)
    try:
        yield paths
    finally:
        _recorded_paths.reset(token)


def start_path() -> RobotPath | None:
    """Start the path of a robot, and return it, or None if no paths are being recorded."""
    paths = _recorded_paths.get()
    if paths is None:
        return None
    path = RobotPath()
    paths.append(path)
    return path
