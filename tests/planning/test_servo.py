"""Servo: velocities of the tip, and what slows and halts them."""

from __future__ import annotations

from math import exp, log

import numpy as np
import pytest

from linkwright.planning.servo import Condition, Servo, ServoSettings
from tests.planning.arms import arm

pytestmark = pytest.mark.extra("arm")

SETTINGS = ServoSettings(np.full(6, 0.1))
BENT = {"lift": 0.6, "elbow": 1.2, "bend": 1.0}


def servo(**joints: float) -> Servo:
    result = Servo(arm().model, arm().group, SETTINGS)
    result.reset(arm().positions(**joints or BENT))
    return result


def tip(positions: np.ndarray) -> np.ndarray:
    arm().model.move(positions)
    return arm().model.link_pose("tool")


def test_tip_moves_with_the_commanded_velocity() -> None:
    moving = servo()
    start = tip(moving.positions)
    for _ in range(100):
        moving.step_twist(np.array((0.0, 0.1, 0.05, 0.0, 0.0, 0.0)))
    offset = tip(moving.positions) - start
    # The filter delays the motion by less than two periods.
    np.testing.assert_allclose(offset[:3], (0.0, 0.1, 0.05), atol=0.003)
    np.testing.assert_allclose(offset[3:], 0.0, atol=2e-3)
    assert moving.condition is Condition.NO_WARNING


def test_tip_does_not_drift_on_a_circle() -> None:
    moving = servo(lift=0.3, elbow=1.6, bend=1.2)
    start = tip(moving.positions)
    for number in range(1000):
        angle = 2.0 * np.pi * number / 500.0
        moving.step_twist(0.06 * np.array((np.sin(angle), np.cos(angle), 0.0, 0.0, 0.0, 0.0)))
    np.testing.assert_allclose(tip(moving.positions)[:3], start[:3], atol=2e-3)
    np.testing.assert_allclose(tip(moving.positions)[3:], start[3:], atol=2e-3)


def test_tip_that_may_turn_moves_where_it_would_halt_in_a_singularity() -> None:
    """With the wrist straight, two of its axes are the same, and the arm cannot turn the tip in every direction."""
    moving = servo(lift=0.6, elbow=1.2)
    moving.step_twist(np.array((0.0, 0.1, 0.05, 0.0, 0.0, 0.0)))
    assert moving.condition is Condition.HALT_FOR_SINGULARITY
    start = tip(moving.positions)
    moving.drifts[3:] = True
    for _ in range(100):
        moving.step_twist(np.array((0.0, 0.1, 0.05, 0.0, 0.0, 0.0)))
        assert moving.condition is Condition.NO_WARNING
    np.testing.assert_allclose(tip(moving.positions)[:3] - start[:3], (0.0, 0.1, 0.05), atol=0.003)
    assert not np.allclose(tip(moving.positions)[3:], start[3:], atol=0.05)


def test_one_dimension_is_kept_if_the_tip_may_drift_in_all_of_them() -> None:
    moving = servo()
    start = tip(moving.positions)
    moving.drifts[:] = True
    for _ in range(50):
        moving.step_twist(np.array((0.1, 0.1, 0.1, 0.0, 0.0, 0.0)))
    assert tip(moving.positions)[0] - start[0] == pytest.approx(0.05, abs=0.003)


def test_halt_is_smooth_and_complete() -> None:
    moving = servo()
    for _ in range(20):
        moving.step_joints(np.array((1.0, 0.0, 0.0, 0.0, 0.0, 0.0)))
    assert moving.velocities[0] == pytest.approx(1.0, abs=1e-3)
    speeds = []
    for _ in range(20):
        moving.step_halt()
        speeds.append(float(moving.velocities[0]))
    assert np.all(np.diff(speeds) <= 0.0)
    assert 0.0 < speeds[0] < 1.0
    assert moving.is_at_rest


