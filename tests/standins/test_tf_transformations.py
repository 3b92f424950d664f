"""Rotations as tf_transformations has them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.standins import transformations as tf

AXES = sorted(tf._AXES)
ANGLES = st.floats(-3.0, 3.0)
UNIT = st.floats(0.0, 1.0)


def rotation_matrix(axis: int, angle: float) -> np.ndarray:
    cosine, sine = math.cos(angle), math.sin(angle)
    b, c = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[b, b] = matrix[c, c] = cosine
    matrix[c, b], matrix[b, c] = sine, -sine
    return matrix


def test_quarter_turn_has_expected_quaternion():
    assert tf.quaternion_from_euler(0, 0, math.pi / 2) == pytest.approx([0, 0, math.sqrt(0.5), math.sqrt(0.5)])
    assert tf.euler_from_quaternion([0, 0, math.sqrt(0.5), math.sqrt(0.5)]) == pytest.approx((0, 0, math.pi / 2))


def test_all_24_axis_conventions_are_supported():
    assert len(AXES) == 24


@pytest.mark.parametrize("axes", AXES)
@given(i=ANGLES, j=ANGLES, k=ANGLES)
def test_euler_matrix_rotates_about_axes_in_order(axes, i, j, k):
    first, second, third = (
        rotation_matrix("xyz".index(letter), angle) for letter, angle in zip(axes[1:], (i, j, k), strict=True)
    )
    expected = third @ second @ first if axes[0] == "s" else first @ second @ third
    assert tf.euler_matrix(i, j, k, axes)[:3, :3] == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("axes", AXES)
@given(u=UNIT, v=UNIT, w=UNIT)
def test_euler_angles_round_trip_through_matrix(axes, u, v, w):
    matrix = tf.random_rotation_matrix((u, v, w))
    assert tf.euler_matrix(*tf.euler_from_matrix(matrix, axes), axes) == pytest.approx(matrix, abs=1e-6)


@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize("middle_angle", [0.0, math.pi / 2, -math.pi / 2, math.pi])
def test_euler_angles_round_trip_in_gimbal_lock(axes, middle_angle):
    matrix = tf.euler_matrix(0.3, middle_angle, 0.4, axes)
    assert tf.euler_matrix(*tf.euler_from_matrix(matrix, axes), axes) == pytest.approx(matrix, abs=1e-6)


@given(u=UNIT, v=UNIT, w=UNIT)
def test_quaternion_round_trips_through_matrix(u, v, w):
    quaternion = tf.random_quaternion((u, v, w))
    round_trip = tf.quaternion_from_matrix(tf.quaternion_matrix(quaternion))
    assert abs(float(round_trip @ quaternion)) == pytest.approx(1.0)
    assert round_trip[3] >= 0


def test_quaternion_multiply_applies_right_operand_first():
    first, second = tf.quaternion_about_axis(0.3, (1, 0, 0)), tf.quaternion_about_axis(0.7, (0, 0, 1))
    product = tf.quaternion_matrix(tf.quaternion_multiply(second, first))
    assert product == pytest.approx(tf.quaternion_matrix(second) @ tf.quaternion_matrix(first))
    assert tf.quaternion_multiply(first, tf.quaternion_inverse(first)) == pytest.approx([0, 0, 0, 1])
    assert tf.quaternion_conjugate(first) == pytest.approx(tf.quaternion_inverse(first))


def test_slerp_interpolates_halfway():
    start, end = tf.quaternion_about_axis(0.0, (0, 0, 1)), tf.quaternion_about_axis(1.0, (0, 0, 1))
    assert tf.quaternion_slerp(start, end, 0.5) == pytest.approx(tf.quaternion_about_axis(0.5, (0, 0, 1)))
    assert tf.quaternion_slerp(start, -end, 0.5) == pytest.approx(tf.quaternion_about_axis(0.5, (0, 0, 1)))
    assert tf.quaternion_slerp(start, start, 0.5) == pytest.approx(start)


@given(u=UNIT, v=UNIT, w=UNIT)
def test_matrix_is_decomposed_and_composed(u, v, w):
    angles = tf.euler_from_quaternion(tf.random_quaternion((u, v, w)))
    matrix = tf.compose_matrix((1.5, 2.0, 0.5), (0.2, -0.3, 0.4), angles, (1, 2, 3))
    scale, shear, recovered_angles, translate, perspective = tf.decompose_matrix(matrix)
    assert scale == pytest.approx([1.5, 2.0, 0.5])
    assert shear == pytest.approx([0.2, -0.3, 0.4])
    assert translate == pytest.approx([1, 2, 3])
    assert tf.compose_matrix(scale, shear, recovered_angles, translate, perspective) == pytest.approx(matrix, abs=1e-6)


def test_rotation_matrix_about_offset_axis():
    matrix = tf.rotation_matrix(math.pi / 2, (0, 0, 1), (1, 0, 0))
    assert matrix @ [1, 0, 0, 1] == pytest.approx([1, 0, 0, 1])
    assert matrix @ [2, 0, 0, 1] == pytest.approx([1, 1, 0, 1])
    angle, direction, point = tf.rotation_from_matrix(matrix)
    assert tf.rotation_matrix(angle, direction, point) == pytest.approx(matrix)


def test_matrices_are_concatenated_inverted_and_compared():
    transformation = tf.concatenate_matrices(tf.translation_matrix((1, 2, 3)), tf.euler_matrix(0.1, 0.2, 0.3))
    assert tf.concatenate_matrices(transformation, tf.inverse_matrix(transformation)) == pytest.approx(
        tf.identity_matrix()
    )
    assert tf.translation_from_matrix(transformation) == pytest.approx([1, 2, 3])
    assert tf.is_same_transform(transformation, 2 * transformation)
    assert not tf.is_same_transform(transformation, tf.identity_matrix())
    assert tf.scale_matrix(2.0, (1, 1, 1)) @ [1, 1, 2, 1] == pytest.approx([1, 1, 3, 1])
    assert tf.reflection_matrix((0, 0, 1), (0, 0, 1)) @ [5, 6, 3, 1] == pytest.approx([5, 6, -1, 1])


def test_vector_norm_and_unit_vector():
    assert tf.vector_norm((3, 4)) == pytest.approx(5)
    assert tf.unit_vector([(3, 4), (0, 2)], axis=1) == pytest.approx(np.array([[0.6, 0.8], [0, 1]]))


def test_unknown_axes_are_rejected():
    with pytest.raises(ValueError, match="unknown axes 'sxx'"):
        tf.quaternion_from_euler(0, 0, 0, "sxx")
