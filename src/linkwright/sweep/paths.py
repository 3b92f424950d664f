"""The paths of robots in the runs of a sweep: recorded, or returned by a scenario."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from linkwright.testing.paths import MAX_POINTS, Point

ROBOT_NAME = "robot"
"""The name of a recorded path. The second path of a run is called ``robot 2``."""

TimedPath = Sequence[Point]
"""The points of a path in the order of their times."""


def parse_path(value: object) -> TimedPath | None:
    """Return a result that is a path, or None if it is another value.

    Args:
        value: a list or array of rows of time, x and y in s and m, whose times increase.
    """
    if not isinstance(value, (Sequence, np.ndarray)) or isinstance(value, (str, bytes)):
        return None
    try:
        rows = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        return None
    if rows.ndim != 2 or rows.shape[1] != 3 or not np.isfinite(rows).all() or not (np.diff(rows[:, 0]) > 0).all():
        return None
    return _thin_out(rows.tolist())


def name_recorded_paths(points: Sequence[TimedPath]) -> dict[str, TimedPath]:
    """Return the paths that were recorded during a run, by name."""
    moving = [path for path in points if path]
    return {
        ROBOT_NAME if number == 1 else f"{ROBOT_NAME} {number}": path for number, path in enumerate(moving, start=1)
    }


def _thin_out(rows: list[Any]) -> TimedPath:
    stride = max(1, math.ceil(len(rows) / MAX_POINTS))
    points = [(row[0], row[1], row[2]) for row in rows[::stride]]
    return [*points, tuple(rows[-1])] if (len(rows) - 1) % stride else points
