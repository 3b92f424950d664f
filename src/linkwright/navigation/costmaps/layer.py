"""The base classes of layers, which report where they changed, and write their costs there."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.polygon import within_polygon
from linkwright.navigation.costmaps.costmap import FREE, UNKNOWN
from linkwright.navigation.costmaps.footprints import Footprint
from linkwright.navigation.grids.grid import Grid

Costs = NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class Window:
    """A rectangle of cells: from the first row and column up to, but excluding, the last ones."""

    top: int = 0
    left: int = 0
    bottom: int = 0
    right: int = 0

    @classmethod
    def of(cls, grid: Grid) -> Window:
        """The window of a whole grid."""
        return cls(0, 0, grid.rows, grid.columns)

    @classmethod
    def around(cls, indices: NDArray[np.int64], grid: Grid) -> Window:
        """The window around cells, rows and columns of shape (n, 2), as far as it is in the grid."""
        if not len(indices):
            return cls()
        (top, left), (bottom, right) = indices.min(axis=0), indices.max(axis=0) + 1
        return cls(int(top), int(left), int(bottom), int(right)).within(grid)

    @property
    def is_empty(self) -> bool:
        """Whether it contains no cells."""
        return self.bottom <= self.top or self.right <= self.left

    @property
    def cells(self) -> tuple[slice, slice]:
        """The index of an array that gives its cells."""
        return slice(self.top, self.bottom), slice(self.left, self.right)

    def within(self, grid: Grid) -> Window:
        """Return the part within a grid."""
        inside = Window(max(0, self.top), max(0, self.left), min(grid.rows, self.bottom), min(grid.columns, self.right))
        return Window() if inside.is_empty else inside

    def padded(self, cells: int, grid: Grid) -> Window:
        """The window padded by a number of cells at each side, within the grid; an empty one stays empty."""
        if self.is_empty:
            return self
        larger = Window(self.top - cells, self.left - cells, self.bottom + cells, self.right + cells)
        return larger.within(grid)

    def joined(self, other: Window) -> Window:
        """The smallest window around both."""
        if self.is_empty or other.is_empty:
            return other if self.is_empty else self
        return Window(
            min(self.top, other.top),
            min(self.left, other.left),
            max(self.bottom, other.bottom),
            max(self.right, other.right),
        )


@dataclass(frozen=True, slots=True)
class Moment:
    """Time and robot pose of an update.

    Attributes:
        x, y: of the robot, in metres, in the frame of the costmap.
        footprint: the corners of the robot in that frame, in metres, of shape (corners, 2).
        inscribed_radius: of the circle in the footprint about the robot, in metres.
        time_ns: when it is.
    """

    x: float
    y: float
    footprint: Footprint
    inscribed_radius: float
    time_ns: int


class Layer(ABC):
    """The base class of layers.

    Attributes:
        enabled: whether the layer contributes to the costmap.
        is_clearable: whether clearing a region of the costmap clears the layer.
    """

    enabled: bool = True
    is_clearable: bool = False

    def match(self, grid: Grid, default: int) -> None:  # noqa: B027  # most keep nothing
        """Adopt a new size or origin of the costmap; `default` is the cost of its cells without layers."""

    @abstractmethod
    def changed(self, window: Window, moment: Moment, grid: Grid) -> Window:
        """Process new data, and return the window whose costs change.

        Args:
            window: the window that changed in the layers below.
            moment: now.
            grid: the costmap.

        Returns:
            The window that changes with this layer.
        """

    @abstractmethod
    def write(self, grid: Grid, window: Window, moment: Moment) -> None:
        """Write costs into the cells of the window."""

    def reset(self) -> None:  # noqa: B027  # most keep nothing
        """Reset to the state before any data."""

    def clear(self, window: Window, *, outside: bool) -> None:  # noqa: B027  # of those that can be cleared
        """Clear the data in a window, or all outside of it."""

    def is_current(self, time_ns: int) -> bool:
        """Whether its data are recent enough."""
        return True


class SeenLayer(Layer):
    """A layer with cells of its own, which keep their values until they are cleared.

    Attributes:
        seen: costs, as large as the costmap.
    """

    is_clearable = True

    def __init__(self) -> None:
        self.seen = Grid(cells=np.zeros((0, 0), np.uint8), resolution=1.0)
        self._default = FREE
        self._extra = Window()

    def match(self, grid: Grid, default: int) -> None:
        """Keep the cells that are still in the costmap after it moved."""
        cells = shifted(self.seen.cells, self.seen, grid, default)
        self.seen = Grid(cells=cells, resolution=grid.resolution, x=grid.x, y=grid.y)
        self._default = default
        self._extra = Window.of(grid)

    def reset(self) -> None:
        """Clear all cells."""
        self.seen.cells[:] = self._default
        self._extra = Window.of(self.seen)

    def clear(self, window: Window, *, outside: bool) -> None:
        """Clear the cells in a window, or all others."""
        kept = self.seen.cells[window.cells].copy()
        if outside:
            self.seen.cells[:] = UNKNOWN
            self.seen.cells[window.cells] = kept
        else:
            self.seen.cells[window.cells] = UNKNOWN
        self._extra = Window.of(self.seen)

    def pop_extra(self) -> Window:
        """The window that changed other than by observations since the last call."""
        extra, self._extra = self._extra, Window()
        return extra


def shifted(cells: NDArray[Any], old: Grid, new: Grid, fill: int) -> NDArray[Any]:
    """The cells of a grid that are also in another one, in their places there; `fill` in the others."""
    moved = np.full((new.rows, new.columns), fill, cells.dtype)
    if old.resolution != new.resolution:
        return moved
    rows, columns = round((new.y - old.y) / new.resolution), round((new.x - old.x) / new.resolution)
    both = Window(-rows, -columns, old.rows - rows, old.columns - columns).within(new)
    if not both.is_empty:
        source = Window(both.top + rows, both.left + columns, both.bottom + rows, both.right + columns)
        moved[both.cells] = cells[source.cells]
    return moved


def footprint_window(moment: Moment, grid: Grid) -> Window:
    """The window around the robot's footprint."""
    return Window.around(grid.cells_of(moment.footprint), grid)


def free_footprint(cells: Costs, moment: Moment, grid: Grid, window: Window) -> None:
    """Free the cells below the robot's footprint."""
    inside = footprint_window(moment, grid)
    inside = Window(
        max(inside.top, window.top),
        max(inside.left, window.left),
        min(inside.bottom, window.bottom),
        min(inside.right, window.right),
    )
    if inside.is_empty:
        return
    rows, columns = np.mgrid[inside.top : inside.bottom, inside.left : inside.right]
    centres = grid.centres_of(np.stack((rows, columns), axis=-1))
    cells[inside.cells][within_polygon(centres, moment.footprint)] = FREE