def test_velocities_above_the_limit_are_scaled_together() -> None:
    moving = servo()
    for _ in range(30):
        moving.step_joints(np.array((4.0, -2.0, 0.0, 0.0, 0.0, 0.0)))
    np.testing.assert_allclose(moving.velocities[:2], (2.0, -1.0), atol=1e-3)


@pytest.mark.parametrize(("halt_all", "other"), [(True, 0.0), (False, 0.5)])
def test_joint_halts_before_its_bound(halt_all: bool, other: float) -> None:
    moving = servo(pan=2.6)
    moving.halts_all_joints = halt_all
    for _ in range(200):
        moving.step_joints(np.array((1.0, 0.0, 0.0, 0.0, 0.0, 0.5)))
        if moving.condition is Condition.JOINT_BOUND:
            break
    for _ in range(10):
        moving.step_joints(np.array((1.0, 0.0, 0.0, 0.0, 0.0, 0.5)))
    assert moving.condition is Condition.JOINT_BOUND
    assert 2.7 < moving.group_positions[0] < 2.75
    assert moving.velocities[5] == pytest.approx(other, abs=1e-2)
    for _ in range(20):
        moving.step_joints(np.array((-1.0, 0.0, 0.0, 0.0, 0.0, 0.0)))
    assert moving.group_positions[0] < 2.7


def test_motion_toward_a_singularity_slows_and_leaves_it() -> None:
    """The stretched arm cannot move outward."""
    moving = servo(lift=1.0, elbow=0.6, bend=1.5)
    outward = tip(moving.positions)[:3] - (0.0, 0.0, 0.2)
    twist = np.concatenate((0.2 * outward / np.linalg.norm(outward), np.zeros(3)))
    speeds = []
    before = tip(moving.positions)[:3]
    while len(speeds) < 15:
        moving.step_twist(twist)
        after = tip(moving.positions)[:3]
        if moving.condition is Condition.DECELERATE_FOR_APPROACHING_SINGULARITY:
            speeds.append(float(np.linalg.norm(after - before)))
        before = after
    assert np.all(np.diff(speeds[5:]) < 0.0)  # the filter accelerates at first
    moving.step_twist(-twist)
    assert moving.condition is Condition.DECELERATE_FOR_LEAVING_SINGULARITY
    for _ in range(40):
        moving.step_twist(-twist)
    assert moving.condition in (Condition.DECELERATE_FOR_LEAVING_SINGULARITY, Condition.NO_WARNING)
    assert float((tip(moving.positions)[:3] - before) @ twist[:3]) < -0.001


def test_stretched_arm_halts_at_last() -> None:
    moving = servo(lift=1.0, elbow=0.6, bend=0.5)
    for _ in range(2000):
        moving.step_twist(np.array((0.1, 0.0, 0.0, 0.0, 0.0, 0.0)))
    assert np.abs(moving.velocities).max() < 0.05
    assert moving.condition is not Condition.NO_WARNING


def test_singularity_halts() -> None:
    moving = servo(lift=0.0)
    moving.step_twist(np.array((0.0, 0.0, 0.1, 0.0, 0.0, 0.0)))
    assert moving.condition is Condition.HALT_FOR_SINGULARITY
    assert moving.is_at_rest


@pytest.mark.parametrize(
    ("to_self", "to_world", "scale"),
    [(1.0, 1.0, 1.0), (1.0, 0.0, 0.0), (0.005, 1.0, exp(log(0.001) / 2)), (1.0, 0.02 / 3, exp(log(0.001) * 2 / 3))],
)
def test_share_near_collisions(to_self: float, to_world: float, scale: float) -> None:
    moving = servo()
    moving.set_clearances(to_self, to_world)
    assert moving.collision_scale == pytest.approx(scale)
    moving.step_joints(np.ones(6))
    expected = Condition.NO_WARNING if scale == 1.0 else Condition.DECELERATE_FOR_COLLISION
    assert moving.condition is (expected if scale else Condition.HALT_FOR_COLLISION)
