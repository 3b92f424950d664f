"""Base classes of costmap layers, and the windows of cells that they update."""

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
    """A rectangle of cells: rows `top` to `bottom`, columns `left` to `right`, ends excluded."""

    top: int = 0
    left: int = 0
    bottom: int = 0
    right: int = 0

    @classmethod
    def of(cls, grid: Grid) -> Window:
        """Return the window that covers a whole grid."""
        return cls(0, 0, grid.rows, grid.columns)

    @classmethod
    def around(cls, indices: NDArray[np.int64], grid: Grid) -> Window:
        """Return the smallest window that contains some cells, clipped to the grid.

        `indices` are the rows and columns of the cells, of shape (n, 2); without cells, the window is empty.
        """
        if not len(indices):
            return cls()
        (top, left), (bottom, right) = indices.min(axis=0), indices.max(axis=0) + 1
        return cls(int(top), int(left), int(bottom), int(right)).clipped_to(grid)

    @property
    def is_empty(self) -> bool:
        """Whether the window contains no cells."""
        return self.bottom <= self.top or self.right <= self.left

    @property
    def cells(self) -> tuple[slice, slice]:
        """The array index that selects the window's cells."""
        return slice(self.top, self.bottom), slice(self.left, self.right)

    def clipped_to(self, grid: Grid) -> Window:
        """Return the part of the window within a grid, or an empty window."""
        clipped = Window(
            max(0, self.top), max(0, self.left), min(grid.rows, self.bottom), min(grid.columns, self.right)
        )
        return Window() if clipped.is_empty else clipped

    def padded(self, cells: int, grid: Grid) -> Window:
        """Return the window padded by a number of cells on each side, clipped to the grid.

        An empty window stays empty.
        """
        if self.is_empty:
            return self
        padded_window = Window(self.top - cells, self.left - cells, self.bottom + cells, self.right + cells)
        return padded_window.clipped_to(grid)

    def union(self, other: Window) -> Window:
        """Return the smallest window that contains this window and another."""
        if self.is_empty or other.is_empty:
            return other if self.is_empty else self
        return Window(
            min(self.top, other.top),
            min(self.left, other.left),
            max(self.bottom, other.bottom),
            max(self.right, other.right),
        )


@dataclass(frozen=True, slots=True)
class UpdateContext:
    """The time of an update, and the robot's position and footprint at that time.

    Attributes:
        x, y: the position of the robot, in meters, in the frame of the costmap.
        footprint: the corners of the robot in that frame, in meters, of shape (corners, 2).
        inscribed_radius: the radius of the circle inscribed in the footprint around the robot, in meters.
        time_ns: the time of the update.
    """

    x: float
    y: float
    footprint: Footprint
    inscribed_radius: float
    time_ns: int


class Layer(ABC):
    """The base class of costmap layers.

    Attributes:
        enabled: whether the layer contributes to the costmap.
        is_clearable: whether clearing a region of the costmap clears the layer.
    """

    enabled: bool = True
    is_clearable: bool = False

    def match_grid(self, grid: Grid, default: int) -> None:  # noqa: B027  # Most layers store no cells.
        """Adapt to a new size or origin of the costmap.

        `default` is the cost of the costmap's cells before any layer writes to them.
        """

    @abstractmethod
    def update_window(self, window: Window, context: UpdateContext, grid: Grid) -> Window:
        """Process new data, and return the window whose costs must be rewritten.

        Args:
            window: the window that changed in the layers below.
            context: the time of the update and the robot's pose.
            grid: the costmap.

        Returns:
            The window that must be rewritten, which includes `window`.
        """

    @abstractmethod
    def write_costs(self, grid: Grid, window: Window, context: UpdateContext) -> None:
        """Write costs into the cells of the window."""

    def reset(self) -> None:  # noqa: B027  # Most layers store no data.
        """Reset the layer's data.

        By default, do nothing.
        """

    def clear(self, window: Window, *, clear_outside: bool) -> None:  # noqa: B027  # Only clearable layers override it.
        """Clear the layer's data in a window, or all data outside the window."""

    def is_current(self, time_ns: int) -> bool:
        """Return whether the layer's data are recent enough."""
        return True


