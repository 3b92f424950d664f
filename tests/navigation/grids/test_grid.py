"""Cells and points of a grid."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from linkwright.navigation.grids.grid import Grid


@pytest.fixture
def grid():
    return Grid(cells=np.zeros((3, 4), np.int8), resolution=0.5, x=-1.0, y=2.0)


def test_grid_rows_are_along_y_and_columns_along_x(grid):
    assert (grid.rows, grid.columns) == (3, 4)
    assert grid.cells_of(np.array([[-0.9, 2.1], [0.9, 2.1], [-0.9, 3.4]])).tolist() == [[0, 0], [0, 3], [2, 0]]


def test_points_outside_grid_have_indices_outside(grid):
    indices = grid.cells_of(np.array([[-1.1, 2.1], [1.1, 2.1], [-0.9, 3.6], [-0.9, 2.1]]))
    assert indices.tolist() == [[0, -1], [0, 4], [3, 0], [0, 0]]
    assert grid.contains(indices).tolist() == [False, False, False, True]


@pytest.mark.parametrize("yaw", [0.0, 0.3, pi / 2, -2.0])
def test_cell_centers_map_back_to_cells(yaw):
    grid = Grid(cells=np.zeros((3, 4), np.int8), resolution=0.05, x=-1.0, y=2.0, yaw=yaw)
    indices = np.stack(np.meshgrid(np.arange(3), np.arange(4), indexing="ij"), axis=-1)
    assert (grid.cells_of(grid.centers_of(indices)) == indices).all()


def test_grid_rotates_about_its_corner():
    grid = Grid(cells=np.zeros((3, 4), np.int8), resolution=1.0, x=10.0, y=0.0, yaw=pi / 2)
    assert np.allclose(grid.centers_of(np.array([0, 3])), [9.5, 3.5])
