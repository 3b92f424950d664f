"""Trajectories along paths: durations by formula, and limits on random paths."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from linkwright.planning.timing import parameterize

pytestmark = pytest.mark.extra("arm")


class TestStraightPath:
    def test_long_motion_is_a_trapezoid(self) -> None:
        trajectory = parameterize(np.array([[0.0], [1.0]]), np.array([0.5]), np.array([1.0]))
        assert trajectory.duration == pytest.approx(1.0 / 0.5 + 0.5 / 1.0, rel=0.02)
        assert np.max(trajectory.velocities) == pytest.approx(0.5, rel=0.01)

    def test_short_motion_is_a_triangle(self) -> None:
        trajectory = parameterize(np.array([[0.0], [1.0]]), np.array([5.0]), np.array([2.0]))
        assert trajectory.duration == pytest.approx(2.0 * sqrt(1.0 / 2.0), rel=0.01)

    def test_slowest_joint_sets_the_duration(self) -> None:
        trajectory = parameterize(np.array([[0.0, 0.0], [1.0, 2.0]]), np.array([9.0, 9.0]), np.array([1.0, 1.0]))
        assert trajectory.duration == pytest.approx(2.0 * sqrt(2.0), rel=0.01)
        np.testing.assert_allclose(trajectory.positions[:, 1], 2.0 * trajectory.positions[:, 0], atol=1e-9)

    def test_path_without_length_is_a_point(self) -> None:
        trajectory = parameterize(np.array([[0.3], [0.3]]), np.array([1.0]), np.array([1.0]))
        assert trajectory.duration == 0.0
        assert trajectory.positions.tolist() == [[0.3]]


class TestCorners:
    def test_corner_is_rounded_within_the_deviation(self) -> None:
        corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
        rounded = parameterize(corners, np.ones(2), np.ones(2), max_deviation=0.05, interval_s=0.01)
        distance = np.linalg.norm(rounded.positions - corners[1], axis=1).min()
        assert 0.04 < distance <= 0.0501
        stopping = parameterize(corners, np.ones(2), np.ones(2), max_deviation=0.0, interval_s=0.01)
        assert np.linalg.norm(stopping.positions - corners[1], axis=1).min() < 1e-3
        assert stopping.duration == pytest.approx(4.0, rel=0.02)
        assert rounded.duration < stopping.duration

    @settings(max_examples=40)
    @given(st.integers(min_value=0, max_value=2**32 - 1))
    @example(42110437)  # a joint is fastest between two points of an arc
    def test_limits_hold_everywhere(self, seed: int) -> None:
        random = np.random.default_rng(seed)
        joints = int(random.integers(1, 8))
        corners = random.uniform(-2.0, 2.0, (int(random.integers(2, 8)), joints))
        velocities, accelerations = random.uniform(0.5, 3.0, joints), random.uniform(0.5, 6.0, joints)
        trajectory = parameterize(corners, velocities, accelerations, interval_s=0.01)
        assert np.all(np.diff(trajectory.times) > 0.0)
        assert np.all(np.abs(trajectory.velocities) <= velocities)
        assert np.all(np.abs(trajectory.accelerations) <= accelerations)
        np.testing.assert_allclose(trajectory.positions[[0, -1]], corners[[0, -1]], atol=1e-6)
        np.testing.assert_allclose(trajectory.velocities[[0, -1]], 0.0, atol=1e-9)
        steps = np.diff(trajectory.times)[:, None]
        mean_velocities = np.diff(trajectory.positions, axis=0) / steps
        assert np.all(np.abs(mean_velocities) <= velocities)


def test_splines_between_points_follow_the_exact_motion() -> None:
    corners = np.array([[0.0, 0.0], [1.0, 0.3], [0.2, 1.0]])
    coarse, fine = (parameterize(corners, np.ones(2), np.ones(2), interval_s=interval) for interval in (0.1, 0.001))
    positions, velocities, _ = coarse.interpolate(fine.times)
    np.testing.assert_allclose(positions, fine.positions, atol=5e-4)
    np.testing.assert_allclose(velocities, fine.velocities, atol=0.03)
    at_points = coarse.interpolate(coarse.times)
    for values, expected in zip(at_points, (coarse.positions, coarse.velocities, coarse.accelerations), strict=True):
        np.testing.assert_allclose(values, expected, atol=1e-9)
