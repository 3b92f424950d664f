"""Sequences of motions: blends stay within their spheres, do not stop, keep limits, and are checked for collisions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from linkwright.geometry.arrays import compose
from linkwright.geometry.shapes import Sphere
from linkwright.planning.collision_scene import SceneObject
from linkwright.planning.goals import Goal, LinkTarget
from linkwright.planning.planner import Failure, Method, MotionPlanner, PlanError
from linkwright.planning.robot_model import PlacedShape, RobotModel
from linkwright.planning.sequences import Command, check_radii, join_commands
from linkwright.planning.timing import Trajectory
from tests.planning.arms import arm
from tests.planning.test_planner import IDENTITY, request, scene

pytestmark = pytest.mark.extra("arm")

START = {"lift": 0.6, "elbow": 1.2, "bend": 1.0}


def tips(configurations: np.ndarray) -> np.ndarray:
    positions, rows = arm().positions(), []
    for configuration in configurations:
        positions[arm().indexes] = configuration
        arm().model.move(positions)
        rows.append(arm().model.link_pose("tool")[:3])
    return np.array(rows)


def commands(planner: MotionPlanner, offsets, radii, scales=None) -> list[Command]:
    """Plan straight lines of the tool to offsets from the start."""
    positions, result = arm().positions(**START), []
    arm().model.move(positions)
    first = arm().model.link_pose("tool")
    for number, (offset, radius) in enumerate(zip(offsets, radii, strict=True)):
        region = PlacedShape(Sphere(0.001), first + np.array((*offset, 0.0, 0.0, 0.0, 0.0)))
        goal = Goal(links=(LinkTarget("tool", (region,), orientation=first[3:], tolerances=np.full(3, 0.01)),))
        scale = scales[number] if scales else 1.0
        motion = replace(
            request(goal, start=START), start=positions, method=Method.CARTESIAN_LINE, velocity_scale=scale
        )
        plan = planner.plan_path(motion)
        result.append(Command(motion, plan, radius))
        positions = plan.start.copy()
        positions[arm().indexes] = plan.path[-1]
    return result


def join(offsets, radii, *objects: SceneObject, scales=None) -> tuple[list[Command], Trajectory]:
    planner = MotionPlanner(arm().model, scene(*objects))
    planned = commands(planner, offsets, radii, scales)
    motions = join_commands(planner, RobotModel(arm().robot), planned)
    assert len(motions) == 1
    return planned, motions[0].trajectory


CORNER = ((0.0, 0.12, 0.0), (0.0, 0.12, 0.12))
ZIGZAG = (*CORNER, (0.0, 0.0, 0.12))


def executed(trajectory: Trajectory) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return trajectory.interpolate(np.linspace(0.0, trajectory.duration, 1000))


class TestBlends:
    def test_motion_leaves_its_path_within_the_sphere_only_and_does_not_stop(self) -> None:
        planned, blended = join(CORNER, (0.05, 0.0))
        _, stopping = join(CORNER, (0.0, 0.0))
        positions, velocities, _ = executed(blended)
        path = tips(np.concatenate([command.plan.path for command in planned]))
        points, goal = tips(positions), tips(planned[0].plan.path[-1:])[0]
        from_goal = np.linalg.norm(points - goal, axis=1)
        from_path = np.array([np.linalg.norm(path - point, axis=1).min() for point in points])
        assert from_path[from_goal > 0.052].max() < 0.006
        assert 0.01 < from_goal.min() < 0.05
        assert np.linalg.norm(velocities[100:-100], axis=1).min() > 0.1
        assert blended.duration < 0.95 * stopping.duration

    def test_without_radius_the_motion_stops_at_the_goal(self) -> None:
        planned, stopping = join(CORNER, (0.0, 0.0))
        positions, velocities, _ = executed(stopping)
        distances = np.linalg.norm(tips(positions) - tips(planned[0].plan.path[-1:])[0], axis=1)
        nearest = int(distances[100:-100].argmin()) + 100
        assert distances[nearest] < 1e-3
        assert np.linalg.norm(velocities[nearest]) < 0.05
        assert stopping.duration == pytest.approx(sum(command.plan.trajectory.duration for command in planned))

    def test_three_motions_keep_all_limits(self) -> None:
        _, trajectory = join(ZIGZAG, (0.05, 0.04, 0.0))
        _, velocities, accelerations = executed(trajectory)
        assert np.all(np.abs(velocities) <= arm().group.max_velocities)
        assert np.all(np.abs(accelerations) <= arm().group.max_accelerations)
        assert np.linalg.norm(velocities[100:-100], axis=1).min() > 0.1

    def test_each_motion_keeps_its_scale(self) -> None:
        planned, trajectory = join(CORNER, (0.03, 0.0), scales=(1.0, 0.05))
        positions, velocities, _ = executed(trajectory)
        distances = np.linalg.norm(tips(positions) - tips(planned[0].plan.path[-1:])[0], axis=1)
        is_second = (np.arange(len(distances)) > distances.argmin()) & (distances > 0.04)
        assert np.any(is_second)
        assert np.abs(velocities[is_second]).max() <= 0.05 * 2.0 * 1.001
        assert np.abs(velocities).max() > 0.5


class TestFailures:
    def failure(self, *arguments, **more) -> PlanError:
        with pytest.raises(PlanError) as error:
            join(*arguments, **more)
        return error.value

    def test_blend_that_collides(self) -> None:
        arm().model.move(arm().positions(**START))
        tool = arm().model.link_pose("tool")
        offset = np.array((0.0, 0.0, 0.15, 0.0, 0.0, 0.0, 1.0))
        pen = SceneObject("pen", (PlacedShape(Sphere(0.003), IDENTITY),), offset, link="tool")
        position = compose(tool, offset)[:3] + np.array((0.0, 0.12 - 0.0125, 0.0125))
        post = SceneObject("post", (PlacedShape(Sphere(0.003), IDENTITY),), np.array((*position, 0, 0, 0, 1.0)))
        join(CORNER, (0.0, 0.0), pen, post)
        error = self.failure(CORNER, (0.05, 0.0), pen, post)
        assert (error.failure, str(error)) == (Failure.FAILURE, "the blend of two motions collides")

    def test_radius_larger_than_the_path(self) -> None:
        error = self.failure(CORNER, (0.13, 0.0))
        assert (error.failure, str(error)) == (Failure.FAILURE, "Blend radius too large.")

    def test_overlapping_spheres(self) -> None:
        error = self.failure(ZIGZAG, (0.07, 0.06, 0.0))
        assert error.failure is Failure.INVALID_MOTION_PLAN
        assert str(error) == "Overlapping blend radii between command [0] and [1]."

    @pytest.mark.parametrize("radii", [(-0.1, 0.0), (np.nan, 0.0), (np.inf, 0.0), (0.1, 0.1)])
    def test_invalid_radii(self, radii) -> None:
        with pytest.raises(PlanError) as error:
            check_radii(radii)
        assert error.value.failure is Failure.INVALID_MOTION_PLAN
