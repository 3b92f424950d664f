"""Path followers: the formulas of pure pursuit, limits, obstacles, and whole paths."""

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
    compute_curvature,
    compute_rotation_speed,
    find_carrot,
    limit_speed_in_curve,
)
from linkwright.navigation.following.rotation_shim import RotationShim
from linkwright.navigation.following.sampling import SamplingFollower, SamplingParameters, VelocityLimits
from tests.navigation.following.driving import (
    PERIOD_S,
    control_input,
    drive_along,
    make_empty_floor,
    path_through,
    put_box,
)

CORNER = path_through((0.0, 0.0), (2.0, 0.0), (2.0, 2.0))
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
    def test_full_turn_returns_to_start(self):
        end = predict_poses((1.0, 2.0, 0.3), np.array([[0.5, 0.0, 0.5]]), np.array([4.0 * pi]))[0, 0]
        assert end[:2] == pytest.approx([1.0, 2.0])
        assert wrap_angle(end[2]) == pytest.approx(0.3)

    def test_sideways_motion_is_predicted(self):
        assert predict_poses((0, 0, pi / 2), np.array([[0.0, 1.0, 0.0]]), np.array([2.0]))[0, 0] == pytest.approx(
            [-2.0, 0.0, pi / 2]
        )


class TestPurePursuit:
    @given(x=st.floats(0.05, 2.0), y=st.floats(-1.0, 1.0))
    def test_curvature_leads_to_carrot(self, x, y):
        curvature = compute_curvature(np.array([x, y]))
        turn_angle = 2.0 * np.arctan2(y, x)
        length = turn_angle / curvature if abs(curvature) > 1e-9 else x
        end = predict_poses((0, 0, 0), np.array([[1.0, 0.0, curvature]]), np.array([length]))[0, 0]
        assert end[:2] == pytest.approx([x, y], abs=1e-6)

    def test_carrot_is_intersection_of_lookahead_circle_and_path(self):
        poses_ahead = np.array([[0.0, 0.3], [0.4, 0.3], [1.0, 0.3]])
        carrot = find_carrot(poses_ahead, 0.5)
        assert carrot == pytest.approx([0.4, 0.3])
        assert hypot(*find_carrot(poses_ahead, 0.8)) == pytest.approx(0.8)
        assert find_carrot(poses_ahead, 5.0) == pytest.approx([1.0, 0.3])

    def test_curve_reduces_speed_in_proportion_to_radius(self):
        assert limit_speed_in_curve(0.5, 1.0 / 0.45, 0.9) == pytest.approx(0.25)
        assert limit_speed_in_curve(0.5, 0.1, 0.9) == 0.5

    def test_command_follows_arc_to_carrot(self):
        path = path_through((0.0, 0.1), (3.0, 0.1))
        command = RegulatedPurePursuit().compute_velocity(control_input(path))
        assert command.yaw == pytest.approx(command.x * 2.0 * 0.1 / 0.6**2)

    def test_robot_rotates_to_heading_before_driving(self):
        command = RegulatedPurePursuit().compute_velocity(control_input(path_through((0.0, 0.0), (0.0, 2.0))))
        assert command.x == 0.0
        assert command.yaw == pytest.approx(3.2 * PERIOD_S)

    def test_speed_is_reduced_near_goal_and_obstacles(self):
        near_goal = RegulatedPurePursuit().compute_velocity(control_input(path_through((0.0, 0.0), (0.3, 0.0))))
        assert near_goal.x == pytest.approx(0.5 * 0.3 / 0.6)
        costly = make_empty_floor()
        costly.grid.cells[:] = 200
        assert (
            0.25
            <= RegulatedPurePursuit()
            .compute_velocity(control_input(path_through((0.0, 0.0), (3.0, 0.0)), costmap=costly))
            .x
            < 0.5
        )

    def test_robot_reverses_if_allowed(self):
        follower = RegulatedPurePursuit(PurePursuitParameters(allow_reversing=True, use_rotate_to_heading=False))
        command = follower.compute_velocity(control_input(path_through((0.0, 0.0), (-2.0, 0.0))))
        assert command.x == -0.5

    def test_obstacle_ahead_is_an_error(self):
        costmap = make_empty_floor()
        put_box(costmap, 0.5, 0.0, 0.2, 0.2)
        with pytest.raises(FollowingError, match="obstacle"):
            RegulatedPurePursuit().compute_velocity(
                control_input(path_through((0.0, 0.0), (3.0, 0.0)), costmap=costmap)
            )

    @given(angle=st.floats(-pi, pi), current=st.floats(-1.8, 1.8))
    def test_rotation_speed_respects_acceleration(self, angle, current):
        speed = compute_rotation_speed(angle, current, PERIOD_S, 1.8, 3.2)
        assert abs(speed - current) <= 3.2 * PERIOD_S + 1e-9
        assert abs(speed) <= 1.8 + 1e-9

    def test_speed_limit_is_applied_and_removed(self):
        follower = RegulatedPurePursuit()
        path = path_through((0.0, 0.0), (3.0, 0.0))
        follower.limit_speed(40.0, is_percentage=True)
        assert follower.compute_velocity(control_input(path)).x == pytest.approx(0.2)
        follower.limit_speed(0.3)
        assert follower.compute_velocity(control_input(path)).x == pytest.approx(0.3)
        follower.limit_speed(0.0)
        assert follower.compute_velocity(control_input(path)).x == 0.5


