"""A planner that finds the cheapest path over a costmap between two poses.

Source: nav2_navfn_planner (costs, tolerance, error messages). Deliberate differences: the tolerance does not reach
through obstacles, so a goal inside a wall is rejected; and a robot that is too close to an obstacle may leave by the
shortest path.
"""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from enum import Enum
from math import ceil
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.costmaps.costmap import INSCRIBED, LETHAL, MAX_PASSABLE, UNKNOWN, Costmap
from linkwright.navigation.costmaps.layered import Pose
from linkwright.navigation.grids.rays import cells_on_lines
from linkwright.navigation.planning.descent import descend
from linkwright.navigation.planning.potential import Cell, FloatArray, compute_crossing_prices, compute_potential

_ESCAPE_PRICE: Final = 2530.0
"""The price of crossing a cell that is too near to an obstacle, if the robot starts in such a cell."""
_MAX_ESCAPE_DISTANCE: Final = 1.0
"""The maximum distance from such a start to a cell where the robot fits, in meters."""


_MIN_POINT_DISTANCE: Final = 1e-9
"""The minimum distance between successive points of a path, in meters."""


class Problem(Enum):
    """The reasons why there is no plan, with the names of nav2's error codes."""

    START_OUTSIDE_MAP = "START_OUTSIDE_MAP"
    GOAL_OUTSIDE_MAP = "GOAL_OUTSIDE_MAP"
    START_OCCUPIED = "START_OCCUPIED"
    GOAL_OCCUPIED = "GOAL_OCCUPIED"
    NO_VALID_PATH = "NO_VALID_PATH"


