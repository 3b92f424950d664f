"""Smooth paths: each point moves towards the middle of its neighbors.

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

_MIN_POINTS: Final = 3


@dataclass(frozen=True, kw_only=True)
class Smoothing:
    """Settings of the smoother, with nav2's names and defaults.

    Attributes:
        w_data: the weight of a point's original position.
        w_smooth: the weight of the middle of the point's neighbors.
        do_refinement: whether to smooth the result again.
        refinement_num: the number of refinements.
        enforce_path_inversion: whether points at which the robot reverses direction are fixed.
    """

    w_data: float = 0.2
    w_smooth: float = 0.3
    do_refinement: bool = True
    refinement_num: int = 2
    enforce_path_inversion: bool = True


def smooth_path(points: Points, smoothing: Smoothing, costmap: Costmap | None = None) -> tuple[Points, bool]:
    """Smooth a path.

    Args:
        points: x and y in the frame of the costmap, in meters, of shape (n, 2).
        smoothing: the settings of the smoother.
        costmap: the costmap whose obstacles are avoided; None for no obstacles.

    Returns:
        The smoothed points, of the same shape, with the same first and last point; and whether all points could move
        without a collision.
    """
    result, all_points_moved = points, True
    pass_count = 1 + (smoothing.refinement_num if smoothing.do_refinement else 0)
    is_fixed = _find_fixed_points(points, smoothing)
    for _ in range(pass_count):
        result, all_moved_in_pass = _smooth_once(result, is_fixed, smoothing, costmap)
        all_points_moved &= all_moved_in_pass
    return result, all_points_moved


def compute_directions(points: Points, last_yaw: float) -> NDArray[np.float64]:
    """Return the yaw from each point of a path to the next one, in radians, of shape (n,).

    The yaw of the last point is `last_yaw`.
    """
    steps = np.diff(points, axis=0)
    return np.append(np.arctan2(steps[:, 1], steps[:, 0]), last_yaw)


def _find_fixed_points(points: Points, smoothing: Smoothing) -> NDArray[np.bool_]:
    """Return a mask of the fixed points: the ends, and reversals if they are enforced."""
    is_fixed = np.zeros(len(points), np.bool_)
    is_fixed[[0, -1]] = True
    if smoothing.enforce_path_inversion and len(points) >= _MIN_POINTS:
        steps = np.diff(points, axis=0)
        is_fixed[1:-1] |= (steps[:-1] * steps[1:]).sum(axis=1) < 0.0
    return is_fixed


def _smooth_once(
    points: Points, is_fixed: NDArray[np.bool_], smoothing: Smoothing, costmap: Costmap | None
) -> tuple[Points, bool]:
    if len(points) < _MIN_POINTS:
        return points, True
    is_kept = is_fixed.copy()
    while True:
        result = _solve_equilibrium(points, is_kept, smoothing)
        if costmap is None:
            return result, True
        is_blocked = _find_blocked_points(result, costmap) & ~is_kept
        if not is_blocked.any():
            return result, not (is_kept & ~is_fixed).any()
        is_kept |= is_blocked


def _find_blocked_points(points: Points, costmap: Costmap) -> NDArray[np.bool_]:
    """Return a mask of the points that collide, or have a colliding midpoint to a neighbor."""
    midpoints = (points + np.roll(points, -1, axis=0)) / 2.0
    midpoints[-1] = points[-1]

    def collision_mask(positions: Points) -> NDArray[np.bool_]:
        costs = costmap.cost_at(positions)
        return np.asarray((costs > MAX_PASSABLE) & (costs != UNKNOWN))

    is_blocked = collision_mask(points)
    is_gap_blocked = collision_mask(midpoints)
    is_blocked |= is_gap_blocked
    is_blocked[1:] |= is_gap_blocked[:-1]
    return is_blocked


def _solve_equilibrium(points: Points, is_kept: NDArray[np.bool_], smoothing: Smoothing) -> Points:
    """Return the points y that solve w_data (y - x) = w_smooth (previous + next - 2 y).

    Points in the mask `is_kept` keep their positions x.
    """
    neighbor_weights = np.where(is_kept, 0.0, -smoothing.w_smooth)
    bands = np.zeros((3, len(points)))
    bands[0, 1:] = neighbor_weights[:-1]
    bands[1] = np.where(is_kept, 1.0, smoothing.w_data + 2.0 * smoothing.w_smooth)
    bands[2, :-1] = neighbor_weights[1:]
    right_side: Any = np.where(is_kept, 1.0, smoothing.w_data)[:, None] * points
    solution: Points = load_scipy("linalg").solve_banded((1, 1), bands, right_side)
    return solution
