"""Measure inverse kinematics and plans of an arm among a shelf and a table.

Run it with ``python -m benchmarks planning``. The arm has six joints and cylinders for links. The poses and the starts
and goals of plans are random configurations. The times are medians on the clock, because OMPL may wait.
"""

from __future__ import annotations

from time import perf_counter

import numpy as np
from numpy.typing import NDArray
from tests.planning.arms import arm

from benchmarks.measure import Row, show
from linkwright.geometry.shapes import Box
from linkwright.planning.collision_scene import CollisionScene, SceneObject
from linkwright.planning.goals import Goal, JointTarget
from linkwright.planning.inverse_kinematics import ChainSolver
from linkwright.planning.planner import MotionPlanner, PlanError, PlanRequest
from linkwright.planning.robot_model import PlacedShape
from linkwright.planning.timing import Trajectory

_POSE_COUNT, _PLAN_COUNT = 1000, 100
_IK_TIMEOUT_S = 0.05
_BOXES = (
    ((0.3, 0.8, 0.02), (0.6, 0.0, 0.2)),
    ((0.3, 0.8, 0.02), (0.6, 0.0, 0.6)),
    ((0.02, 0.8, 0.8), (0.75, 0.0, 0.4)),
    ((0.8, 0.6, 0.04), (0.0, 0.7, 0.1)),
    ((0.1, 0.1, 0.3), (0.1, 0.6, 0.25)),
)
"""The sizes and the centers of boxes in m: three boards of a shelf, a table, and a box on the table."""


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    random = np.random.default_rng(1)
    return [*_measure_kinematics(random), *_measure_plans(random)]


def _sample_positions(random: np.random.Generator) -> NDArray[np.float64]:
    positions = arm().positions()
    positions[arm().indexes] = arm().group.sample(random)
    return positions


def _measure_kinematics(random: np.random.Generator) -> list[Row]:
    solver, seconds, solved_count = ChainSolver(arm().model, arm().group, "tool"), [], 0
    for _ in range(_POSE_COUNT):
        arm().model.move(_sample_positions(random))
        target, start = arm().model.link_pose("tool"), _sample_positions(random)
        begin = perf_counter()
        solved_count += solver.solve(target, start, _IK_TIMEOUT_S) is not None
        seconds.append(perf_counter() - begin)
    return [
        Row("inverse kinematics, from a random start", 1000.0 * float(np.median(seconds)), "ms", "2 ms"),
        Row("solved poses", 100.0 * solved_count / _POSE_COUNT, "%", "98 %"),
    ]


def _measure_plans(random: np.random.Generator) -> list[Row]:
    origin = np.array((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
    shapes = tuple(PlacedShape(Box(size), np.array((*center, 0.0, 0.0, 0.0, 1.0))) for size, center in _BOXES)
    scene = CollisionScene(arm().robot, arm().shapes, [SceneObject("furniture", shapes, origin)], arm().allowed())
    planner, seconds, solved_count, collision_count = MotionPlanner(arm().model, scene), [], 0, 0
    for _ in range(_PLAN_COUNT):
        start, end = (_sample_free_positions(random, scene) for _ in range(2))
        targets = {name: JointTarget(end[arm().model.index(name)]) for name in arm().group.joint_names}
        begin = perf_counter()
        try:
            trajectory = planner.plan(PlanRequest(arm().group, start, (Goal(targets),)))
        except PlanError:
            seconds.append(perf_counter() - begin)
            continue
        seconds.append(perf_counter() - begin)
        solved_count += 1
        collision_count += not _is_motion_free(trajectory, start, scene)
    return [
        Row("plan with its trajectory", 1000.0 * float(np.median(seconds)), "ms", "300 ms"),
        Row("solved problems", 100.0 * solved_count / _PLAN_COUNT, "%", "95 %"),
        Row("executed motions that collide", float(collision_count), "", "0"),
    ]


def _is_motion_free(trajectory: Trajectory, start: NDArray[np.float64], scene: CollisionScene) -> bool:
    """Return whether the splines of a trajectory are free, in steps of a tenth of those of the planner."""
    positions = start.copy()
    times = np.linspace(0.0, trajectory.duration, 100 * len(trajectory.times))
    for configuration in trajectory.interpolate(times)[0]:
        positions[arm().indexes] = configuration
        if not scene.is_free(positions):
            return False
    return True


def _sample_free_positions(random: np.random.Generator, scene: CollisionScene) -> NDArray[np.float64]:
    while True:
        positions = _sample_positions(random)
        if scene.is_free(positions):
            return positions


if __name__ == "__main__":
    show(rows())