class PersistentLayer(Layer):
    """A layer whose cells keep their values until they are cleared.

    Attributes:
        layer_grid: the layer's cells, on the same grid as the costmap.
    """

    is_clearable = True

    def __init__(self) -> None:
        self.layer_grid = Grid(cells=np.zeros((0, 0), np.uint8), resolution=1.0)
        self._default = FREE
        self._extra_window = Window()

    def match_grid(self, grid: Grid, default: int) -> None:
        """Move the layer's cells to a new grid.

        Cells outside the old grid get the default cost.
        """
        cells = shift_cells(self.layer_grid.cells, self.layer_grid, grid, default)
        self.layer_grid = Grid(cells=cells, resolution=grid.resolution, x=grid.x, y=grid.y)
        self._default = default
        self._extra_window = Window.of(grid)

    def reset(self) -> None:
        """Set all cells to the default cost."""
        self.layer_grid.cells[:] = self._default
        self._extra_window = Window.of(self.layer_grid)

    def clear(self, window: Window, *, clear_outside: bool) -> None:
        """Set the cells in a window, or all cells outside it, to unknown."""
        kept_cells = self.layer_grid.cells[window.cells].copy()
        if clear_outside:
            self.layer_grid.cells[:] = UNKNOWN
            self.layer_grid.cells[window.cells] = kept_cells
        else:
            self.layer_grid.cells[window.cells] = UNKNOWN
        self._extra_window = Window.of(self.layer_grid)

    def pop_extra_window(self) -> Window:
        """Return the window changed by resizing or clearing since the last call."""
        window, self._extra_window = self._extra_window, Window()
        return window


def shift_cells(cells: NDArray[Any], old_grid: Grid, new_grid: Grid, fill: int) -> NDArray[Any]:
    """Return the cells of an old grid on a new grid, with `fill` outside the old grid.

    If the resolutions differ, all cells are `fill`.
    """
    shifted_cells = np.full((new_grid.rows, new_grid.columns), fill, cells.dtype)
    if old_grid.resolution != new_grid.resolution:
        return shifted_cells
    rows, columns = (
        round((new_grid.y - old_grid.y) / new_grid.resolution),
        round((new_grid.x - old_grid.x) / new_grid.resolution),
    )
    overlap = Window(-rows, -columns, old_grid.rows - rows, old_grid.columns - columns).clipped_to(new_grid)
    if not overlap.is_empty:
        source = Window(overlap.top + rows, overlap.left + columns, overlap.bottom + rows, overlap.right + columns)
        shifted_cells[overlap.cells] = cells[source.cells]
    return shifted_cells


def footprint_window(context: UpdateContext, grid: Grid) -> Window:
    """Return the smallest window that contains the robot's footprint."""
    return Window.around(grid.cells_of(context.footprint), grid)


def free_footprint(cells: Costs, context: UpdateContext, grid: Grid, window: Window) -> None:
    """Free the cells of a window whose centers are within the robot's footprint."""
    footprint_cells = footprint_window(context, grid)
    footprint_cells = Window(
        max(footprint_cells.top, window.top),
        max(footprint_cells.left, window.left),
        min(footprint_cells.bottom, window.bottom),
        min(footprint_cells.right, window.right),
    )
    if footprint_cells.is_empty:
        return
    rows, columns = np.mgrid[footprint_cells.top : footprint_cells.bottom, footprint_cells.left : footprint_cells.right]
    centers = grid.centers_of(np.stack((rows, columns), axis=-1))
    cells[footprint_cells.cells][within_polygon(centers, context.footprint)] = FREE
