"""Followers: what pure pursuit's formulas say, limits, obstacles, and whole paths."""

from __future__ import annotations

from math import hypot, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.navigation.following.checkers import (
    PoseProgressParameters,
    ProgressChecker,
    SimpleGoalChecker,
    SimpleGoalParameters,
    StoppedGoalChecker,
)
from linkwright.navigation.following.follower import ZERO_VELOCITY, FollowingError, Velocity, predict_poses, wrap_angle
from linkwright.navigation.following.path import FollowedPath
from linkwright.navigation.following.pure_pursuit import (
    PurePursuitParameters,
    RegulatedPurePursuit,
    curvature_to,
    find_carrot,
    rotation_speed,
    speed_in_curve,
)
from linkwright.navigation.following.rotation_shim import RotationShim
from linkwright.navigation.following.sampling import SamplingFollower, SamplingParameters, VelocityLimits
from tests.navigation.following.driving import PERIOD, drive, floor, line, put_box, situation

CORNER = line((0.0, 0.0), (2.0, 0.0), (2.0, 2.0))
FOLLOWERS = [
    RegulatedPurePursuit,
    SamplingFollower,
    lambda: RotationShim(RegulatedPurePursuit()),
    lambda: SamplingFollower(
        SamplingParameters(
            limits=VelocityLimits(min_velocity=Velocity(0.0, -0.3, -1.0), max_velocity=Velocity(0.4, 0.3, 1.0))
        )
    ),
]


class TestMotions:
    def test_a_circle_is_closed_after_a_whole_turn(self):
        end = predict_poses((1.0, 2.0, 0.3), np.array([[0.5, 0.0, 0.5]]), np.array([4.0 * pi]))[0, 0]
        assert end[:2] == pytest.approx([1.0, 2.0])
        assert wrap_angle(end[2]) == pytest.approx(0.3)

    def test_sideways_and_straight(self):
        assert predict_poses((0, 0, pi / 2), np.array([[0.0, 1.0, 0.0]]), np.array([2.0]))[0, 0] == pytest.approx(
            [-2.0, 0.0, pi / 2]
        )


