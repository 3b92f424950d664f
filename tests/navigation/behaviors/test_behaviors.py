"""Behaviors: angles and distances, obstacles, and time allowances."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from linkwright.navigation.behaviors.behaviors import (
    DriveStraight,
    Outcome,
    Spin,
    SpinParameters,
    Wait,
    slow_near_obstacles,
)
from linkwright.navigation.following.follower import Velocity, predict_poses

PERIOD_S = 0.1
START_POSE = (1.0, 2.0, 0.5)


def run_behavior(behavior, is_free=lambda poses: True, start=START_POSE):
    pose, elapsed, speeds = start, 0.0, []
    while True:
        step = behavior.step(pose, elapsed, is_free)
        if step.outcome is not Outcome.RUNNING:
            return step, pose, elapsed, speeds
        speeds.append(step.velocity)
        pose = tuple(predict_poses(pose, np.array([step.velocity]), np.array([PERIOD_S]))[0, 0])
        elapsed += PERIOD_S


@pytest.mark.parametrize("angle", [1.57, -1.57, 2.5 * pi])
def test_spin_turns_by_requested_angle(angle):
    step, pose, _, speeds = run_behavior(Spin(angle, 0.0, SpinParameters(), START_POSE))
    assert step.outcome is Outcome.DONE
    assert step.traveled == pytest.approx(angle, abs=0.1)
    assert pose[2] - START_POSE[2] == pytest.approx(angle, abs=0.1)
    assert max(abs(speed.yaw) for speed in speeds) <= 1.0


@pytest.mark.parametrize("distance", [0.5, -0.3])
def test_drive_straight_covers_requested_distance(distance):
    step, _, _, speeds = run_behavior(DriveStraight(distance, 0.1, 0.0, 2.0, START_POSE))
    assert step.outcome is Outcome.DONE
    assert step.traveled == pytest.approx(abs(distance), abs=0.011)
    assert {np.sign(speed.x) for speed in speeds} == {np.sign(distance)}


def test_drive_straight_stops_before_obstacle():
    start = (0.0, 0.0, 0.0)
    step, pose, _, _ = run_behavior(
        DriveStraight(2.0, 0.2, 0.0, 2.0, start), lambda poses: poses[:, 0].max() < 1.8, start
    )
    assert step.outcome is Outcome.COLLISION
    assert step.velocity == Velocity()
    assert pose[0] < 1.8


def test_drive_straight_ends_after_time_allowance():
    step, _, elapsed, _ = run_behavior(DriveStraight(5.0, 0.1, 3.0, 2.0, START_POSE))
    assert step.outcome is Outcome.TIMEOUT
    assert 3.0 <= elapsed <= 3.11


def test_wait_ends_after_its_duration():
    step, _, elapsed, _ = run_behavior(Wait(2.0))
    assert step.outcome is Outcome.DONE
    assert 2.0 - 1e-9 <= elapsed <= 2.11


def test_velocity_is_reduced_before_obstacle():
    velocity = Velocity(0.5, 0.0, 0.2)
    assert slow_near_obstacles((0.0, 0.0, 0.0), velocity, 1.0, lambda poses: True) == velocity
    slowed = slow_near_obstacles((0.0, 0.0, 0.0), velocity, 1.0, lambda poses: poses[:, 0].max() < 0.27)
    assert 0.2 <= slowed.x <= 0.3
    assert slowed.yaw == pytest.approx(slowed.x * 0.4)
