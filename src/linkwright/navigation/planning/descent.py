"""Extraction of paths by descent on a potential.

Source: nav2_navfn_planner, which steps half a cell along the interpolated gradient.
"""

from __future__ import annotations

from collections.abc import Generator
from math import floor, hypot, inf

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.planning.potential import Cell, Floats

Place = tuple[float, float]
"""Row and column, in cells; the middle of cell (0, 0) is (0.5, 0.5)."""

_STEP = 0.5
_STEPS_IN_A_CELL = 4
_STEPS_AT_A_TIME = 64
_FLAT = 1e-6
_AROUND = [(row, column) for row in (-1, 0, 1) for column in (-1, 0, 1) if row or column]


class _Slope:
    """The gradient of a potential, computed and cached on demand."""

    def __init__(self, least: Floats) -> None:
        self._least = least
        self._rows, self._columns = least.shape
        self._gradients: dict[Cell, Place | None] = {}

    def at(self, row: int, column: int) -> float:
        """Return the potential of a cell, infinite outside the grid."""
        if 0 <= row < self._rows and 0 <= column < self._columns:
            return float(self._least[row, column])
        return inf

    def joined(self, cell: Cell, other: Cell) -> bool:
        """Return whether the straight step to an adjacent cell avoids unreachable cells.

        A diagonal step passes a corner, so both cells beside the corner must be reachable, too.
        """
        (row, column), (to_row, to_column) = cell, other
        return self.at(to_row, to_column) < inf and (
            row == to_row or column == to_column or max(self.at(row, to_column), self.at(to_row, column)) < inf
        )

    def steepest_neighbour(self, cell: Cell) -> Cell:
        """Return the neighbour with the steepest descent, or the cell if no neighbour is lower."""
        row, column = cell
        here = self.at(row, column)
        best, steepest = cell, 0.0
        for down, right in _AROUND:
            other = (row + down, column + right)
            fall = (here - self.at(*other)) / hypot(down, right)
            if fall > steepest and self.joined(cell, other):
                best, steepest = other, fall
        return best

    def direction(self, place: Place) -> Place | None:
        """Return the direction of steepest descent as a unit vector (rows, columns).

        Returns None where the potential is flat.
        """
        row, column = place[0] - 0.5, place[1] - 0.5
        top, left = floor(row), floor(column)
        lower, right = row - top, column - left
        down = along = 0.0
        for cell, weight in (
            ((top, left), (1.0 - lower) * (1.0 - right)),
            ((top, left + 1), (1.0 - lower) * right),
            ((top + 1, left), lower * (1.0 - right)),
            ((top + 1, left + 1), lower * right),
        ):
            gradient = self._gradient(cell)
            if gradient is not None:
                down -= weight * gradient[0]
                along -= weight * gradient[1]
        length = hypot(down, along)
        return None if length < _FLAT else (down / length, along / length)

    def _gradient(self, cell: Cell) -> Place | None:
        if cell in self._gradients:
            return self._gradients[cell]
        row, column = cell
        here = self.at(row, column)
        found: Place | None = None
        if here < inf:
            down = _difference(self.at(row - 1, column), here, self.at(row + 1, column))
            right = _difference(self.at(row, column - 1), here, self.at(row, column + 1))
            length = hypot(down, right)
            found = (down / length, right / length) if length > _FLAT else None
        self._gradients[cell] = found
        return found


def _difference(before: float, here: float, after: float) -> float:
    """Return the derivative of a potential along an axis.

    The potential never descends towards an unreachable side.
    """
    if before < inf and after < inf:
        return (after - before) / 2.0
    if before < inf:
        return max(0.0, here - before)
    return min(0.0, after - here) if after < inf else 0.0


def descend(least: Floats, source: Cell, begin: Place) -> Generator[None, None, NDArray[np.float64]]:
    """Descend a potential, yielding regularly so that other callbacks can run.

    Args:
        least: a potential (see `potential`).
        source: the cell where the potential is zero.
        begin: the row and column of the path's start, in a cell from which a path leads to the source.

    Returns:
        Rows and columns, of shape (n, 2), from the start to the middle of the source; empty for a cell without a path.
    """
    slope = _Slope(least)
    end = (source[0] + 0.5, source[1] + 0.5)
    place, cell = begin, (floor(begin[0]), floor(begin[1]))
    way = [place]
    stayed = 0
    while cell != source:
        if not len(way) % _STEPS_AT_A_TIME:
            yield
        following = _step(slope, place, cell) if stayed < _STEPS_IN_A_CELL else None
        if following is None:
            beside = slope.steepest_neighbour(cell)
            following = (beside[0] + 0.5, beside[1] + 0.5)
        now = (floor(following[0]), floor(following[1]))
        stayed = stayed + 1 if now == cell else 0
        place, cell = following, now
        way.append(place)
    way.append(end)
    return np.array(way)


def _step(slope: _Slope, place: Place, cell: Cell) -> Place | None:
    """Return the position half a cell downhill from a position in a cell.

    Returns None if the potential is flat or the step leads to an unreachable cell.
    """
    direction = slope.direction(place)
    if direction is None:
        return None
    following = (place[0] + _STEP * direction[0], place[1] + _STEP * direction[1])
    now = (floor(following[0]), floor(following[1]))
    if now != cell and not (slope.joined(cell, now) and slope.at(*now) < slope.at(*cell)):
        return None
    return following
