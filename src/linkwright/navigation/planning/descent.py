"""Extract paths by descent on a potential.

Source: nav2_navfn_planner, which steps half a cell along the interpolated gradient.
"""

from __future__ import annotations

from collections.abc import Generator
from math import floor, hypot, inf

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.planning.potential import Cell, FloatArray

Position = tuple[float, float]
"""A position as row and column, in cells. The middle of cell (0, 0) is (0.5, 0.5)."""

_STEP_CELLS = 0.5
"""The length of a step along the gradient, in cells."""
_MAX_STEPS_IN_CELL = 4
_STEPS_BETWEEN_YIELDS = 64
_MIN_SLOPE = 1e-6
_NEIGHBOR_OFFSETS = [(row, column) for row in (-1, 0, 1) for column in (-1, 0, 1) if row or column]


class _Slope:
    """The gradient of a potential, computed and cached on demand."""

    def __init__(self, costs: FloatArray) -> None:
        self._costs = costs
        self._rows, self._columns = costs.shape
        self._gradients: dict[Cell, Position | None] = {}

    def potential_at(self, row: int, column: int) -> float:
        """Return the potential of a cell, infinite outside the grid."""
        if 0 <= row < self._rows and 0 <= column < self._columns:
            return float(self._costs[row, column])
        return inf

    def are_connected(self, cell: Cell, neighbor: Cell) -> bool:
        """Return whether the straight step to an adjacent cell avoids unreachable cells.

        For a diagonal step, both cells beside the corner must also be reachable.
        """
        (row, column), (to_row, to_column) = cell, neighbor
        return self.potential_at(to_row, to_column) < inf and (
            row == to_row
            or column == to_column
            or max(self.potential_at(row, to_column), self.potential_at(to_row, column)) < inf
        )

    def find_steepest_neighbor(self, cell: Cell) -> Cell:
        """Return the neighbor with the steepest descent, or the cell if no neighbor is lower."""
        row, column = cell
        cost = self.potential_at(row, column)
        best_neighbor, steepest_descent = cell, 0.0
        for row_step, column_step in _NEIGHBOR_OFFSETS:
            neighbor = (row + row_step, column + column_step)
            descent = (cost - self.potential_at(*neighbor)) / hypot(row_step, column_step)
            if descent > steepest_descent and self.are_connected(cell, neighbor):
                best_neighbor, steepest_descent = neighbor, descent
        return best_neighbor

    def compute_direction(self, position: Position) -> Position | None:
        """Return the direction of steepest descent as a unit vector (rows, columns).

        Returns None if the potential is flat at the position.
        """
        row, column = position[0] - 0.5, position[1] - 0.5
        top, left = floor(row), floor(column)
        row_share, column_share = row - top, column - left
        row_direction = column_direction = 0.0
        for cell, weight in (
            ((top, left), (1.0 - row_share) * (1.0 - column_share)),
            ((top, left + 1), (1.0 - row_share) * column_share),
            ((top + 1, left), row_share * (1.0 - column_share)),
            ((top + 1, left + 1), row_share * column_share),
        ):
            gradient = self._compute_gradient(cell)
            if gradient is not None:
                row_direction -= weight * gradient[0]
                column_direction -= weight * gradient[1]
        length = hypot(row_direction, column_direction)
        return None if length < _MIN_SLOPE else (row_direction / length, column_direction / length)

    def _compute_gradient(self, cell: Cell) -> Position | None:
        if cell in self._gradients:
            return self._gradients[cell]
        row, column = cell
        cost = self.potential_at(row, column)
        gradient: Position | None = None
        if cost < inf:
            row_slope = _differentiate(self.potential_at(row - 1, column), cost, self.potential_at(row + 1, column))
            column_slope = _differentiate(self.potential_at(row, column - 1), cost, self.potential_at(row, column + 1))
            length = hypot(row_slope, column_slope)
            gradient = (row_slope / length, column_slope / length) if length > _MIN_SLOPE else None
        self._gradients[cell] = gradient
        return gradient


def _differentiate(previous: float, current: float, following: float) -> float:
    """Return the derivative of a potential along an axis.

    The derivative never leads towards an unreachable neighbor.
    """
    if previous < inf and following < inf:
        return (following - previous) / 2.0
    if previous < inf:
        return max(0.0, current - previous)
    return min(0.0, following - current) if following < inf else 0.0


def descend(costs: FloatArray, source: Cell, start: Position) -> Generator[None, None, NDArray[np.float64]]:
    """Extract a path by descent on a potential.

    The generator yields regularly, so that other callbacks can run.

    Args:
        costs: a potential (see `compute_potential`).
        source: the cell where the potential is zero.
        start: the row and column of the path's start, in a reachable cell.

    Returns:
        Rows and columns, of shape (n, 2), from the start to the middle of the source.
    """
    slope = _Slope(costs)
    end = (source[0] + 0.5, source[1] + 0.5)
    position, cell = start, (floor(start[0]), floor(start[1]))
    path = [position]
    steps_in_cell = 0
    while cell != source:
        if not len(path) % _STEPS_BETWEEN_YIELDS:
            yield
        next_position = _step_downhill(slope, position, cell) if steps_in_cell < _MAX_STEPS_IN_CELL else None
        if next_position is None:
            neighbor = slope.find_steepest_neighbor(cell)
            next_position = (neighbor[0] + 0.5, neighbor[1] + 0.5)
        next_cell = (floor(next_position[0]), floor(next_position[1]))
        steps_in_cell = steps_in_cell + 1 if next_cell == cell else 0
        position, cell = next_position, next_cell
        path.append(position)
    path.append(end)
    return np.array(path)


def _step_downhill(slope: _Slope, position: Position, cell: Cell) -> Position | None:
    """Return the position half a cell downhill from a position in a cell.

    Returns None if the potential is flat or the step leads to an unreachable cell.
    """
    direction = slope.compute_direction(position)
    if direction is None:
        return None
    next_position = (position[0] + _STEP_CELLS * direction[0], position[1] + _STEP_CELLS * direction[1])
    next_cell = (floor(next_position[0]), floor(next_position[1]))
    if next_cell != cell and not (
        slope.are_connected(cell, next_cell) and slope.potential_at(*next_cell) < slope.potential_at(*cell)
    ):
        return None
    return next_position
