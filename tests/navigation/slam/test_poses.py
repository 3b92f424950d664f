"""Poses in the plane."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from linkwright.navigation.slam.poses import compose, inverse, relative_pose, transform_points, wrap_angles


def test_pose_composed_with_inverse_is_identity():
    poses = np.random.default_rng(1).uniform(-3, 3, (50, 3))
    assert np.allclose(compose(poses, inverse(poses)), 0, atol=1e-12)
    assert np.allclose(compose(poses, relative_pose(poses, poses[::-1]))[:, :2], poses[::-1, :2])


def test_transform_points_matches_compose():
    pose, child = np.array([1.0, 2.0, pi / 2]), np.array([3.0, 0.5, 0.1])
    assert np.allclose(transform_points(pose, child[None, :2]), compose(pose, child)[:2])
    assert compose(pose, child) == pytest.approx([0.5, 5.0, pi / 2 + 0.1])


def test_angles_are_wrapped_to_pi():
    assert wrap_angles(np.array([3 * pi / 2, -3 * pi / 2, 0.1])) == pytest.approx([-pi / 2, pi / 2, 0.1])
