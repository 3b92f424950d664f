"""Cells on lines, and rays through an occupancy grid."""

from __future__ import annotations

from math import pi

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from linkwright.navigation.grids.distances import distance_field
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.ray_counts import count_rays
from linkwright.navigation.grids.rays import cast_rays, cells_on_lines

_CELL = st.tuples(st.integers(-40, 40), st.integers(-40, 40))


def test_cells_on_lines_match_bresenham() -> None:
    cells, line = cells_on_lines(np.array([0, 0]), np.array([[2, 4], [-3, 0], [0, 0]]))
    assert cells[line == 0].tolist() == [[0, 0], [1, 1], [1, 2], [2, 3], [2, 4]]
    assert cells[line == 1].tolist() == [[0, 0], [-1, 0], [-2, 0], [-3, 0]]
    assert cells[line == 2].tolist() == [[0, 0]]


def test_cells_on_lines_accepts_no_lines() -> None:
    cells, line = cells_on_lines(np.array([0, 0]), np.empty((0, 2), np.int64))
    assert cells.shape == (0, 2)
    assert line.shape == (0,)


@given(st.lists(st.tuples(_CELL, _CELL), min_size=1, max_size=6))
def test_lines_are_connected_and_stay_within_half_a_cell(lines: list[tuple[tuple[int, int], tuple[int, int]]]) -> None:
    starts, ends = np.array([a for a, _ in lines]), np.array([b for _, b in lines])
    cells, line = cells_on_lines(starts, ends)
    for number, (start, end) in enumerate(zip(starts, ends, strict=True)):
        line_cells = cells[line == number]
        assert (line_cells[0] == start).all()
        assert (line_cells[-1] == end).all()
        assert len(line_cells) == np.abs(end - start).max() + 1
        if len(line_cells) > 1:
            assert (np.abs(np.diff(line_cells, axis=0)).max(axis=1) == 1).all()
            exact = start + np.linspace(0, 1, len(line_cells))[:, None] * (end - start)
            assert np.abs(line_cells - exact).max() <= 0.5 + 1e-9


def test_rays_end_at_walls_and_maximum_range() -> None:
    walls = np.zeros((100, 100), bool)
    walls[:, 80] = True
    field = Grid(cells=distance_field(walls, 0.05), resolution=0.05)
    ranges = cast_rays(field, np.array([1.0, 2.5]), np.array([0.0, pi / 4, pi, pi / 2]), 10.0)
    assert abs(ranges[0] - 3.0) <= 0.05
    assert ranges[2] == ranges[3] == 10.0
    assert ranges[1] == 10.0  # the ray leaves the grid before the wall
    assert cast_rays(field, np.array([1.0, 2.5]), np.array([0.0]), 2.0)[0] == 2.0


def test_rays_are_cast_in_rotated_grid() -> None:
    walls = np.zeros((100, 100), bool)
    walls[:, 80] = True
    field = Grid(cells=distance_field(walls, 0.05), resolution=0.05, x=1.0, y=-2.0, yaw=pi / 2)
    ranges = cast_rays(field, np.array([[0.0, 0.0], [-1.0, 0.0]]), np.array([pi / 2]), 10.0)
    assert np.abs(ranges - 2.0).max() <= 0.05


@given(st.integers(0, 2**32 - 1))
def test_rays_do_not_pass_through_walls(seed: int) -> None:
    random = np.random.default_rng(seed)
    walls = np.zeros((60, 60), bool)
    walls[[0, -1], :] = walls[:, [0, -1]] = True
    field = Grid(cells=distance_field(walls, 0.1), resolution=0.1)
    points = random.uniform(0.3, 5.7, (20, 2))
    angles = random.uniform(-pi, pi, 20)
    ranges = cast_rays(field, points, angles, 20.0)
    directions = np.stack((np.cos(angles), np.sin(angles)), axis=-1)
    with np.errstate(divide="ignore"):
        exact = np.where(directions > 0, (5.95 - points) / directions, (0.05 - points) / directions).min(axis=1)
    ends = points + ranges[:, None] * directions
    assert (ranges < 20.0).all()
    assert ((ends >= -1e-9) & (ends <= 6.0 + 1e-9)).all()
    assert (ranges <= exact + 0.1 / np.abs(directions).max(axis=1)).all()


def test_ray_counts_counts_hits_and_passes() -> None:
    hits, passes = count_rays(
        (1, 5), np.array([0, 0]), np.array([[0, 3], [0, 4], [0, 9]]), np.array([True, False, True])
    )
    assert hits.tolist() == [[0, 0, 0, 1, 0]]
    assert passes.tolist() == [[3, 3, 3, 2, 2]]


def test_distance_field_has_meters_to_nearest_marked_cell() -> None:
    is_marked = np.zeros((3, 4), bool)
    assert np.isposinf(distance_field(is_marked, 0.1)).all()
    is_marked[0, 0] = True
    field = distance_field(is_marked, 0.5)
    assert field[0].tolist() == [0.0, 0.5, 1.0, 1.5]
    assert field[1, 1] == 0.5 * 2**0.5
