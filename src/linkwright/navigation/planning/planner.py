"""Planning of the cheapest path over a costmap between two poses.

Source: nav2_navfn_planner (costs, tolerance, error messages). Deliberate differences: the tolerance does not reach
through obstacles, so a goal within a wall is refused; and a robot that is too close to an obstacle may leave by the
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
from linkwright.navigation.planning.potential import Cell, Floats, crossing_prices, potential

_ESCAPE_PRICE: Final = 2530.0
"""The cost of a cell too near to an obstacle, for a robot that starts in one: it leaves by the shortest path."""
_ESCAPE_REACH: Final = 1.0
"""The radius in metres that must contain a cell where the robot fits."""


_NO_WAY: Final = 1e-9
"""Points that are nearer to each other, in metres, are one."""


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
        tolerance: the maximum distance from the end of the path to an unreachable goal, in metres.
        use_astar: whether to skip cells that cannot be on a cheaper path; the result is the same.
        allow_unknown: whether paths may cross unknown cells.
        use_final_approach_orientation: whether the final heading is the path's direction instead of the goal's heading.
    """

    tolerance: float = 0.5
    use_astar: bool = False
    allow_unknown: bool = True
    use_final_approach_orientation: bool = False


def plan(costmap: Costmap, start: Pose, goal: Pose, settings: Settings) -> Generator[None, None, NDArray[np.float64]]:
    """Plan a path, yielding regularly so that other callbacks can run.

    The costmap must not change meanwhile.

    Args:
        costmap: the costs of cells.
        start: x, y (metres) and yaw (radians) in the frame of the costmap.
        goal: the goal in the same form.
        settings: the settings of the planner.

    Returns:
        Poses from the start to the goal, or to the nearest position within the tolerance, of shape (n, 3), about a cell
        apart.

    Raises:
        PlanError: there is no path.
    """
    from_cell = _cell(costmap, start, Problem.START_OUTSIDE_MAP, "Start")
    to_cell = _cell(costmap, goal, Problem.GOAL_OUTSIDE_MAP, "Goal")
    costs = costmap.grid.cells
    if costs[from_cell] == LETHAL:
        raise _occupied(Problem.START_OCCUPIED, "Start", start)
    if costs[to_cell] == LETHAL:
        raise _occupied(Problem.GOAL_OCCUPIED, "Goal", goal)
    price = crossing_prices(costs, allow_unknown=settings.allow_unknown)
    if costs[from_cell] == INSCRIBED and from_cell != to_cell:
        _open_escape(price, costmap, from_cell, start)
    end = to_cell
    if price[to_cell] < np.inf:
        least = yield from potential(price, from_cell, to_cell, heuristic=settings.use_astar)
    if not price[to_cell] < np.inf or not least[to_cell] < np.inf:
        least = yield from potential(price, from_cell)
        end = _nearest(least, costmap, goal, to_cell, settings)
    reached = end == to_cell
    centre = costmap.grid.centres_of(np.array(end))
    last = goal if reached else (float(centre[0]), float(centre[1]), goal[2])
    grid = costmap.grid
    begin = ((last[1] - grid.y) / grid.resolution, (last[0] - grid.x) / grid.resolution)
    way = yield from descend(least, from_cell, begin)
    return _poses(_thin_path(way[::-1], price), costmap, start, last, settings)


def run(steps: Generator[None, None, NDArray[np.float64]]) -> NDArray[np.float64]:
    """Run a generator to its end, and return its result."""
    found: list[NDArray[np.float64]] = []

    def work() -> Generator[None, None, None]:
        found.append((yield from steps))

    for _ in work():
        pass
    return found[0]


def _cell(costmap: Costmap, pose: Pose, problem: Problem, what: str) -> Cell:
    indices = costmap.grid.cells_of(np.array(pose[:2]))
    if not costmap.grid.has(indices):
        raise PlanError(problem, f"{what} Coordinates of({pose[0]:f}, {pose[1]:f}) was outside bounds")
    return int(indices[0]), int(indices[1])


def _occupied(problem: Problem, what: str, pose: Pose) -> PlanError:
    return PlanError(problem, f"{what} Coordinates of({pose[0]:f}, {pose[1]:f}) was in lethal cost")