class TestPurePursuit:
    @given(x=st.floats(0.05, 2.0), y=st.floats(-1.0, 1.0))
    def test_the_arc_ends_at_the_carrot(self, x, y):
        curvature = curvature_to(np.array([x, y]))
        turned = 2.0 * np.arctan2(y, x)
        length = turned / curvature if abs(curvature) > 1e-9 else x
        end = predict_poses((0, 0, 0), np.array([[1.0, 0.0, curvature]]), np.array([length]))[0, 0]
        assert end[:2] == pytest.approx([x, y], abs=1e-6)

    def test_the_carrot_is_where_the_circle_cuts_the_path(self):
        seen = np.array([[0.0, 0.3], [0.4, 0.3], [1.0, 0.3]])
        carrot = find_carrot(seen, 0.5)
        assert carrot == pytest.approx([0.4, 0.3])
        assert hypot(*find_carrot(seen, 0.8)) == pytest.approx(0.8)
        assert find_carrot(seen, 5.0) == pytest.approx([1.0, 0.3])

    def test_curves_slow_down_in_proportion(self):
        assert speed_in_curve(0.5, 1.0 / 0.45, 0.9) == pytest.approx(0.25)
        assert speed_in_curve(0.5, 0.1, 0.9) == 0.5

    def test_it_drives_along_the_arc(self):
        path = line((0.0, 0.1), (3.0, 0.1))
        command = RegulatedPurePursuit().velocity(situation(path))
        assert command.yaw == pytest.approx(command.x * 2.0 * 0.1 / 0.6**2)

    def test_it_turns_before_it_drives_elsewhere(self):
        command = RegulatedPurePursuit().velocity(situation(line((0.0, 0.0), (0.0, 2.0))))
        assert command.x == 0.0
        assert command.yaw == pytest.approx(3.2 * PERIOD)

    def test_it_slows_near_its_end_and_near_obstacles(self):
        near = RegulatedPurePursuit().velocity(situation(line((0.0, 0.0), (0.3, 0.0))))
        assert near.x == pytest.approx(0.5 * 0.3 / 0.6)
        costly = floor()
        costly.grid.cells[:] = 200
        assert 0.25 <= RegulatedPurePursuit().velocity(situation(line((0.0, 0.0), (3.0, 0.0)), costmap=costly)).x < 0.5

    def test_it_backs_up_where_it_may(self):
        follower = RegulatedPurePursuit(PurePursuitParameters(allow_reversing=True, use_rotate_to_heading=False))
        command = follower.velocity(situation(line((0.0, 0.0), (-2.0, 0.0))))
        assert command.x == -0.5

    def test_an_obstacle_ahead_is_an_error(self):
        costmap = floor()
        put_box(costmap, 0.5, 0.0, 0.2, 0.2)
        with pytest.raises(FollowingError, match="obstacle"):
            RegulatedPurePursuit().velocity(situation(line((0.0, 0.0), (3.0, 0.0)), costmap=costmap))

    @given(angle=st.floats(-pi, pi), now=st.floats(-1.8, 1.8))
    def test_turns_keep_to_the_acceleration(self, angle, now):
        speed = rotation_speed(angle, now, PERIOD, 1.8, 3.2)
        assert abs(speed - now) <= 3.2 * PERIOD + 1e-9
        assert abs(speed) <= 1.8 + 1e-9

    def test_a_limit_of_speed_is_kept_and_lifted(self):
        follower = RegulatedPurePursuit()
        path = line((0.0, 0.0), (3.0, 0.0))
        follower.limit_speed(40.0, is_percentage=True)
        assert follower.velocity(situation(path)).x == pytest.approx(0.2)
        follower.limit_speed(0.3)
        assert follower.velocity(situation(path)).x == pytest.approx(0.3)
        follower.limit_speed(0.0)
        assert follower.velocity(situation(path)).x == 0.5


class TestSampling:
    @settings(max_examples=40, deadline=None)
    @given(
        yaw=st.floats(-3.0, 3.0),
        x=st.floats(0.0, 0.26),
        turning=st.floats(-1.0, 1.0),
        bend=st.floats(-2.0, 2.0),
    )
    def test_no_limit_is_exceeded(self, yaw, x, turning, bend):
        follower = SamplingFollower()
        now = Velocity(x, 0.0, turning)
        command = follower.velocity(situation(line((0.0, 0.0), (1.0, 0.0), (2.0, bend)), (0.0, 0.0, yaw), now))
        limits = follower.parameters.limits
        for before, after, least, most, faster in zip(
            now, command, limits.min_velocity, limits.max_velocity, limits.acceleration, strict=True
        ):
            assert least - 1e-9 <= after <= most + 1e-9
            assert abs(after - before) <= faster * PERIOD + 1e-9

    @pytest.mark.parametrize("y", [0.0, 0.25, 0.4])
    def test_it_does_not_touch_a_box(self, y):
        costmap = floor()
        put_box(costmap, 1.5, y, 0.4, 0.3, grow=0.22)
        poses, _ = drive(
            SamplingFollower(), line((0.0, 0.0), (3.0, 0.0)), SimpleGoalChecker(), costmap=costmap, cycles=400
        )
        assert costmap.cost_at(poses[:, :2]).max() < 253
        assert poses[-1, 0] > (2.7 if y == 0.4 else 0.9)

    def test_no_way_at_all_is_an_error(self):
        costmap = floor()
        costmap.grid.cells[:] = 254
        with pytest.raises(FollowingError):
            SamplingFollower().velocity(situation(line((0.0, 0.0), (3.0, 0.0)), costmap=costmap))


