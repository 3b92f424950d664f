"""Smoothing of paths, which moves points towards the middle of their neighbours.

Points stay near their original positions.

Source: nav2_smoother ``SimpleSmoother``: its iteration converges to the solution of a tridiagonal linear system, which
is solved directly here. Points that would move into an obstacle keep their positions.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.costmaps.costmap import MAX_PASSABLE, UNKNOWN, Costmap
from linkwright.navigation.grids.library import load_scipy

Points = NDArray[np.float64]

_LEAST_POINTS: Final = 3


@dataclass(frozen=True, kw_only=True)
class Smoothing:
    """Settings of the smoother, with nav2's names and defaults.

    Attributes:
        w_data: the weight of a point's original position.
        w_smooth: the weight of the middle of the point's neighbours.
        do_refinement: whether to smooth the result again.
        refinement_num: the number of refinements.
        enforce_path_inversion: whether points at which the robot reverses direction are fixed.
    """

    w_data: float = 0.2
    w_smooth: float = 0.3
    do_refinement: bool = True
    refinement_num: int = 2
    enforce_path_inversion: bool = True


def smoothed(points: Points, smoothing: Smoothing, costmap: Costmap | None = None) -> tuple[Points, bool]:
    """Smooth a path.

    Args:
        points: x and y in the frame of the costmap, in metres, of shape (n, 2).
        smoothing: the settings of the smoother.
        costmap: the costmap whose obstacles are avoided; None for no obstacles.

    Returns:
        The smoothed points, of the same shape, with the same first and last one; and whether no point was held back by
        an obstacle.
    """
    found, complete = points, True
    rounds = 1 + (smoothing.refinement_num if smoothing.do_refinement else 0)
    fixed = _fixed(points, smoothing)
    for _ in range(rounds):
        found, all_moved = _once(found, fixed, smoothing, costmap)
        complete &= all_moved
    return found, complete


def directions(points: Points, last: float) -> NDArray[np.float64]:
    """Return the yaw from each point of a path to the next one, in radians, of shape (n,).

    The yaw of the last point is `last`.
    """
    ahead = np.diff(points, axis=0)
    return np.append(np.arctan2(ahead[:, 1], ahead[:, 0]), last)


def _fixed(points: Points, smoothing: Smoothing) -> NDArray[np.bool_]:
    """Return a mask of the fixed points: the ends, and reversals if they are enforced."""
    fixed = np.zeros(len(points), np.bool_)
    fixed[[0, -1]] = True
    if smoothing.enforce_path_inversion and len(points) >= _LEAST_POINTS:
        ahead = np.diff(points, axis=0)
        fixed[1:-1] |= (ahead[:-1] * ahead[1:]).sum(axis=1) < 0.0
    return fixed


def _once(
    points: Points, fixed: NDArray[np.bool_], smoothing: Smoothing, costmap: Costmap | None
) -> tuple[Points, bool]:
    if len(points) < _LEAST_POINTS:
        return points, True
    stays = fixed.copy()
    while True:
        found = _solve_equilibrium(points, stays, smoothing)
        if costmap is None:
            return found, True
        bad = _blocked(found, costmap) & ~stays
        if not bad.any():
            return found, not (stays & ~fixed).any()
        stays |= bad


def _blocked(points: Points, costmap: Costmap) -> NDArray[np.bool_]:
    """Return a mask of the points that collide, or have a colliding midpoint to a neighbour."""
    middles = (points + np.roll(points, -1, axis=0)) / 2.0
    middles[-1] = points[-1]

    def barred(places: Points) -> NDArray[np.bool_]:
        costs = costmap.cost_at(places)
        return np.asarray((costs > MAX_PASSABLE) & (costs != UNKNOWN))

    blocked = barred(points)
    between = barred(middles)
    blocked |= between
    blocked[1:] |= between[:-1]
    return blocked


def _solve_equilibrium(points: Points, stays: NDArray[np.bool_], smoothing: Smoothing) -> Points:
    """Return the points y that solve w_data (y - x) = w_smooth (previous + next - 2 y).

    Points in the mask `stays` keep their positions x.
    """
    beside = np.where(stays, 0.0, -smoothing.w_smooth)
    bands = np.zeros((3, len(points)))
    bands[0, 1:] = beside[:-1]
    bands[1] = np.where(stays, 1.0, smoothing.w_data + 2.0 * smoothing.w_smooth)
    bands[2, :-1] = beside[1:]
    wanted: Any = np.where(stays, 1.0, smoothing.w_data)[:, None] * points
    found: Points = load_scipy("linalg").solve_banded((1, 1), bands, wanted)
    return found