def _open_escape(price: Floats, costmap: Costmap, cell: Cell, start: Pose) -> None:
    """Make the cells passable that lead from a start near an obstacle to the nearest free cell.

    Raises:
        PlanError: there is no free cell nearby.
    """
    costs = costmap.grid.cells
    reach = ceil(_ESCAPE_REACH / costmap.grid.resolution)
    top, left = max(0, cell[0] - reach), max(0, cell[1] - reach)
    part = costs[top : cell[0] + reach + 1, left : cell[1] + reach + 1]
    rows, columns = np.ogrid[: part.shape[0], : part.shape[1]]
    distances = np.hypot(rows + top - cell[0], columns + left - cell[1])
    free = np.isfinite(price[top : top + part.shape[0], left : left + part.shape[1]])
    if not free.any():
        raise _occupied(Problem.START_OCCUPIED, "Start", start)
    near = (part == INSCRIBED) & (distances <= distances[free].min() + 1.0)
    price[top : top + part.shape[0], left : left + part.shape[1]][near] = _ESCAPE_PRICE


def _nearest(least: Floats, costmap: Costmap, goal: Pose, cell: Cell, settings: Settings) -> Cell:
    """Return the reachable cell nearest to a goal, within the tolerance and on the same side of obstacles.

    Raises:
        PlanError: there is no such cell.
    """
    costs = costmap.grid.cells
    reach = int(settings.tolerance / costmap.grid.resolution)
    if reach > 0:
        top, left = max(0, cell[0] - reach), max(0, cell[1] - reach)
        part = least[top : cell[0] + reach + 1, left : cell[1] + reach + 1]
        candidates = np.argwhere(np.isfinite(part)) + np.array((top, left))
        distances = np.hypot(*(candidates - cell).T)
        order = np.lexsort((least[candidates[:, 0], candidates[:, 1]], distances))
        candidates = candidates[order[distances[order] * costmap.grid.resolution <= settings.tolerance]]
        if len(candidates):
            cells, line = cells_on_lines(np.array(cell), candidates)
            hidden = np.zeros(len(candidates), np.bool_)
            hidden[line[costs[cells[:, 0], cells[:, 1]] == LETHAL]] = True
            if not hidden.all():
                row, column = candidates[int(np.argmin(hidden))]
                return int(row), int(column)
    if MAX_PASSABLE < costs[cell] < UNKNOWN:
        raise _occupied(Problem.GOAL_OCCUPIED, "Goal", goal)
    raise PlanError(Problem.NO_VALID_PATH, f"Failed to create plan with tolerance of: {settings.tolerance:f}")


def _thin_path(way: NDArray[np.float64], price: Floats) -> NDArray[np.float64]:
    """Drop every second point of a path where the straight line avoids unreachable cells."""
    cells = np.floor(way).astype(np.int64)
    between = np.arange(1, len(way) - 1, 2)
    before, after = cells[between - 1], cells[between + 1]
    clear = np.abs(after - before).max(axis=1, initial=0) <= 1
    corners = price[before[:, 0], after[:, 1]] + price[after[:, 0], before[:, 1]]
    return np.delete(way, between[clear & np.isfinite(corners)], axis=0)


def _poses(
    way: NDArray[np.float64], costmap: Costmap, start: Pose, last: Pose, settings: Settings
) -> NDArray[np.float64]:
    """Convert rows and columns to poses, of shape (n, 3), from the exact start to the exact end."""
    grid = costmap.grid
    points = way[:, ::-1] * grid.resolution + (grid.x, grid.y)
    points[0], points[-1] = start[:2], last[:2]
    ahead = np.diff(points, axis=0)
    moved = np.hypot(ahead[:, 0], ahead[:, 1]) > _NO_WAY
    points = np.concatenate((points[:-1][moved], points[-1:]))
    ahead = ahead[moved]
    yaws = np.append(np.arctan2(ahead[:, 1], ahead[:, 0]), last[2])
    if settings.use_final_approach_orientation and len(yaws) > 1:
        yaws[-1] = yaws[-2]
    return np.column_stack((points, yaws))
