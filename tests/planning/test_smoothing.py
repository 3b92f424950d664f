"""Smooth trajectories: durations by formula, and all limits on the splines of random paths."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.planning import smoothing
from linkwright.planning.smoothing import parameterize_smoothly
from linkwright.planning.splines import largest_accelerations, largest_jerks, largest_velocities
from linkwright.planning.timing import Trajectory, parameterize
from tests.planning.arms import arm
from tests.planning.test_planner import RIGHT, joint_goal, plan, request

pytestmark = pytest.mark.extra("arm")


def differences_of_accelerations(trajectory: Trajectory) -> np.ndarray:
    """Return the largest change of the acceleration by time of each joint, along the splines."""
    steps = np.linspace(0.0, 1.0, 100, endpoint=False)
    times = np.append(trajectory.times[:-1, None] + steps * np.diff(trajectory.times)[:, None], trajectory.duration)
    accelerations = trajectory.interpolate(times)[2]
    return np.asarray(np.abs(np.diff(accelerations, axis=0) / np.diff(times)[:, None]).max(axis=0))


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
    assert np.all(differences_of_accelerations(trajectory) <= jerks * (1.0 + 1e-6))
    np.testing.assert_allclose(trajectory.positions[[0, -1]], corners[[0, -1]], atol=1e-6)
    np.testing.assert_allclose(trajectory.velocities[[0, -1]], 0.0, atol=1e-6)
    changes = np.diff(trajectory.positions, axis=0) / np.diff(trajectory.times)[:, None]
    middles = (trajectory.velocities[1:] + trajectory.velocities[:-1]) / 2.0
    np.testing.assert_allclose(changes, middles, atol=0.01)


def test_stops_at_corners_keep_the_path() -> None:
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    smooth = parameterize_smoothly(corners, np.ones(2), np.ones(2), np.full(2, 2.0), max_deviation=0.0)
    assert np.minimum(np.abs(smooth.positions[:, 1]), np.abs(smooth.positions[:, 0] - 1.0)).max() < 1e-6


def test_without_limits_of_jerk_little_time_is_lost() -> None:
    corners = np.array([[0.0, 0.0], [1.0, 0.5]])
    smooth = parameterize_smoothly(corners, np.ones(2), np.ones(2), np.full(2, np.inf))
    fastest = parameterize(corners, np.ones(2), np.ones(2))
    assert fastest.duration < smooth.duration < 1.06 * fastest.duration


def test_loose_limit_of_jerk_needs_no_finer_points(monkeypatch) -> None:
    counts = []

    def count_points(*args, **options) -> Trajectory:
        trajectory = parameterize(*args, **options)
        counts.append(len(trajectory.times))
        return trajectory

    monkeypatch.setattr(smoothing, "parameterize", count_points)
    slow = 0.1 * np.ones(2)
    smooth = parameterize_smoothly(np.array([[0.0, 0.0], [1.0, 2.0]]), slow, slow, np.full(2, 300.0))
    assert smooth.duration > 20.0
    assert sum(counts) < 1000.0 * smooth.duration


def test_path_without_length_is_a_point() -> None:
    smooth = parameterize_smoothly(np.zeros((3, 2)), np.ones(2), np.ones(2), np.full(2, np.inf), max_deviation=0.0)
    assert smooth.positions.tolist() == [[0.0, 0.0]]


@settings(max_examples=25, deadline=None)
@given(st.integers(min_value=0, max_value=2**32 - 1), st.sampled_from((0.1, 0.0)), st.booleans())
def test_splines_between_points_keep_the_limits(seed: int, max_deviation: float, limits_jerk: bool) -> None:
    random = np.random.default_rng(seed)
    joints = int(random.integers(1, 8))
    corners = random.uniform(-2.0, 2.0, (int(random.integers(2, 7)), joints))
    velocities, accelerations = random.uniform(0.5, 3.0, joints), random.uniform(0.5, 6.0, joints)
    jerks = random.uniform(1.0, 60.0, joints) if limits_jerk else np.full(joints, np.inf)
    trajectory = parameterize_smoothly(corners, velocities, accelerations, jerks, max_deviation=max_deviation)
    _, executed_velocities, executed_accelerations = trajectory.interpolate(
        np.linspace(0.0, trajectory.duration, 20 * len(trajectory.times))
    )
    assert np.all(np.abs(executed_velocities) <= velocities * (1.0 + 1e-9))
    assert np.all(np.abs(executed_accelerations) <= accelerations * (1.0 + 1e-9))
    assert np.all(differences_of_accelerations(trajectory) <= jerks * (1.0 + 1e-6))


@given(st.integers(min_value=0, max_value=2**32 - 1))
def test_largest_values_of_splines_are_those_between_the_points(seed: int) -> None:
    random = np.random.default_rng(seed)
    rows = random.uniform(-1.0, 1.0, (3, 4, 2))
    trajectory = Trajectory(np.cumsum(random.uniform(0.1, 1.0, 4)) - 0.1, *rows)
    trajectory = replace(trajectory, times=trajectory.times - trajectory.times[0])
    _, velocities, accelerations = trajectory.interpolate(np.linspace(0.0, trajectory.duration, 20_000))
    assert np.all(np.abs(velocities).max(axis=0) <= largest_velocities(trajectory) + 1e-9)
    np.testing.assert_allclose(np.abs(accelerations).max(axis=0), largest_accelerations(trajectory), rtol=0.01)
    np.testing.assert_allclose(differences_of_accelerations(trajectory), largest_jerks(trajectory), rtol=0.05)


def test_plan_obeys_the_jerk_of_its_group() -> None:
    group = replace(arm().group, max_jerks=np.full(6, 5.0))
    trajectory = plan(replace(request(joint_goal(**RIGHT)), group=group, interval_s=0.01))
    assert np.all(differences_of_accelerations(trajectory) <= 5.0 * (1.0 + 1e-6))
