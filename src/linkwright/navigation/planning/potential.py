"""Potentials: the cost of the cheapest path from one cell to each other cell of a costmap.

A potential is computed as a wavefront. The wave solves the eikonal equation on a grid, as NavFn does, so paths can have
any direction, not only along rows, columns and diagonals. All cells of the front are updated in the same step. A cell
is updated again if a neighbor became cheaper, until nothing changes. The wave continues from an expensive cell only
when it has reached the same cost in cheap cells, because there is usually a cheaper path around expensive cells.

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

FloatArray = NDArray[np.float64]
Cell = tuple[int, int]
"""Row and column."""

NEUTRAL_COST: Final = 50.0
"""The price of crossing a cell of cost 0."""
_COST_FACTOR: Final = 0.8
_MAX_COST: Final = 253.0
"""The maximum price of a cell, which is also the price of an unknown cell."""
_STEPS_BETWEEN_CHECKS: Final = 4
"""The number of steps of the wave between two checks of the cells that were held back."""
_MIN_GAIN: Final = 1e-3 * NEUTRAL_COST


def compute_crossing_prices(costs: NDArray[np.uint8], *, allow_unknown: bool = True) -> FloatArray:
    """Return the price of crossing each cell, infinite where the robot does not fit.

    Args:
        costs: the costs of the cells.
        allow_unknown: whether paths may cross unknown cells.

    Returns:
        Prices, of the shape of the costs.
    """
    table = np.minimum(NEUTRAL_COST + _COST_FACTOR * np.arange(256.0), _MAX_COST)
    table[MAX_PASSABLE + 1 :] = np.inf
    if allow_unknown:
        table[UNKNOWN] = _MAX_COST
    prices: FloatArray = table[costs]
    return prices


def compute_potential(
    price: FloatArray, source: Cell, target: Cell | None = None, *, heuristic: bool = False
) -> Generator[None, None, FloatArray]:
    """Compute the cost of the cheapest path from a cell to each other cell.

    The generator yields after each step of the wave, so that other callbacks can run.

    Args:
        price: the price of crossing each cell, of shape (rows, columns); infinite for obstacles.
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
    prices = padded.ravel()
    costs = np.full(prices.size, np.inf)
    # Like `costs`, except that obstacles can never become cheaper.
    update_bounds = np.where(prices < np.inf, np.inf, -np.inf)
    last_index = np.zeros(prices.size, np.intp)
    offsets = np.array([[-1], [1], [-width], [width]])
    start_index = (source[0] + 1) * width + source[1] + 1
    target_index = None if target is None else (target[0] + 1) * width + target[1] + 1
    remaining_bounds = _compute_min_cost_to_target(price, target) if heuristic and target is not None else None
    costs[start_index], update_bounds[start_index] = 0.0, -np.inf
    # The smallest increase of the cost, for a path that enters a cell from both axes.
    min_increase = float(prices.min()) / sqrt(2.0)
    front: NDArray[Any] = start_index + offsets[:, 0]
    front = front[prices[front] < np.inf]
    min_price = float(prices.min())
    held_cells: NDArray[Any] = np.empty(0, np.intp)
    bound, step_count = 0.0, 0
    while front.size or held_cells.size:
        yield
        neighbor_costs = costs.take(front + offsets)
        new_costs = _compute_potential_after_crossing(
            np.minimum(neighbor_costs[0], neighbor_costs[1]),
            np.minimum(neighbor_costs[2], neighbor_costs[3]),
            prices.take(front),
        )
        improved = np.flatnonzero(new_costs < update_bounds.take(front) - _MIN_GAIN)
        front, new_costs = front.take(improved), new_costs.take(improved)
        costs[front] = new_costs
        update_bounds[front] = new_costs
        step_count += 1
        bound += min_price
        is_late = new_costs > bound
        if is_late.any():
            held_cells = np.concatenate((held_cells, front[is_late]))
            front = front[~is_late]
        if held_cells.size and (not front.size or not step_count % _STEPS_BETWEEN_CHECKS):
            held_costs = costs.take(held_cells)
            bound = max(bound, float(held_costs.min()))
            is_due = held_costs <= bound + _STEPS_BETWEEN_CHECKS * min_price
            front, held_cells = np.concatenate((front, held_cells[is_due])), held_cells[~is_due]
        new_costs = costs.take(front)
        if target_index is not None and costs[target_index] < np.inf:
            is_promising = (
                new_costs if remaining_bounds is None else new_costs + remaining_bounds.take(front)
            ) < costs[target_index]
            front, new_costs = front[is_promising], new_costs[is_promising]
        neighbors = front + offsets
        neighbors = neighbors[update_bounds.take(neighbors) > new_costs + min_increase]
        last_index[neighbors] = order = np.arange(neighbors.size)
        front = neighbors[last_index.take(neighbors) == order]
    result: FloatArray = costs.reshape(rows + 2, width)[1:-1, 1:-1]
    return result


def _compute_potential_after_crossing(
    row_neighbor: FloatArray, column_neighbor: FloatArray, price: FloatArray
) -> FloatArray:
    """Return the potential of cells from their prices and the cheaper neighbor on each axis."""
    low, high = np.minimum(row_neighbor, column_neighbor), np.maximum(row_neighbor, column_neighbor)
    difference = np.minimum(high - low, price)  # A larger difference means that only one axis counts.
    value: FloatArray = low + 0.5 * (difference + np.sqrt(2.0 * price * price - difference * difference))
    return value


def _compute_min_cost_to_target(price: FloatArray, target: Cell) -> FloatArray:
    """Return a lower bound of the cost from each cell to the target.

    The result is flat, and includes a border of one cell.
    """
    rows, columns = price.shape
    y, x = np.arange(-1.0, rows + 1) - target[0], np.arange(-1.0, columns + 1) - target[1]
    bounds: FloatArray = (float(price.min()) * np.hypot(y[:, None], x[None, :])).ravel()
    return bounds
