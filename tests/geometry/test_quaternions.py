"""Quaternions, compared with matrices, and the conventions."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from linkwright.geometry import single as plain
from linkwright.geometry.arrays import (
    quaternion_from_matrix,
    quaternion_from_rpy,
    quaternion_inverse,
    quaternion_multiply,
    rotate,
    rotation_matrix,
)
from tests.geometry.rotations import quaternion_about

angles = st.floats(-pi, pi)
triples = arrays(np.float64, 3, elements=angles)
vectors = arrays(np.float64, 3, elements=st.floats(-10, 10))
X, Y, Z = np.eye(3)


def rotation_about(axis, angle):
    """Return a rotation matrix, by the textbook formula."""
    c, s = np.cos(angle), np.sin(angle)
    return {
        "x": np.array([[1, 0, 0], [0, c, -s], [0, s, c]]),
        "y": np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
        "z": np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
    }[axis]


@given(triples)
def test_rpy_rotates_about_fixed_axes_x_y_z(rpy):
    roll, pitch, yaw = rpy
    expected = rotation_about("z", yaw) @ rotation_about("y", pitch) @ rotation_about("x", roll)
    np.testing.assert_allclose(rotation_matrix(quaternion_from_rpy(rpy)), expected, atol=1e-12)


@given(triples)
def test_quaternion_from_rpy_matches_urdf_reader(rpy):
    np.testing.assert_allclose(quaternion_from_rpy(rpy), plain.quaternion_from_rpy(tuple(rpy)), atol=1e-15)


@given(triples)
def test_matrix_round_trip_keeps_rotation(rpy):
    quaternion = quaternion_from_rpy(rpy)
    round_trip = quaternion_from_matrix(rotation_matrix(quaternion))
    assert round_trip[3] >= 0
    assert abs(np.dot(round_trip, quaternion)) == pytest.approx(1)


@pytest.mark.parametrize("axis", [X, Y, Z, -X, [1, 1, 0] / np.sqrt(2)])
def test_half_turn_matrix_gives_its_axis(axis):
    round_trip = quaternion_from_matrix(rotation_matrix(quaternion_about(axis, pi)))
    assert abs(np.dot(round_trip[:3], axis)) == pytest.approx(1)


@given(triples, triples, vectors)
def test_quaternion_product_applies_second_rotation_first(first, second, vector):
    a, b = quaternion_from_rpy(first), quaternion_from_rpy(second)
    product = quaternion_multiply(a, b)
    np.testing.assert_allclose(rotation_matrix(product), rotation_matrix(a) @ rotation_matrix(b), atol=1e-12)
    np.testing.assert_allclose(rotate(product, vector), rotate(a, rotate(b, vector)), atol=1e-9)


@given(triples, vectors)
def test_rotate_matches_matrix_times_vector(rpy, vector):
    quaternion = quaternion_from_rpy(rpy)
    np.testing.assert_allclose(rotate(quaternion, vector), rotation_matrix(quaternion) @ vector, atol=1e-9)
    np.testing.assert_allclose(rotate(quaternion_inverse(quaternion), rotate(quaternion, vector)), vector, atol=1e-9)


def test_leading_axes_broadcast():
    quaternions = quaternion_from_rpy(np.linspace(0, 1, 45).reshape(5, 3, 3))
    assert quaternions.shape == (5, 3, 4)
    assert rotation_matrix(quaternions).shape == (5, 3, 3, 3)
    assert quaternion_multiply(quaternions, quaternions[0]).shape == (5, 3, 4)
    assert rotate(quaternions[:, :, None], np.zeros((7, 3))).shape == (5, 3, 7, 3)
    assert quaternion_from_rpy(np.zeros((0, 3))).shape == (0, 4)


@pytest.mark.parametrize(
    ("function", "shape", "expected"),
    [
        (quaternion_from_rpy, (4,), r"shape \(\.\.\., 3\), not \(4,\)"),
        (rotation_matrix, (2, 3), r"shape \(\.\.\., 4\), not \(2, 3\)"),
        (quaternion_from_matrix, (4, 4), r"shape \(\.\.\., 3, 3\), not \(4, 4\)"),
        (quaternion_inverse, (), r"shape \(\.\.\., 4\), not \(\)"),
    ],
)
def test_wrong_array_shapes_are_reported(function, shape, expected):
    with pytest.raises(ValueError, match=expected):
        function(np.zeros(shape))
