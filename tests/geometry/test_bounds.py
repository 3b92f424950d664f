"""Bounding boxes along the axes of a frame."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.geometry.arrays import matrix_from_pose, row_from_pose
from linkwright.geometry.shapes import Bounds, Box, Capsule, Cylinder, Sphere, placement, shape_bounds, union
from linkwright.geometry.single import Pose

vectors = st.tuples(*[st.floats(-10, 10)] * 3)
UNIT = Bounds((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))


def test_bounds_of_shapes():
    assert shape_bounds(Box((1, 2, 3))).high == (0.5, 1, 1.5)
    assert shape_bounds(Cylinder(1, 4)).high == (1, 1, 2)
    assert shape_bounds(Capsule(1, 4)).high == (1, 1, 3)
    assert shape_bounds(Sphere(2)) == ((-2, -2, -2), (2, 2, 2))


@given(vectors, vectors, vectors, vectors)
def test_moved_bounds_enclose_moved_corners(first, second, xyz, rpy):
    pose = Pose(xyz, rpy)
    box = Bounds(tuple(map(min, first, second)), tuple(map(max, first, second)))
    corners = np.array(list(product(*zip(box.low, box.high, strict=True))))
    matrix = matrix_from_pose(row_from_pose(pose))
    moved = corners @ matrix[:3, :3].T + matrix[:3, 3]
    bounds = box.moved(placement(pose))
    assert np.allclose(bounds.low, moved.min(axis=0), atol=1e-9)
    assert np.allclose(bounds.high, moved.max(axis=0), atol=1e-9)


def test_size_center_and_diagonal():
    assert UNIT.size == (1, 1, 1)
    assert UNIT.center == (0.5, 0.5, 0.5)
    assert UNIT.diagonal == pytest.approx(3**0.5)


def test_distance_and_nearest_point():
    assert UNIT.distance((0.5, 0.5, 0.5)) == 0
    assert UNIT.distance((4.0, 5.0, 0.5)) == pytest.approx(5.0)
    assert UNIT.nearest((4.0, -5.0, 0.5)) == (1, 0, 0.5)
    assert UNIT.gap(Bounds((4.0, 5.0, 0.0), (5.0, 6.0, 1.0))) == pytest.approx(5.0)


def test_union():
    assert union([]) is None
    assert union([UNIT]) == UNIT
    assert union([UNIT, Bounds((-1.0, 0.5, 0.5), (0.0, 2.0, 0.6))]) == ((-1, 0, 0), (1, 2, 1))
