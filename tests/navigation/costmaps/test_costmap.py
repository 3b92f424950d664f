"""Costs of points and footprints."""

from __future__ import annotations

from math import hypot, pi, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.geometry.polygon import within_polygon
from linkwright.navigation.costmaps.costmap import LETHAL, UNKNOWN, Costmap
from linkwright.navigation.costmaps.footprints import (
    BadFootprintError,
    compute_radii,
    make_circle,
    make_outline,
    pad_footprint,
    parse_footprint,
    place_footprint,
)
from linkwright.navigation.grids.grid import Grid

SQUARE = np.array([[0.2, 0.2], [-0.2, 0.2], [-0.2, -0.2], [0.2, -0.2]])


def empty_costmap(rows: int = 40, columns: int = 60, resolution: float = 0.1) -> Costmap:
    return Costmap(Grid(cells=np.zeros((rows, columns), np.uint8), resolution=resolution, x=-3.0, y=-2.0))


def test_costmap_requires_uint8_cells_without_rotation():
    with pytest.raises(ValueError, match="int8"):
        Costmap(Grid(cells=np.zeros((2, 2), np.int8), resolution=0.1))
    with pytest.raises(ValueError, match="yaw 0, not"):
        Costmap(Grid(cells=np.zeros((2, 2), np.uint8), resolution=0.1, yaw=0.5))


def test_cost_at_point_inside_and_outside_grid():
    costmap = empty_costmap()
    costmap.grid.cells[20, 30] = 77
    assert costmap.cost_at(np.array([[0.05, 0.05], [0.15, 0.05], [9.0, 0.0]])).tolist() == [77, 0, UNKNOWN]
    assert costmap.cost_at(np.array([-3.01, 0.0]), outside_cost=LETHAL) == LETHAL


def test_footprint_cost_uses_only_outline():
    costmap = empty_costmap()
    costmap.grid.cells[20, 30] = 200
    assert costmap.compute_footprint_cost((0.05, 0.05, 0.0), SQUARE) == 0
    assert costmap.compute_footprint_cost((0.25, 0.05, 0.0), SQUARE) == 200


def test_footprint_cost_accepts_arrays_of_poses():
    costmap = empty_costmap()
    costmap.grid.cells[20, 32] = LETHAL
    poses = np.array([[[0.0, 0.05, 0.0], [-0.03, 0.05, pi / 4]], [[1.0, 1.0, 0.0], [2.95, 0.0, 0.0]]])
    costs = costmap.compute_footprint_cost(poses, SQUARE)
    assert costs.tolist() == [[LETHAL, LETHAL], [0, LETHAL]]  # the last footprint leaves the grid


def test_footprint_padding_moves_corners_outward():
    assert pad_footprint(SQUARE, 0.01) == pytest.approx(SQUARE * 1.05)
    assert pad_footprint(np.array([[0.0, 0.1]]), 0.02) == pytest.approx(np.array([[0.0, 0.12]]))


def test_inscribed_and_circumscribed_radius_of_footprint():
    assert compute_radii(SQUARE) == pytest.approx((0.2, 0.2 * sqrt(2)))
    inscribed, circumscribed = compute_radii(make_circle(0.3))
    assert circumscribed == pytest.approx(0.3)
    assert 0.29 < inscribed < 0.3


@given(x=st.floats(-0.5, 0.5), y=st.floats(-0.5, 0.5))
def test_within_polygon_finds_points_in_footprint(x, y):
    is_inside = bool(within_polygon(np.array([x, y]), make_circle(0.3)))
    if hypot(x, y) < compute_radii(make_circle(0.3))[0]:
        assert is_inside
    elif hypot(x, y) > 0.3:
        assert not is_inside


def test_place_footprint_applies_pose():
    assert place_footprint(np.array([[0.2, 0.1]]), 1.0, 2.0, pi / 2) == pytest.approx(np.array([[0.9, 2.2]]))


def test_outline_has_no_gaps():
    rim = make_outline(SQUARE, 0.03)
    gaps = np.hypot(*(np.roll(rim, -1, axis=0) - rim).T)
    assert gaps.max() <= 0.03 + 1e-12


def test_footprint_text_is_parsed_or_rejected():
    assert parse_footprint("[[0.2, 0.2], [-0.2, 0.2], [-0.2,-0.2], [0.2, -0.2] ]").tolist() == SQUARE.tolist()
    for text, reason in (
        ("[]", "not a list"),
        ("[[1, 2], [3, 4]]", "has 2"),
        ("[[1, 2], 3, 4]", "not a list"),
        ("x", "not a list"),
    ):
        with pytest.raises(BadFootprintError, match=reason):
            parse_footprint(text)