class PlanError(Exception):
    """Raised when there is no plan.

    Attributes:
        problem: the reason.
    """

    def __init__(self, problem: Problem, text: str) -> None:
        super().__init__(text)
        self.problem = problem


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings of the planner, with nav2's names and defaults.

    Attributes:
        tolerance: the maximum distance from the end of the path to an unreachable goal, in meters.
        use_astar: whether to skip cells that cannot be on a cheaper path; the result is the same.
        allow_unknown: whether paths may cross unknown cells.
        use_final_approach_orientation: whether the final heading is the path's direction instead of the goal's heading.
    """

    tolerance: float = 0.5
    use_astar: bool = False
    allow_unknown: bool = True
    use_final_approach_orientation: bool = False


def plan(costmap: Costmap, start: Pose, goal: Pose, settings: Settings) -> Generator[None, None, NDArray[np.float64]]:
    """Plan a path.

    The generator yields regularly, so that other callbacks can run.

    The costmap must not change before the generator ends.

    Args:
        costmap: the costs of cells.
        start: x, y (meters) and yaw (radians) in the frame of the costmap.
        goal: the goal in the same form.
        settings: the settings of the planner.

    Returns:
        Poses, of shape (n, 3), about a cell apart, from the start to the goal or to the nearest position within the
        tolerance.

    Raises:
        PlanError: there is no path.
    """
    from_cell = _find_cell(costmap, start, Problem.START_OUTSIDE_MAP, "Start")
    to_cell = _find_cell(costmap, goal, Problem.GOAL_OUTSIDE_MAP, "Goal")
    costs = costmap.grid.cells
    if costs[from_cell] == LETHAL:
        raise _make_occupied_error(Problem.START_OCCUPIED, "Start", start)
    if costs[to_cell] == LETHAL:
        raise _make_occupied_error(Problem.GOAL_OCCUPIED, "Goal", goal)
    prices = compute_crossing_prices(costs, allow_unknown=settings.allow_unknown)
    if costs[from_cell] == INSCRIBED and from_cell != to_cell:
        _open_escape(prices, costmap, from_cell, start)
    end = to_cell
    if prices[to_cell] < np.inf:
        costs_to_start = yield from compute_potential(prices, from_cell, to_cell, heuristic=settings.use_astar)
    if not prices[to_cell] < np.inf or not costs_to_start[to_cell] < np.inf:
        costs_to_start = yield from compute_potential(prices, from_cell)
        end = _find_nearest_reachable_cell(costs_to_start, costmap, goal, to_cell, settings)
    is_reached = end == to_cell
    center = costmap.grid.centers_of(np.array(end))
    end_pose = goal if is_reached else (float(center[0]), float(center[1]), goal[2])
    grid = costmap.grid
    end_position = ((end_pose[1] - grid.y) / grid.resolution, (end_pose[0] - grid.x) / grid.resolution)
    path_cells = yield from descend(costs_to_start, from_cell, end_position)
    return _poses_from_cells(_thin_path(path_cells[::-1], prices), costmap, start, end_pose, settings)


def run_to_end(steps: Generator[None, None, NDArray[np.float64]]) -> NDArray[np.float64]:
    """Run a generator to its end, and return its result."""
    results: list[NDArray[np.float64]] = []

    def work() -> Generator[None, None, None]:
        results.append((yield from steps))

    for _ in work():
        pass
    return results[0]


def _find_cell(costmap: Costmap, pose: Pose, problem: Problem, subject: str) -> Cell:
    indices = costmap.grid.cells_of(np.array(pose[:2]))
    if not costmap.grid.contains(indices):
        raise PlanError(problem, f"{subject} Coordinates of({pose[0]:f}, {pose[1]:f}) was outside bounds")
    return int(indices[0]), int(indices[1])


def _make_occupied_error(problem: Problem, subject: str, pose: Pose) -> PlanError:
    return PlanError(problem, f"{subject} Coordinates of({pose[0]:f}, {pose[1]:f}) was in lethal cost")


def _open_escape(prices: FloatArray, costmap: Costmap, cell: Cell, start: Pose) -> None:
    """Make the cells between a start near an obstacle and the nearest free cell passable.

    Raises:
        PlanError: there is no free cell nearby.
    """
    costs = costmap.grid.cells
    reach_in_cells = ceil(_MAX_ESCAPE_DISTANCE / costmap.grid.resolution)
    top, left = max(0, cell[0] - reach_in_cells), max(0, cell[1] - reach_in_cells)
    nearby_costs = costs[top : cell[0] + reach_in_cells + 1, left : cell[1] + reach_in_cells + 1]
    rows, columns = np.ogrid[: nearby_costs.shape[0], : nearby_costs.shape[1]]
    distances = np.hypot(rows + top - cell[0], columns + left - cell[1])
    is_free = np.isfinite(prices[top : top + nearby_costs.shape[0], left : left + nearby_costs.shape[1]])
    if not is_free.any():
        raise _make_occupied_error(Problem.START_OCCUPIED, "Start", start)
    is_opened = (nearby_costs == INSCRIBED) & (distances <= distances[is_free].min() + 1.0)
    prices[top : top + nearby_costs.shape[0], left : left + nearby_costs.shape[1]][is_opened] = _ESCAPE_PRICE


def _find_nearest_reachable_cell(
    costs_to_start: FloatArray, costmap: Costmap, goal: Pose, cell: Cell, settings: Settings
) -> Cell:
    """Return the reachable cell nearest to a goal, within the tolerance.

    No obstacle is between the cell and the goal.

    Raises:
        PlanError: there is no such cell.
    """
    costs = costmap.grid.cells
    reach_in_cells = int(settings.tolerance / costmap.grid.resolution)
    if reach_in_cells > 0:
        top, left = max(0, cell[0] - reach_in_cells), max(0, cell[1] - reach_in_cells)
        nearby_costs = costs_to_start[top : cell[0] + reach_in_cells + 1, left : cell[1] + reach_in_cells + 1]
        candidates = np.argwhere(np.isfinite(nearby_costs)) + np.array((top, left))
        distances = np.hypot(*(candidates - cell).T)
        order = np.lexsort((costs_to_start[candidates[:, 0], candidates[:, 1]], distances))
        candidates = candidates[order[distances[order] * costmap.grid.resolution <= settings.tolerance]]
        if len(candidates):
            cells, line_indices = cells_on_lines(np.array(cell), candidates)
            is_hidden = np.zeros(len(candidates), np.bool_)
            is_hidden[line_indices[costs[cells[:, 0], cells[:, 1]] == LETHAL]] = True
            if not is_hidden.all():
                row, column = candidates[int(np.argmin(is_hidden))]
                return int(row), int(column)
    if MAX_PASSABLE < costs[cell] < UNKNOWN:
        raise _make_occupied_error(Problem.GOAL_OCCUPIED, "Goal", goal)
    raise PlanError(Problem.NO_VALID_PATH, f"Failed to create plan with tolerance of: {settings.tolerance:f}")


def _thin_path(path_cells: NDArray[np.float64], prices: FloatArray) -> NDArray[np.float64]:
    """Drop every second point of a path where a straight line avoids unreachable cells."""
    cells = np.floor(path_cells).astype(np.int64)
    dropped = np.arange(1, len(path_cells) - 1, 2)
    previous, following = cells[dropped - 1], cells[dropped + 1]
    is_adjacent = np.abs(following - previous).max(axis=1, initial=0) <= 1
    corner_prices = prices[previous[:, 0], following[:, 1]] + prices[following[:, 0], previous[:, 1]]
    return np.delete(path_cells, dropped[is_adjacent & np.isfinite(corner_prices)], axis=0)


def _poses_from_cells(
    path_cells: NDArray[np.float64], costmap: Costmap, start: Pose, end_pose: Pose, settings: Settings
) -> NDArray[np.float64]:
    """Convert rows and columns to poses of shape (n, 3), from the exact start to the exact end."""
    grid = costmap.grid
    points = path_cells[:, ::-1] * grid.resolution + (grid.x, grid.y)
    points[0], points[-1] = start[:2], end_pose[:2]
    steps = np.diff(points, axis=0)
    is_distinct = np.hypot(steps[:, 0], steps[:, 1]) > _MIN_POINT_DISTANCE
    points = np.concatenate((points[:-1][is_distinct], points[-1:]))
    steps = steps[is_distinct]
    yaws = np.append(np.arctan2(steps[:, 1], steps[:, 0]), end_pose[2])
    if settings.use_final_approach_orientation and len(yaws) > 1:
        yaws[-1] = yaws[-2]
    return np.column_stack((points, yaws))