@pytest.mark.parametrize("make", FOLLOWERS)
class TestWholePaths:
    def test_a_corner_is_driven(self, make):
        poses, velocities = drive(make(), CORNER, StoppedGoalChecker())
        assert hypot(*(poses[-1, :2] - CORNER[-1, :2])) <= 0.25
        assert abs(wrap_angle(poses[-1, 2] - pi / 2)) <= 0.25
        beside = np.hypot(*(poses[:, None, :2] - CORNER[None, :, :2]).T).min(axis=0)
        assert beside.max() < 0.3
        assert hypot(*velocities[-1, :2]) <= 0.25

    def test_a_path_that_begins_behind_the_robot_is_driven(self, make):
        path = line((0.0, 0.0), (-2.0, 0.0))
        poses, _ = drive(make(), path, SimpleGoalChecker())
        assert hypot(*(poses[-1, :2] - (-2.0, 0.0))) <= 0.25

    def test_the_heading_at_the_goal_is_turned_to(self, make):
        path = line((0.0, 0.0), (1.5, 0.0))
        path[-1, 2] = -2.5
        poses, _ = drive(make(), path, SimpleGoalChecker(SimpleGoalParameters(yaw_goal_tolerance=0.05)))
        assert abs(wrap_angle(poses[-1, 2] + 2.5)) <= 0.05


class TestPath:
    def test_a_path_that_crosses_itself_is_driven_in_its_order(self):
        eight = line((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 2.0), (1.0, -2.0))
        path = FollowedPath(eight, 1.0)
        path.update_progress(1.0, 0.0)
        assert path.remaining_distance(1.0, 0.0) == pytest.approx(8.0, abs=0.06)
        assert path.poses_ahead(0.5)[-1, :2] == pytest.approx([1.5, 0.0], abs=0.06)

    def test_its_end_is_two_poses(self):
        path = FollowedPath(line((0.0, 0.0), (1.0, 0.0)), 5.0)
        path.update_progress(1.0, 0.0)
        assert len(path.poses_ahead(1.0)) == 2


class TestCheckers:
    def test_the_place_counts_once_it_was_reached(self):
        checker = SimpleGoalChecker()
        assert not checker.is_reached((0.1, 0.0, 1.0), (0.0, 0.0, 0.0), ZERO_VELOCITY)
        assert checker.is_reached((0.4, 0.0, 0.1), (0.0, 0.0, 0.0), ZERO_VELOCITY)
        checker.reset()
        assert not checker.is_reached((0.4, 0.0, 0.1), (0.0, 0.0, 0.0), ZERO_VELOCITY)

    def test_without_a_state_it_does_not(self):
        checker = SimpleGoalChecker(SimpleGoalParameters(stateful=False))
        assert not checker.is_reached((0.1, 0.0, 1.0), (0.0, 0.0, 0.0), ZERO_VELOCITY)
        assert not checker.is_reached((0.4, 0.0, 0.1), (0.0, 0.0, 0.0), ZERO_VELOCITY)

    def test_a_robot_that_moves_has_not_stopped(self):
        checker = StoppedGoalChecker()
        assert not checker.is_reached((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), Velocity(0.3))
        assert checker.is_reached((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), ZERO_VELOCITY)

    def test_no_progress_is_noticed_after_the_time_allowed(self):
        checker = ProgressChecker()
        assert checker.makes_progress((0.0, 0.0, 0.0), 0)
        assert checker.makes_progress((0.1, 0.0, 3.0), 10_000_000_000)
        assert not checker.makes_progress((0.1, 0.0, 3.0), 10_100_000_000)
        assert checker.makes_progress((0.6, 0.0, 3.0), 10_200_000_000)

    def test_turning_counts_where_it_is_to(self):
        checker = ProgressChecker(PoseProgressParameters())
        assert checker.makes_progress((0.0, 0.0, 0.0), 0)
        assert checker.makes_progress((0.0, 0.0, 0.6), 20_000_000_000)
