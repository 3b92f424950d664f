"""Trajectories within limits of jerk: a duration by formula, and all limits on random paths."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.planning.jerk import parameterize_smoothly
from linkwright.planning.timing import parameterize
from tests.planning.arms import arm
from tests.planning.test_planner import RIGHT, joint_goal, plan, request

pytestmark = pytest.mark.extra("arm")


def largest_jerks(trajectory) -> np.ndarray:
    """Return the largest change of the acceleration by time of each joint, with many points."""
    return np.abs(np.diff(trajectory.accelerations, axis=0) / np.diff(trajectory.times)[:, None]).max(axis=0)


def test_long_line_takes_the_time_of_the_average_longer() -> None:
    line, one = np.array([[0.0], [10.0]]), np.ones(1)
    smooth = parameterize_smoothly(line, one, one, 20.0 * one)
    assert smooth.duration == pytest.approx(10.0 / 1.0 + 1.0 / 1.0 + 2.0 * 1.0 / 20.0, rel=0.01)


def test_short_line_with_little_jerk_uses_a_smaller_acceleration() -> None:
    line, one = np.array([[0.0], [1.0]]), np.ones(1)
    smooth = parameterize_smoothly(line, 10.0 * one, 100.0 * one, 32.0 * one)
    fastest_by_formula = (32.0 * 1.0 / 32.0) ** (1.0 / 3.0)
    assert fastest_by_formula <= smooth.duration < 1.5 * fastest_by_formula


@settings(max_examples=25, deadline=None)
@given(st.integers(min_value=0, max_value=2**32 - 1), st.sampled_from((0.1, 0.0)))
def test_all_limits_hold_on_random_paths(seed: int, max_deviation: float) -> None:
    random = np.random.default_rng(seed)
    joints = int(random.integers(1, 8))
    corners = random.uniform(-2.0, 2.0, (int(random.integers(2, 7)), joints))
    velocities, accelerations = random.uniform(0.5, 3.0, joints), random.uniform(0.5, 6.0, joints)
    jerks = random.uniform(1.0, 60.0, joints)
    jerks[random.uniform(size=joints) < 0.2] = np.inf
    jerks[0] = 5.0
    trajectory = parameterize_smoothly(
        corners, velocities, accelerations, jerks, max_deviation=max_deviation, interval_s=0.01
    )
    assert np.all(np.diff(trajectory.times) > 0.0)
    assert np.all(np.abs(trajectory.velocities) <= velocities)
    assert np.all(np.abs(trajectory.accelerations) <= accelerations)
    assert np.all(largest_jerks(trajectory) <= jerks * 1.001)
    np.testing.assert_allclose(trajectory.positions[[0, -1]], corners[[0, -1]], atol=1e-6)
    np.testing.assert_allclose(trajectory.velocities[[0, -1]], 0.0, atol=1e-6)
    changes = np.diff(trajectory.positions, axis=0) / np.diff(trajectory.times)[:, None]
    middles = (trajectory.velocities[1:] + trajectory.velocities[:-1]) / 2.0
    np.testing.assert_allclose(changes, middles, atol=0.01)


def test_stops_at_corners_keep_the_path() -> None:
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    smooth = parameterize_smoothly(corners, np.ones(2), np.ones(2), np.full(2, 2.0), max_deviation=0.0)
    assert np.minimum(np.abs(smooth.positions[:, 1]), np.abs(smooth.positions[:, 0] - 1.0)).max() < 1e-6


def test_without_limits_of_jerk_the_trajectory_is_the_fastest() -> None:
    corners = np.array([[0.0, 0.0], [1.0, 0.5]])
    smooth = parameterize_smoothly(corners, np.ones(2), np.ones(2), np.full(2, np.inf))
    assert smooth.duration == parameterize(corners, np.ones(2), np.ones(2)).duration


def test_plan_obeys_the_jerk_of_its_group() -> None:
    group = replace(arm().group, max_jerks=np.full(6, 5.0))
    trajectory = plan(replace(request(joint_goal(**RIGHT)), group=group, interval_s=0.01))
    assert np.all(largest_jerks(trajectory) <= 5.0 * 1.001)
