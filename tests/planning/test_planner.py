"""Plans from goals to trajectories: collisions, failures, straight lines, constraints, planners."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf, pi
from time import perf_counter, sleep

import numpy as np
import pytest

from linkwright.geometry.arrays import quaternion_from_rpy
from linkwright.geometry.shapes import Box, Sphere
from linkwright.planning.collision_scene import CollisionScene, SceneObject
from linkwright.planning.effort import counted_effort, elapsed_s
from linkwright.planning.goals import Goal, JointTarget, LinkTarget, goal_configurations
from linkwright.planning.groups import JointGroup
from linkwright.planning.library import load_ompl
from linkwright.planning.planner import Failure, Method, MotionPlanner, PlanError, PlanRequest
from linkwright.planning.robot_model import PlacedShape
from linkwright.planning.sampling import _PLANNERS, apply_parameters, planner_class, subdivide
from tests.planning.arms import arm

pytestmark = pytest.mark.extra("arm")

IDENTITY = np.array((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
WALL = SceneObject("wall", (PlacedShape(Box((0.6, 0.04, 0.8)), IDENTITY),), np.array((0.5, 0.0, 0.4, 0, 0, 0, 1.0)))
LEFT, RIGHT = {"pan": 0.8, "lift": 0.8, "elbow": 0.9}, {"pan": -0.8, "lift": 0.8, "elbow": 0.9}

WALLS = [
    SceneObject(f"wall{number}", (PlacedShape(Box(size), IDENTITY),), np.array((*center, 0, 0, 0, 1.0)))
    for number, (size, center) in enumerate(
        (((1.9, 0.02, 3.0), (1.05, 0, 0)), ((1.9, 0.02, 3.0), (-1.05, 0, 0)), ((4.0, 4.0, 0.02), (0, 0, 0.75)))
    )
]
"""Two walls on both sides of the arm, and a ceiling: the arm cannot get from one half of the room to the other."""


def scene(*objects: SceneObject) -> CollisionScene:
    return CollisionScene(arm().robot, arm().shapes, objects, arm().allowed())


def joint_goal(**joints: float) -> Goal:
    full = dict.fromkeys(arm().group.joint_names, 0.0) | joints
    return Goal({name: JointTarget(position) for name, position in full.items()})


def request(*goals: Goal, start: dict[str, float] | None = None, **more: object) -> PlanRequest:
    return PlanRequest(arm().group, arm().positions(**(start or LEFT)), goals, **more)  # type: ignore[arg-type]


def plan(plan_request: PlanRequest, *objects: SceneObject):
    return MotionPlanner(arm().model, scene(*objects)).plan(plan_request)


def is_free(trajectory, *objects: SceneObject) -> bool:
    """Check a trajectory in steps of a tenth of those of the planner."""
    checked, positions = scene(*objects), arm().positions()
    for configuration in subdivide(trajectory.positions, 0.002):
        positions[arm().indexes] = configuration
        if not checked.is_free(positions):
            return False
    return True


class TestSampling:
    @pytest.mark.parametrize("planner", ["RRTConnect", "RRT", "BKPIECE1", "LBKPIECE1", "KPIECE1", "PRM", "BITstar"])
    def test_path_leads_around_wall(self, planner: str) -> None:
        trajectory = plan(request(joint_goal(**RIGHT), planner=planner, timeout_s=20.0), WALL)
        np.testing.assert_allclose(trajectory.positions[0][:3], list(LEFT.values()), atol=1e-6)
        np.testing.assert_allclose(trajectory.positions[-1][:3], list(RIGHT.values()), atol=1e-6)
        assert is_free(trajectory, WALL)
        assert np.all(np.abs(trajectory.velocities) <= arm().group.max_velocities)
        assert np.all(np.abs(trajectory.accelerations) <= arm().group.max_accelerations)

    def test_counted_effort_repeats_a_plan_exactly(self) -> None:
        plans = []
        for pause_s in (0.0, 0.0005):  # A slower computer finds the same plan.

            def is_canceled(pause_s: float = pause_s) -> bool:
                sleep(pause_s)
                return False

            planner = MotionPlanner(arm().model, scene(WALL), is_canceled)
            with counted_effort():
                plans.append(planner.plan(request(joint_goal(**RIGHT), timeout_s=1.0)))
        np.testing.assert_array_equal(plans[0].positions, plans[1].positions)
        np.testing.assert_array_equal(plans[0].times, plans[1].times)

    def test_counted_effort_ends_a_search_without_a_path(self) -> None:
        with counted_effort(), pytest.raises(PlanError) as caught:
            plan(request(joint_goal(**RIGHT), timeout_s=0.2), *WALLS)
        assert caught.value.failure is Failure.PLANNING_FAILED

    def test_fingers_with_a_short_range_are_planned_for(self) -> None:
        positions = arm().positions(**LEFT)
        goal = Goal({"left": JointTarget(0.03)})
        trajectory = plan(PlanRequest(arm().groups["gripper"], positions, (goal,)))
        assert trajectory.positions[-1][0] == pytest.approx(0.03)

    def test_scales_slow_the_motion(self) -> None:
        fast = plan(request(joint_goal(pan=0.0)))
        slow = plan(request(joint_goal(pan=0.0), velocity_scale=0.1, acceleration_scale=0.1))
        assert np.max(np.abs(slow.velocities)) <= 0.2
        assert slow.duration > 2.0 * fast.duration

    def test_pose_goal_is_reached(self) -> None:
        orientation = quaternion_from_rpy((pi, 0.0, 0.0))
        region = PlacedShape(Sphere(0.001), np.array((0.35, 0.2, 0.3, 0, 0, 0, 1.0)))
        goal = Goal(links=(LinkTarget("tool", (region,), orientation=orientation, tolerances=np.full(3, 0.01)),))
        trajectory = plan(request(goal))
        positions = arm().positions()
        positions[arm().indexes] = trajectory.positions[-1]
        arm().model.move(positions)
        pose = arm().model.link_pose("tool")
        np.testing.assert_allclose(pose[:3], region.pose[:3], atol=0.001)
        assert abs(float(pose[3:] @ orientation)) > 1.0 - 1e-4

    def test_path_constraint_holds_along_the_path(self) -> None:
        start = {"lift": 0.6, "elbow": 1.2, "bend": pi - 1.8}
        level = Goal(
            links=(
                LinkTarget("tool", (), orientation=np.array((0.0, 1.0, 0.0, 0.0)), tolerances=np.array((0.6, 0.6, 7))),
            )
        )
        goal = joint_goal(**start | {"pan": 1.0})
        trajectory = plan(request(goal, start=start, path_constraint=level))
        positions = arm().positions()
        for configuration in trajectory.positions:
            positions[arm().indexes] = configuration
            assert level.is_met(arm().model, positions)

    def test_splines_between_distant_points_are_checked(self) -> None:
        keeps_pan = Goal({"pan": JointTarget(0.0, above=0.01, below=0.01)})
        plan_request = request(start={}, path_constraint=keeps_pan, interval_s=100.0)
        corners = np.array([[0.0] * 6, [0.5, 0.25] + [0.0] * 4, [0.0, 0.5] + [0.0] * 4])
        with pytest.raises(PlanError):
            MotionPlanner(arm().model, scene()).time_path(plan_request, arm().positions(), corners)


class TestTouches:
    """A path of the straight arm that turns about its base beside a ball."""

    def time_path(self, gap: float, end: float) -> None:
        start = {"lift": pi / 2}
        arm().model.move(arm().positions(**start))
        # The wrist is the thickest part there: a cylinder of 0.03 m about the forearm's axis.
        wrist = arm().model.link_pose("wrist")
        ball = SceneObject(
            "ball",
            (PlacedShape(Sphere(0.05), IDENTITY),),
            np.array((wrist[0] + 0.02, 0.0, wrist[2] - 0.03 - 0.05 - gap, 0, 0, 0, 1.0)),
        )
        path = np.array(([0.3, pi / 2, 0, 0, 0, 0], [end, pi / 2, 0, 0, 0, 0]))
        plan_request = request(start=start)
        planner = MotionPlanner(arm().model, scene(ball))
        planner.time_path(plan_request, arm().positions(**start, pan=0.3), path)

    @pytest.mark.parametrize(("gap", "end"), [(1e-4, -0.3), (1e-5, -0.3), (5e-6, 0.0)])
    def test_near_objects_and_touches_at_the_end_are_accepted(self, gap: float, end: float) -> None:
        self.time_path(gap, end)

    def test_shallow_collision_on_the_way_is_refused(self) -> None:
        with pytest.raises(PlanError):
            self.time_path(-5e-6, -0.3)


class TestFailures:
    def failure(self, plan_request: PlanRequest, *objects: SceneObject) -> PlanError:
        with pytest.raises(PlanError) as error:
            plan(plan_request, *objects)
        return error.value

    def test_start_in_collision_names_the_pair(self) -> None:
        error = self.failure(request(joint_goal(**LEFT), start={"lift": 1.3, "elbow": 0.0}), WALL)
        assert error.failure is Failure.START_STATE_IN_COLLISION
        assert any("wall" in (contact.first, contact.second) for contact in error.contacts)

    def test_goal_in_collision_names_the_pair(self) -> None:
        error = self.failure(request(joint_goal(lift=1.3)), WALL)
        assert error.failure is Failure.GOAL_IN_COLLISION
        assert error.contacts

    def test_goal_outside_of_bounds(self) -> None:
        assert self.failure(request(joint_goal(pan=3.5))).failure is Failure.INVALID_GOAL_CONSTRAINTS

    def test_start_outside_of_bounds(self) -> None:
        error = self.failure(request(joint_goal(), start={"pan": 3.5}))
        assert error.failure is Failure.INVALID_ROBOT_STATE

    def test_start_slightly_outside_of_bounds_is_moved_inside(self) -> None:
        trajectory = plan(request(joint_goal(pan=2.0), start={"pan": 2.85}))
        assert trajectory.positions[0][0] == pytest.approx(2.8)

    def test_pose_out_of_reach(self) -> None:
        region = PlacedShape(Sphere(0.001), np.array((3.0, 0.0, 0.3, 0, 0, 0, 1.0)))
        error = self.failure(request(Goal(links=(LinkTarget("tool", (region,)),)), timeout_s=1.0))
        assert error.failure is Failure.NO_IK_SOLUTION

    def test_goal_behind_closed_walls(self) -> None:
        start = {"pan": pi / 2, "lift": 1.2, "elbow": 0.6}
        error = self.failure(request(joint_goal(**start | {"pan": -pi / 2}), start=start, timeout_s=1.0), *WALLS)
        assert error.failure is Failure.PLANNING_FAILED
        assert str(error) == "no path to the goal was found"

    def test_failure_tells_of_the_same_configuration_without_a_turn(self) -> None:
        start = {"pan": 1.0, "lift": 1.2, "elbow": 0.6}
        turning = replace(arm().group, lower=np.full(6, -6.0), upper=np.full(6, 6.0))
        goal = joint_goal(**start | {"pan": -5.0})
        error = self.failure(replace(request(goal, start=start, timeout_s=0.5), group=turning), *WALLS)
        assert str(error).endswith("; the same configuration is nearer to the start with 'pan' at 1.28")


class TestLines:
    def test_joint_line_is_straight_in_joint_space(self) -> None:
        trajectory = plan(request(joint_goal(**RIGHT), method=Method.JOINT_LINE))
        np.testing.assert_allclose(trajectory.positions[:, 1], LEFT["lift"], atol=1e-6)

    def test_joint_line_does_not_avoid_wall(self) -> None:
        with pytest.raises(PlanError) as error:
            plan(request(joint_goal(**RIGHT), method=Method.JOINT_LINE), WALL)
        assert error.value.failure is Failure.PLANNING_FAILED

    def test_tool_moves_on_a_straight_line(self) -> None:
        start = {"lift": 0.6, "elbow": 1.2, "bend": 1.0}
        arm().model.move(arm().positions(**start))
        first = arm().model.link_pose("tool")
        region = PlacedShape(Sphere(0.001), first + np.array((0.0, 0.1, 0.05, 0, 0, 0, 0)))
        goal = Goal(links=(LinkTarget("tool", (region,), orientation=first[3:], tolerances=np.full(3, 0.01)),))
        trajectory = plan(replace(request(goal, start=start), method=Method.CARTESIAN_LINE))
        direction = np.array((0.0, 0.1, 0.05)) / np.linalg.norm((0.1, 0.05))
        positions = arm().positions()
        for configuration in trajectory.positions:
            positions[arm().indexes] = configuration
            arm().model.move(positions)
            offset = arm().model.link_pose("tool")[:3] - first[:3]
            assert np.linalg.norm(offset - offset @ direction * direction) < 2e-3
        assert np.linalg.norm(offset) == pytest.approx(0.1118, abs=1e-3)


class CancelAtCall:
    """A cancellation at a call, which counts the calls."""

    def __init__(self, number: float = inf) -> None:
        self.number, self.count = number, 0

    def __call__(self) -> bool:
        self.count += 1
        return self.count > self.number


class TestCancellation:
    def cancel(self, plan_request: PlanRequest, is_canceled: CancelAtCall, *objects: SceneObject) -> None:
        """Check that a plan that would take a minute ends when it is canceled."""
        begin = perf_counter()
        with pytest.raises(PlanError) as caught:
            MotionPlanner(arm().model, scene(*objects), is_canceled).plan(replace(plan_request, timeout_s=60.0))
        assert caught.value.failure is Failure.PREEMPTED
        assert perf_counter() - begin < 15.0

    @pytest.mark.parametrize("planner", _PLANNERS)
    def test_search_ends(self, planner: str) -> None:
        start = {"pan": pi / 2, "lift": 1.2, "elbow": 0.6}
        goal = joint_goal(**start | {"pan": -pi / 2})
        self.cancel(request(goal, start=start, planner=planner), CancelAtCall(2000), *WALLS)

    def test_search_for_configurations_of_a_pose_ends(self) -> None:
        far = PlacedShape(Sphere(0.01), np.array((3.0, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0)))
        self.cancel(request(Goal(links=(LinkTarget("tool", (far,)),))), CancelAtCall(2))

    @pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 0.9])
    def test_checks_of_a_motion_end(self, share: float) -> None:
        line = request(joint_goal(pan=0.4, lift=0.8, elbow=0.9), method=Method.JOINT_LINE)
        calls = CancelAtCall()
        MotionPlanner(arm().model, scene(), calls).plan(line)
        assert calls.count > 100
        self.cancel(line, canceled := CancelAtCall(int(share * calls.count)))
        assert canceled.count <= canceled.number + 3

    def test_curve_ends(self) -> None:
        tip = LinkTarget("tool", (PlacedShape(Sphere(0.001), np.array((0.35, 0.3, 0.3, 0.0, 0.0, 0.0, 1.0))),))
        self.cancel(request(Goal(links=(tip,)), method=Method.CARTESIAN_LINE), CancelAtCall(5))

    def test_check_of_a_blend_ends(self) -> None:
        path = np.array((arm().positions(**LEFT), arm().positions(pan=0.4, lift=0.8, elbow=0.9)))[:, arm().indexes]
        planner = MotionPlanner(arm().model, scene(), CancelAtCall(5))
        with pytest.raises(PlanError, match="canceled"):
            planner.is_path_free(request(), arm().positions(**LEFT), path)


@pytest.mark.parametrize(
    ("name", "planner"),
    [
        ("geometric::RRTConnect", "RRTConnect"),
        ("RRTConnectkConfigDefault", "RRTConnect"),
        ("geometric::BKPIECE", "BKPIECE1"),
        ("geometric::LazyPRMstar", None),
    ],
)
def test_planner_by_name(name: str, planner: str | None) -> None:
    assert planner_class(name) == planner


@pytest.mark.parametrize(("parameters", "expected"), [({"range": 0.3}, 0.3), ({"range": 0.0, "unknown": 1}, 0.7)])
def test_planner_gets_its_parameters(parameters: dict[str, float], expected: float) -> None:
    base, geometric = load_ompl().base, load_ompl().geometric
    planner = geometric.RRTConnect(base.SpaceInformation(base.RealVectorStateSpace(2)))
    planner.setRange(0.7)
    apply_parameters(planner, parameters)
    assert planner.getRange() == expected


def test_invalid_numbers_of_link_targets_are_found() -> None:
    target = LinkTarget("tool", orientation=np.array((np.nan, 0.0, 0.0, 1.0)))
    assert Goal(links=(target,)).find_invalid_number() == "tool"
    assert not Goal(links=(LinkTarget("tool"),)).find_invalid_number()


class TestGoalConfigurations:
    @staticmethod
    def find(group: JointGroup, is_valid: Callable[[np.ndarray], bool], **joints: float) -> list[np.ndarray]:
        """Return the configurations for the pose of the tip in the configuration from which the search starts."""
        start = arm().positions(**joints or LEFT)
        arm().model.move(start)
        pose = arm().model.link_pose("tool")
        place = PlacedShape(Sphere(1e-4), np.array((*pose[:3], 0.0, 0.0, 0.0, 1.0)))
        goal = Goal({}, (LinkTarget("tool", (place,), np.zeros(3), pose[3:], np.full(3, 1e-3)),))
        return list(goal_configurations(goal, arm().model, group, start, is_valid, 60.0, lambda: False))

    def test_search_ends_when_no_other_configuration_is_found(self) -> None:
        start = arm().positions(**LEFT)
        with counted_effort():
            found = self.find(arm().group, lambda positions: bool(np.linalg.norm(positions - start) < 0.1))
            assert elapsed_s() < 10.0
        assert len(found) == 1

    def test_configuration_counts_once_if_joints_make_full_turns(self) -> None:
        group = replace(arm().group, lower=np.full(6, -2 * pi), upper=np.full(6, 2 * pi))
        start = arm().positions(**LEFT, roll=1.0, bend=0.9)

        def is_same(positions: np.ndarray) -> bool:
            return bool(np.abs((positions - start + pi) % (2 * pi) - pi).max() < 0.1)

        (found,) = self.find(group, is_same, **LEFT, roll=1.0, bend=0.9)
        assert found == pytest.approx(start, abs=0.02)
