"""Potentials: the cost of the cheapest path from one cell to each other cell of a costmap.

A potential is computed as a wavefront. The wave solves the eikonal equation on a grid, as NavFn does: paths have all
directions, not only along rows, columns and diagonals. All cells of the front are updated in the same step, and cells
whose neighbours became cheaper are updated again, until nothing changes. The wave continues from expensive cells only
when it has reached the same cost in cheap ones, because most expensive cells have a cheaper path around them.

Source: Brock and Khatib, High-speed navigation using the global dynamic window approach, ICRA 1999; nav2_navfn_planner
(the cost of a cell).
"""

from __future__ import annotations

from collections.abc import Generator
from math import sqrt
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.costmaps.costmap import MAX_PASSABLE, UNKNOWN

Floats = NDArray[np.float64]
Cell = tuple[int, int]
"""Row and column."""

NEUTRAL: Final = 50.0
"""The price of crossing a cell that costs nothing."""
_FACTOR: Final = 0.8
_MOST: Final = 253.0
"""The cost of crossing an unknown cell."""
_ROUNDS_HELD: Final = 4
"""The number of steps of the wave between two checks for expensive cells that are due."""
_SMALLEST_GAIN: Final = 1e-3 * NEUTRAL


def crossing_prices(costs: NDArray[np.uint8], *, allow_unknown: bool = True) -> Floats:
    """Return the price of crossing each cell, infinite where the robot does not fit.

    Args:
        costs: the costs of the cells.
        allow_unknown: whether paths may cross unknown cells.

    Returns:
        Prices, of the shape of the costs.
    """
    table = np.minimum(NEUTRAL + _FACTOR * np.arange(256.0), _MOST)
    table[MAX_PASSABLE + 1 :] = np.inf
    if allow_unknown:
        table[UNKNOWN] = _MOST
    crossed: Floats = table[costs]
    return crossed


def potential(
    price: Floats, source: Cell, target: Cell | None = None, *, heuristic: bool = False
) -> Generator[None, None, Floats]:
    """Compute the cost of the cheapest path from a cell to each other cell.

    The generator yields after each step of the wave, so that other callbacks can run.

    Args:
        price: the cost of crossing cells, of shape (rows, columns); infinite for obstacles.
        source: the start of the paths; it may have any price.
        target: the goal of the requested path; cells that cost more are skipped. None for all cells.
        heuristic: whether to add the minimum cost to the target when cells are skipped (A*).

    Returns:
        The costs, of the same shape; 0 at the source, infinite in unreachable and skipped cells.
    """
    rows, columns = price.shape
    width = columns + 2
    padded = np.full((rows + 2, width), np.inf)
    padded[1:-1, 1:-1] = price
    step = padded.ravel()
    least = np.full(step.size, np.inf)
    gain = np.where(step < np.inf, np.inf, -np.inf)  # Like `least`, except that obstacles can never become cheaper.
    mark = np.zeros(step.size, np.intp)
    offsets = np.array([[-1], [1], [-width], [width]])
    begin = (source[0] + 1) * width + source[1] + 1
    end = None if target is None else (target[0] + 1) * width + target[1] + 1
    ahead = _min_cost_to_target(price, target) if heuristic and target is not None else None
    least[begin], gain[begin] = 0.0, -np.inf
    least_step = float(step.min()) / sqrt(2.0)  # The smallest increase, if the path enters from both axes.
    front: NDArray[Any] = begin + offsets[:, 0]
    front = front[step[front] < np.inf]
    cheapest = float(step.min())
    held: NDArray[Any] = np.empty(0, np.intp)
    bound, rounds = 0.0, 0
    while front.size or held.size:
        yield
        sides = least.take(front + offsets)
        value = _potential_after_crossing(
            np.minimum(sides[0], sides[1]), np.minimum(sides[2], sides[3]), step.take(front)
        )
        better = np.flatnonzero(value < gain.take(front) - _SMALLEST_GAIN)
        front, value = front.take(better), value.take(better)
        least[front] = value
        gain[front] = value
        rounds += 1
        bound += cheapest
        late = value > bound
        if late.any():
            held = np.concatenate((held, front[late]))
            front = front[~late]
        if held.size and (not front.size or not rounds % _ROUNDS_HELD):
            waiting = least.take(held)
            bound = max(bound, float(waiting.min()))
            due = waiting <= bound + _ROUNDS_HELD * cheapest
            front, held = np.concatenate((front, held[due])), held[~due]
        value = least.take(front)
        if end is not None and least[end] < np.inf:
            near = (value if ahead is None else value + ahead.take(front)) < least[end]
            front, value = front[near], value[near]
        around = front + offsets
        around = around[gain.take(around) > value + least_step]
        mark[around] = order = np.arange(around.size)
        front = around[mark.take(around) == order]
    result: Floats = least.reshape(rows + 2, width)[1:-1, 1:-1]
    return result


def _potential_after_crossing(a: Floats, b: Floats, price: Floats) -> Floats:
    """Return the potential of cells from their prices and the cheaper neighbour on each axis."""
    low, high = np.minimum(a, b), np.maximum(a, b)
    apart = np.minimum(high - low, price)  # Beyond the price, the path enters from one side only.
    value: Floats = low + 0.5 * (apart + np.sqrt(2.0 * price * price - apart * apart))
    return value


def _min_cost_to_target(price: Floats, target: Cell) -> Floats:
    """Return a lower bound of the cost from each cell to the target.

    The result is flat, and includes a border of one cell.
    """
    rows, columns = price.shape
    y, x = np.arange(-1.0, rows + 1) - target[0], np.arange(-1.0, columns + 1) - target[1]
    ahead: Floats = (float(price.min()) * np.hypot(y[:, None], x[None, :])).ravel()
    return ahead
