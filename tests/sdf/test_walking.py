"""The poses of walking figures."""

from __future__ import annotations

from math import pi, sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.geometry.single import Pose, quaternion_from_rpy
from linkwright.sdf.actors import Script, Trajectory, Waypoint
from linkwright.sdf.poses import RawPose
from linkwright.sdf.walking import Walk


def make_path(*points: tuple[float, float, float, float], tension: float = 0.0) -> Trajectory:
    """Return a trajectory through points: time, x, y, yaw."""
    waypoints = (Waypoint(time, RawPose(Pose((x, y, 1.0), (0.0, 0.0, yaw)))) for time, x, y, yaw in points)
    return Trajectory(tension=tension, waypoints=tuple(waypoints))


STRAIGHT = make_path((0, 0, 0, 0), (2, 4, 0, 0))


def pose_at(walk: Walk, seconds: float) -> tuple[float, float]:
    x, y, *_ = walk.pose(seconds)
    return x, y


def test_looping_walk_restarts_and_other_walk_stays_at_end():
    looping_walk, single_walk = (
        Walk(Script(trajectories=(STRAIGHT,))),
        Walk(Script(loop=False, trajectories=(STRAIGHT,))),
    )
    assert pose_at(looping_walk, 1) == pose_at(single_walk, 1) == pytest.approx((2, 0))
    assert pose_at(looping_walk, 2) == pose_at(single_walk, 2) == pytest.approx((4, 0))
    assert pose_at(looping_walk, 3) == pytest.approx((2, 0))
    assert pose_at(single_walk, 3) == pytest.approx((4, 0))


def test_walk_waits_for_delay_and_auto_start():
    delayed = Walk(Script(delay_start=5, trajectories=(STRAIGHT,)))
    assert pose_at(delayed, 4) == (0, 0)
    assert pose_at(delayed, 6) == pytest.approx((2, 0))
    waiting_walk = Walk(Script(auto_start=False, trajectories=(STRAIGHT,)))
    assert pose_at(waiting_walk, 100) == (0, 0)


def test_trajectories_are_walked_in_sequence():
    walk = Walk(Script(trajectories=(STRAIGHT, make_path((0, 4, 0, 0), (2, 4, 4, 0)))))
    assert pose_at(walk, 3) == pytest.approx((4, 2))
    assert pose_at(walk, 5) == pytest.approx((2, 0))


def test_first_waypoint_is_start_regardless_of_time():
    assert pose_at(Walk(Script(trajectories=(make_path((1, 0, 0, 0), (2, 4, 0, 0)),))), 1) == pytest.approx((2, 0))


def test_script_without_waypoints_has_none():
    assert not Walk(Script()).has_waypoints
    assert not Walk(Script(trajectories=(Trajectory(),))).has_waypoints


def test_path_is_curved_and_straight_with_full_tension():
    corner = [(0.0, 0.0, 0.0, 0.0), (1.0, 1.0, 0.0, 0.0), (2.0, 1.0, 1.0, 0.0)]
    # Catmull-Rom: the middle between (0, 0) and (1, 0), with the tangents (0.5, 0) and (0.5, 0.5).
    x, y = pose_at(Walk(Script(trajectories=(make_path(*corner),))), 0.5)
    assert (x, y) == pytest.approx((0.5, -0.0625))
    x, y = pose_at(Walk(Script(trajectories=(make_path(*corner, tension=1.0),))), 0.5)
    assert (x, y) == pytest.approx((0.5, 0.0))


def test_orientation_is_interpolated_on_shorter_arc():
    walk = Walk(Script(trajectories=(make_path((0, 0, 0, 0), (1, 0, 0, pi / 2)),)))
    assert walk.pose(0.5)[3:] == pytest.approx(quaternion_from_rpy((0, 0, pi / 4)))
    walk = Walk(Script(trajectories=(make_path((0, 0, 0, 3), (1, 0, 0, -3)),)))
    assert abs(walk.pose(0.5)[5]) == pytest.approx(1.0)


coordinates = st.floats(-100, 100)
points = st.tuples(st.floats(0.1, 10), coordinates, coordinates, st.floats(-4, 4))


@given(st.lists(points, min_size=1, max_size=6), st.floats(0, 1), st.floats(0, 100))
def test_walk_passes_through_all_waypoints(steps, tension, seconds):
    times = [sum(step[0] for step in steps[:count]) for count in range(len(steps))]
    trajectory = make_path(*((time, *step[1:]) for time, step in zip(times, steps, strict=True)), tension=tension)
    walk = Walk(Script(loop=False, trajectories=(trajectory,)))
    for time, (_, x, y, _yaw) in zip(times, steps, strict=True):
        assert pose_at(walk, time) == pytest.approx((x, y), abs=1e-6)
    assert sqrt(sum(component * component for component in walk.pose(seconds)[3:])) == pytest.approx(1.0)
