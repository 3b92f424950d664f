"""Measure inverse kinematics and plans of an arm among a shelf and a table.

Run it with ``python -m benchmarks planning``. The arm has six joints and cylinders for links. The poses and the starts
and goals of plans are random configurations; only problems count for which a search of the benchmark finds a path. The
times are on the clock, because OMPL may wait. The limits are those of the splines that controllers execute.
"""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter

import numpy as np
from numpy.typing import NDArray
from tests.planning.arms import arm

from benchmarks.measure import Row, show
from benchmarks.reachable import has_path
from linkwright.geometry.shapes import Box
from linkwright.planning.collision_scene import CollisionScene, SceneObject
from linkwright.planning.goals import Goal, JointTarget
from linkwright.planning.groups import JointGroup
from linkwright.planning.inverse_kinematics import ChainSolver
from linkwright.planning.planner import MotionPlanner, PlanError, PlanRequest
from linkwright.planning.robot_model import PlacedShape
from linkwright.planning.splines import largest_accelerations, largest_jerks, largest_velocities
from linkwright.planning.timing import Trajectory

_POSE_COUNT, _PLAN_COUNT = 1000, 100
_IK_TIMEOUT_S = 0.05
_PROOF_TIMEOUT_S = 60.0
"""The time in s in which a path must be found for a problem to count."""
_MAX_JERK = 50.0
"""The limit of each joint's jerk in rad/s3."""
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
    group = replace(arm().group, max_jerks=np.full(len(arm().indexes), _MAX_JERK))
    planner, seconds, solved_count, collision_count = MotionPlanner(arm().model, scene), [], 0, 0
    ratios = np.zeros(3)
    problems, discarded_count = _draw_problems(random, scene)
    for start, end in problems:
        targets = {name: JointTarget(end[arm().model.index(name)]) for name in arm().group.joint_names}
        begin = perf_counter()
        try:
            trajectory = planner.plan(PlanRequest(group, start, (Goal(targets),)))
        except PlanError:
            seconds.append(perf_counter() - begin)
            continue
        seconds.append(perf_counter() - begin)
        solved_count += 1
        collision_count += not _is_motion_free(trajectory, start, scene)
        ratios = np.maximum(ratios, _limit_ratios(trajectory, group))
    return [
        Row("plan with its trajectory", 1000.0 * float(np.median(seconds)), "ms", "300 ms"),
        Row("the same, at most for 90 % of the problems", 1000.0 * float(np.quantile(seconds, 0.9)), "ms"),
        Row("solved problems", 100.0 * solved_count / _PLAN_COUNT, "%", "95 %"),
        Row("drawn problems without a path that was found in 60 s, which do not count", float(discarded_count), ""),
        Row("executed motions that collide", float(collision_count), "", "0"),
        Row("largest velocity", 100.0 * float(ratios[0]), "% of its limit", "100 %"),
        Row("largest acceleration", 100.0 * float(ratios[1]), "% of its limit", "100 %"),
        Row("largest jerk", 100.0 * float(ratios[2]), "% of its limit", "100 %"),
    ]


def _limit_ratios(trajectory: Trajectory, group: JointGroup) -> NDArray[np.float64]:
    """Return the largest ratios of velocities, accelerations and jerks to their limits."""
    pairs = (
        (largest_velocities(trajectory), group.max_velocities),
        (largest_accelerations(trajectory), group.max_accelerations),
        (largest_jerks(trajectory), group.max_jerks),
    )
    return np.array([float((values / limits).max()) for values, limits in pairs])


def _is_motion_free(trajectory: Trajectory, start: NDArray[np.float64], scene: CollisionScene) -> bool:
    """Return whether the splines of a trajectory are free, in steps of a tenth of those of the planner."""
    positions = start.copy()
    times = np.linspace(0.0, trajectory.duration, 100 * len(trajectory.times))
    for configuration in trajectory.interpolate(times)[0]:
        positions[arm().indexes] = configuration
        if not scene.is_free(positions):
            return False
    return True


def _draw_problems(
    random: np.random.Generator, scene: CollisionScene
) -> tuple[list[tuple[NDArray[np.float64], NDArray[np.float64]]], int]:
    """Return starts and ends that a path connects, and the number of drawn ones for which none was found."""
    positions, indexes = arm().positions(), arm().indexes

    def is_free(configuration: NDArray[np.float64]) -> bool:
        positions[indexes] = configuration
        return scene.is_free(positions)

    problems: list[tuple[NDArray[np.float64], NDArray[np.float64]]] = []
    discarded_count = 0
    while len(problems) < _PLAN_COUNT:
        start, end = (_sample_free_positions(random, scene) for _ in range(2))
        ends = start[indexes], end[indexes]
        if has_path(*ends, lambda: arm().group.sample(random), is_free, _PROOF_TIMEOUT_S):
            problems.append((start, end))
        else:
            discarded_count += 1
    return problems, discarded_count


def _sample_free_positions(random: np.random.Generator, scene: CollisionScene) -> NDArray[np.float64]:
    while True:
        positions = _sample_positions(random)
        if scene.is_free(positions):
            return positions


if __name__ == "__main__":
    show(rows())