class TestSampling:
    @settings(max_examples=40, deadline=None)
    @given(
        yaw=st.floats(-3.0, 3.0),
        x=st.floats(0.0, 0.26),
        yaw_rate=st.floats(-1.0, 1.0),
        bend=st.floats(-2.0, 2.0),
    )
    def test_command_respects_velocity_and_acceleration_limits(self, yaw, x, yaw_rate, bend):
        follower = SamplingFollower()
        velocity = Velocity(x, 0.0, yaw_rate)
        command = follower.compute_velocity(
            control_input(path_through((0.0, 0.0), (1.0, 0.0), (2.0, bend)), (0.0, 0.0, yaw), velocity)
        )
        limits = follower.parameters.limits
        for old, new, lowest, highest, acceleration in zip(
            velocity, command, limits.min_velocity, limits.max_velocity, limits.acceleration, strict=True
        ):
            assert lowest - 1e-9 <= new <= highest + 1e-9
            assert abs(new - old) <= acceleration * PERIOD_S + 1e-9

    @pytest.mark.parametrize("y", [0.0, 0.25, 0.4])
    def test_robot_avoids_box(self, y):
        costmap = make_empty_floor()
        put_box(costmap, 1.5, y, 0.4, 0.3, grow=0.22)
        poses, _ = drive_along(
            SamplingFollower(), path_through((0.0, 0.0), (3.0, 0.0)), SimpleGoalChecker(), costmap=costmap, cycles=400
        )
        assert costmap.cost_at(poses[:, :2]).max() < 253
        assert poses[-1, 0] > (2.7 if y == 0.4 else 0.9)

    def test_blocked_costmap_is_an_error(self):
        costmap = make_empty_floor()
        costmap.grid.cells[:] = 254
        with pytest.raises(FollowingError):
            SamplingFollower().compute_velocity(control_input(path_through((0.0, 0.0), (3.0, 0.0)), costmap=costmap))


@pytest.mark.parametrize("make", FOLLOWERS)
class TestWholePaths:
    def test_corner_is_followed(self, make):
        poses, velocities = drive_along(make(), CORNER, StoppedGoalChecker())
        assert hypot(*(poses[-1, :2] - CORNER[-1, :2])) <= 0.25
        assert abs(wrap_angle(poses[-1, 2] - pi / 2)) <= 0.25
        distances = np.hypot(*(poses[:, None, :2] - CORNER[None, :, :2]).T).min(axis=0)
        assert distances.max() < 0.3
        assert hypot(*velocities[-1, :2]) <= 0.25

    def test_path_behind_robot_is_followed(self, make):
        path = path_through((0.0, 0.0), (-2.0, 0.0))
        poses, _ = drive_along(make(), path, SimpleGoalChecker())
        assert hypot(*(poses[-1, :2] - (-2.0, 0.0))) <= 0.25

    def test_robot_rotates_to_goal_heading(self, make):
        path = path_through((0.0, 0.0), (1.5, 0.0))
        path[-1, 2] = -2.5
        poses, _ = drive_along(make(), path, SimpleGoalChecker(SimpleGoalParameters(yaw_goal_tolerance=0.05)))
        assert abs(wrap_angle(poses[-1, 2] + 2.5)) <= 0.05


class TestPath:
    def test_self_crossing_path_is_followed_in_order(self):
        eight = path_through((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 2.0), (1.0, -2.0))
        path = FollowedPath(eight, 1.0)
        path.update_progress(1.0, 0.0)
        assert path.compute_remaining_distance(1.0, 0.0) == pytest.approx(8.0, abs=0.06)
        assert path.get_poses_ahead(0.5)[-1, :2] == pytest.approx([1.5, 0.0], abs=0.06)

    def test_poses_ahead_at_path_end_are_two(self):
        path = FollowedPath(path_through((0.0, 0.0), (1.0, 0.0)), 5.0)
        path.update_progress(1.0, 0.0)
        assert len(path.get_poses_ahead(1.0)) == 2


class TestCheckers:
    def test_stateful_goal_checker_remembers_reached_position(self):
        checker = SimpleGoalChecker()
        assert not checker.is_reached((0.1, 0.0, 1.0), (0.0, 0.0, 0.0), ZERO_VELOCITY)
        assert checker.is_reached((0.4, 0.0, 0.1), (0.0, 0.0, 0.0), ZERO_VELOCITY)
        checker.reset()
        assert not checker.is_reached((0.4, 0.0, 0.1), (0.0, 0.0, 0.0), ZERO_VELOCITY)

    def test_stateless_goal_checker_forgets_reached_position(self):
        checker = SimpleGoalChecker(SimpleGoalParameters(stateful=False))
        assert not checker.is_reached((0.1, 0.0, 1.0), (0.0, 0.0, 0.0), ZERO_VELOCITY)
        assert not checker.is_reached((0.4, 0.0, 0.1), (0.0, 0.0, 0.0), ZERO_VELOCITY)

    def test_stopped_goal_checker_requires_zero_velocity(self):
        checker = StoppedGoalChecker()
        assert not checker.is_reached((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), Velocity(0.3))
        assert checker.is_reached((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), ZERO_VELOCITY)

    def test_progress_checker_fails_after_time_allowance(self):
        checker = ProgressChecker()
        assert checker.makes_progress((0.0, 0.0, 0.0), 0)
        assert checker.makes_progress((0.1, 0.0, 3.0), 10_000_000_000)
        assert not checker.makes_progress((0.1, 0.0, 3.0), 10_100_000_000)
        assert checker.makes_progress((0.6, 0.0, 3.0), 10_200_000_000)

    def test_pose_progress_checker_counts_rotation(self):
        checker = ProgressChecker(PoseProgressParameters())
        assert checker.makes_progress((0.0, 0.0, 0.0), 0)
        assert checker.makes_progress((0.0, 0.0, 0.6), 20_000_000_000)
