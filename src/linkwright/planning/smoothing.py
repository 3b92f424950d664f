"""Trajectories whose splines keep the limits of velocity and acceleration, and of jerk.

The fastest trajectory changes its acceleration at once. The splines that controllers execute cannot: an acceleration
that jumps between two points, however near they are, is exceeded by up to 74 %. A moving average over a time T removes
the jumps. It keeps the limits of velocity and acceleration, because each average of values within a limit is within it.
The jerk is the difference of two accelerations divided by T, so that it is at most ``2 a / T``. The corners of the path
are rounded a little more. MoveIt obeys ``max_jerk`` by Ruckig.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.planning.splines import slow_to_limits
from linkwright.planning.timing import MaxPathSpeeds, Trajectory, parameterize

_ACCELERATION_SHARES = (1.0, 0.5, 0.25, 0.125)
"""The shares of the maximum acceleration that are tried, because a smaller one allows a shorter average."""
_FINE_STEPS = 50
"""The number of intervals of the averaged trajectory in the time of the average."""
_MAX_FINE_INTERVAL_S = 0.002
_MARGIN = 0.99
"""The share of the limits of jerk that is used, because accelerations are exceeded a little between two points."""
_STEPS = 4
"""The minimum number of points of the result in the time of the average."""
_WINDOW_SHARE = 0.05
"""The time of the average without limits of jerk, as a share of the duration."""
_WINDOW_RANGE_S = (0.02, 0.1)
"""The minimum and the maximum of that time in s."""
_MIN_TURN = 1e-4
"""The angle in rad between two lines up to which the motion does not stop between them."""


def parameterize_smoothly(
    corners: Array,
    max_velocities: Array,
    max_accelerations: Array,
    max_jerks: Array,
    *,
    max_deviation: float = 0.1,
    interval_s: float = 0.1,
    max_path_speeds: MaxPathSpeeds | None = None,
) -> Trajectory:
    """Return a fast trajectory along a path that starts and ends at rest, and whose splines keep all limits.

    Args:
        corners: the corners of the path, shape (n, joints).
        max_velocities: in rad/s or m/s, shape (joints,), or (n - 1, joints) for limits that differ between corners.
        max_accelerations: in rad/s2 or m/s2, of the same shape.
        max_jerks: in rad/s3 or m/s3, shape (joints,); infinite for joints without a limit.
        max_deviation: the maximum distance from a corner before the average, in rad or m over all joints; 0 to stop
            at each corner, which then stays exact.
        interval_s: the maximum time in s between two points of the trajectory.
        max_path_speeds: an additional limit of the speed along the path, which the average may exceed a little.
    """
    shape = (len(corners) - 1, corners.shape[1])
    max_velocities, max_accelerations = (np.broadcast_to(rows, shape) for rows in (max_velocities, max_accelerations))
    if max_deviation <= 0.0 and len(ranges := _straight_ranges(corners)) > 1:
        pieces = [
            parameterize_smoothly(
                corners[first : last + 1],
                max_velocities[first:last],
                max_accelerations[first:last],
                max_jerks,
                interval_s=interval_s,
                max_path_speeds=max_path_speeds,
            )
            for first, last in ranges
        ]
        return join(pieces)
    trials = []
    for share in _ACCELERATION_SHARES:
        accelerations = share * max_accelerations
        jerk_window_s = float(np.max(2.0 * accelerations / (_MARGIN * max_jerks), initial=0.0))
        parameterize_finely = partial(
            parameterize,
            corners,
            max_velocities,
            accelerations,
            max_deviation=max_deviation,
            max_path_speeds=max_path_speeds,
        )
        fine = parameterize_finely(interval_s=_MAX_FINE_INTERVAL_S)
        window_s = max(jerk_window_s, float(np.clip(_WINDOW_SHARE * fine.duration, *_WINDOW_RANGE_S)))
        trials.append((fine.duration + window_s, window_s, fine, parameterize_finely))
        if window_s > jerk_window_s:  # The limits of jerk cost no time.
            break
    _, window_s, fine, parameterize_finely = min(trials, key=lambda trial: trial[0])
    if jerk_window_s and window_s / _FINE_STEPS < _MAX_FINE_INTERVAL_S:
        fine = parameterize_finely(interval_s=window_s / _FINE_STEPS)
    if not fine.duration:
        return fine
    averaged = _average(fine, window_s, interval_s)
    return slow_to_limits(averaged, max_velocities.max(axis=0), max_accelerations.max(axis=0), max_jerks)


def _straight_ranges(corners: Array) -> list[tuple[int, int]]:
    """Return the first and the last corner of each straight line of a path."""
    moves = np.diff(corners, axis=0)
    lengths = np.linalg.norm(moves, axis=1)
    moving = np.flatnonzero(lengths)
    directions = moves[moving] / lengths[moving, None]
    turns = np.flatnonzero(np.linalg.norm(np.diff(directions, axis=0), axis=1) > _MIN_TURN)
    return list(pairwise((0, *moving[turns + 1].tolist(), len(corners) - 1)))


def _average(trajectory: Trajectory, window_s: float, interval_s: float) -> Trajectory:
    """Return the moving average of a trajectory, which rests before its start and after its end.

    Args:
        trajectory: the trajectory, with many points in each window.
        window_s: the time in s of the average.
        interval_s: the maximum time in s between two points of the result.
    """
    widths = np.diff(trajectory.times)[:, None]
    positions, velocities = trajectory.positions, trajectory.velocities
    areas = widths * (positions[1:] + positions[:-1]) / 2.0 - widths**2 * np.diff(velocities, axis=0) / 12.0
    sums = np.concatenate((np.zeros((1, positions.shape[1])), np.cumsum(areas, axis=0)))
    integral = replace(trajectory, positions=sums, velocities=positions, accelerations=velocities)
    duration = trajectory.duration + window_s
    count = int(np.ceil(duration / min(interval_s, window_s / _STEPS))) + 1
    times = np.linspace(0.0, duration, count, dtype=np.float64)
    before, after = (_evaluate(integral, ends) for ends in (times - window_s, times))
    return Trajectory(times, *((late - early) / window_s for early, late in zip(before, after, strict=True)))


def _evaluate(integral: Trajectory, times: Array) -> tuple[Array, Array, Array]:
    """Return the integral of a trajectory, its positions and its velocities, also before its start and after its end.

    Each has the shape (n, joints).
    """
    sums, positions, velocities = integral.interpolate(times)
    outside = times - np.clip(times, 0.0, integral.duration)
    return sums + outside[:, None] * positions, positions, velocities


def join(pieces: Sequence[Trajectory]) -> Trajectory:
    """Return a trajectory that executes others one after the other."""
    starts = np.cumsum([0.0, *(piece.duration for piece in pieces[:-1])])
    times = [pieces[0].times, *(start + piece.times[1:] for start, piece in zip(starts[1:], pieces[1:], strict=True))]
    rest = [
        np.concatenate((getattr(pieces[0], name), *(getattr(piece, name)[1:] for piece in pieces[1:])))
        for name in ("positions", "velocities", "accelerations")
    ]
    return Trajectory(np.concatenate(times), *rest)
