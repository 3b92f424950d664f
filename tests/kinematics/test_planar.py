"""Motion in a plane, compared with the closed formulas for arcs."""

from __future__ import annotations

from math import cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as some

from linkwright.kinematics.drives import DifferentialDrive
from linkwright.kinematics.planar import PlanarPose


def approx_pose(pose: PlanarPose) -> tuple[float, float, float]:
    return pose.x, pose.y, pose.yaw


def test_different_wheel_speeds_drive_in_circle():
    place, drive = PlanarPose(), DifferentialDrive(0.2, 0.05, 0.05)
    for _ in range(1000):
        way, turn = drive.motion(0.018, 0.022)
        place.advance(way, 0.0, turn)
    assert approx_pose(place) == pytest.approx((sin(1.0), 1 - cos(1.0), 1.0), abs=1e-6)


@pytest.mark.parametrize("steps", [1, 7, 1000])
def test_follow_arc_has_no_integration_error(steps):
    place = PlanarPose(yaw=0.3)
    for _ in range(steps):
        place.follow_arc(2.0 * 1.5 / steps, 0.0, 1.5 / steps)
    expected = (2.0 * (sin(1.8) - sin(0.3)), 2.0 * (cos(0.3) - cos(1.8)), 1.8)
    assert approx_pose(place) == pytest.approx(expected, abs=1e-12)


def test_full_circle_returns_to_start_forward_and_sideways():
    for forward, sideways in ((1.0, 0.0), (0.0, 1.0), (0.6, -0.8)):
        place = PlanarPose(1.0, 2.0, 0.5)
        for _ in range(12):
            place.follow_arc(forward, sideways, pi / 6.0)
        assert approx_pose(place) == pytest.approx((1.0, 2.0, 0.5 + 2.0 * pi), abs=1e-12)


@given(*[some.floats(-1.0, 1.0)] * 3)
def test_arc_matches_many_small_steps(forward, sideways, turn):
    arc, steps = PlanarPose(), PlanarPose()
    arc.follow_arc(forward, sideways, turn)
    for _ in range(200):
        steps.advance(forward / 200, sideways / 200, turn / 200)
    assert approx_pose(arc) == pytest.approx(approx_pose(steps), abs=1e-5)


@given(some.floats(-2e-6, 2e-6))
def test_almost_straight_arc_is_exact(turn):
    place = PlanarPose()
    place.follow_arc(1.0, 0.0, turn)
    assert approx_pose(place) == pytest.approx((1.0, turn / 2.0, turn), abs=1e-9)
