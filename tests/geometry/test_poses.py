"""Poses as rows, compared with homogeneous matrices."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from linkwright.geometry.arrays import IDENTITY, compose, invert, matrix_from_pose, quaternion_from_rpy

places = arrays(np.float64, 3, elements=st.floats(-10, 10))
triples = arrays(np.float64, 3, elements=st.floats(-pi, pi))
poses = st.builds(lambda xyz, rpy: np.concatenate((xyz, quaternion_from_rpy(rpy))), places, triples)


@given(poses, poses)
def test_compose_matches_matrix_product(a, b):
    np.testing.assert_allclose(matrix_from_pose(compose(a, b)), matrix_from_pose(a) @ matrix_from_pose(b), atol=1e-9)


@given(poses)
def test_pose_and_inverse_cancel(pose):
    for product in (compose(pose, invert(pose)), compose(invert(pose), pose)):
        np.testing.assert_allclose(matrix_from_pose(product), np.eye(4), atol=1e-9)


@given(poses)
def test_composing_with_identity_keeps_pose(pose):
    np.testing.assert_array_equal(compose(pose, IDENTITY), pose)
    np.testing.assert_allclose(compose(IDENTITY, pose), pose, atol=1e-12)


def test_compose_transforms_position_in_rotated_frame():
    turned = np.concatenate(([1, 2, 3], quaternion_from_rpy([0, 0, pi / 2])))
    np.testing.assert_allclose(compose(turned, [1, 0, 0, 0, 0, 0, 1])[:3], [1, 3, 3], atol=1e-12)


def test_leading_axes_broadcast():
    many = np.broadcast_to(IDENTITY, (5, 4, 7))
    assert compose(many, many[0]).shape == (5, 4, 7)
    assert invert(many).shape == (5, 4, 7)
    assert matrix_from_pose(many).shape == (5, 4, 4, 4)


def test_identity_is_read_only():
    with pytest.raises(ValueError, match="read-only"):
        IDENTITY[0] = 1


@pytest.mark.parametrize("shape", [(6,), (2, 8), ()])
def test_wrong_array_shape_is_reported(shape):
    with pytest.raises(ValueError, match=r"a pose must have the shape \(\.\.\., 7\), not \("):
        compose(np.zeros(shape), IDENTITY)
