"""Sequences of motions, which can pass their goals without a stop, as Pilz' industrial motion planner has them.

A motion with a blend radius may leave its path within a sphere around its goal, and is back on the path of the next
motion where that leaves the sphere. Within the sphere, both paths are mixed: from the first one alone to the second one
alone, with a share that has no jump in its first two derivatives. The positions of joints are mixed, so that the blend
meets both paths also for redundant arms.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.planning.groups import JointGroup
from linkwright.planning.planner import Failure, MotionPlanner, Plan, PlanError, PlanRequest
from linkwright.planning.robot_model import RobotModel
from linkwright.planning.sampling import subdivide
from linkwright.planning.smoothing import join
from linkwright.planning.timing import Trajectory

_SEARCH_STEP = 0.01
"""The step in rad or m over all joints in which a path is searched for the sphere of a blend."""
_BISECTIONS = 20
_BLEND_POINTS = 24
"""The number of lines of a blend."""


@dataclass(frozen=True, slots=True, eq=False)
class Command:
    """A planned motion of a sequence.

    Attributes:
        request: the request of the motion.
        plan: the plan of the motion alone.
        blend_radius: the distance in m of the tip from the goal at which the motion may leave its path; 0 to stop.
    """

    request: PlanRequest
    plan: Plan
    blend_radius: float


@dataclass(frozen=True, slots=True, eq=False)
class SequenceMotion:
    """One or more motions of a sequence that move the same group, as one trajectory.

    Attributes:
        group: the group.
        start: the positions of all joints at the start.
        trajectory: the trajectory of the group's joints.
    """

    group: JointGroup
    start: Array
    trajectory: Trajectory


def check_radii(radii: Sequence[float]) -> None:
    """Raise an error if the blend radii of a sequence are not valid.

    Raises:
        PlanError: a radius is negative or not finite, or the last one is not 0.
    """
    if not all(radius >= 0.0 and np.isfinite(radius) for radius in radii):
        raise PlanError(Failure.INVALID_MOTION_PLAN, reason="All blending radii MUST be non negative")
    if radii and radii[-1]:
        raise PlanError(Failure.INVALID_MOTION_PLAN, reason="The last blending radius must be zero")


def join_commands(planner: MotionPlanner, model: RobotModel, commands: Sequence[Command]) -> list[SequenceMotion]:
    """Return the trajectories of a sequence: a new one wherever the group changes.

    Args:
        planner: the planner of the robot among objects.
        model: the robot; it is moved.
        commands: the motions; each starts where the one before ends.

    Raises:
        PlanError: two spheres overlap, a path does not leave its sphere, or a blend collides.
    """
    _check_overlap(model, commands)
    runs: list[list[Command]] = []
    for command in commands:
        if runs and runs[-1][-1].request.group is command.request.group:
            runs[-1].append(command)
        else:
            runs.append([command])
    motions = []
    for run in runs:
        pieces: list[list[Command]] = [[]]
        for command in run:
            pieces[-1].append(command)
            if not command.blend_radius:
                pieces.append([])
        trajectories = [_time_blended(planner, model, piece) for piece in pieces if piece]
        motions.append(SequenceMotion(run[0].request.group, run[0].plan.start, join(trajectories)))
    return motions


def _check_overlap(model: RobotModel, commands: Sequence[Command]) -> None:
    for number, (first, second) in enumerate(pairwise(commands[:-1])):
        radii = first.blend_radius + second.blend_radius
        if not radii or first.request.group is not second.request.group:
            continue
        ends = (_tip_positions(model, command, command.plan.path[-1:])[0] for command in (first, second))
        if np.linalg.norm(np.subtract(*ends)) <= radii:
            reason = f"Overlapping blend radii between command [{number}] and [{number + 1}]."
            raise PlanError(Failure.INVALID_MOTION_PLAN, reason=reason)


def _time_blended(planner: MotionPlanner, model: RobotModel, commands: Sequence[Command]) -> Trajectory:
    """Return the trajectory of motions that are blended with each other."""
    first = commands[0]
    if len(commands) == 1:
        return first.plan.trajectory
    path, scales = first.plan.path, [_scales(first)] * (len(first.plan.path) - 1)
    for before, after in pairwise(commands):
        center = _tip_positions(model, before, path[-1:])[0]
        incoming, outgoing = (
            _split_at_sphere(model, before, way, center, before.blend_radius) for way in (path[::-1], after.plan.path)
        )
        if incoming is None or outgoing is None:
            raise PlanError(Failure.FAILURE, reason="Blend radius too large.")
        blend = _mix(incoming.inside[::-1], outgoing.inside)
        if not planner.is_path_free(after.request, after.plan.start, blend):
            raise PlanError(Failure.FAILURE, reason="the blend of two motions collides")
        kept = len(incoming.outside) - 1
        path = np.concatenate((incoming.outside[::-1], blend[1:], outgoing.outside[1:]))
        slower = tuple(np.minimum(_scales(before), _scales(after)))
        scales = [*scales[:kept], *[slower] * (len(blend) - 1), *[_scales(after)] * (len(outgoing.outside) - 1)]
    velocity_scales, acceleration_scales = np.array(scales).T
    speeds: dict[str, float] = {}
    for command in commands:
        for link, speed in command.request.max_link_speeds.items():
            speeds[link] = min(speed, speeds.get(link, inf))
    request = replace(first.request, max_link_speeds=speeds)
    return planner.time_path(request, first.plan.start, path, (velocity_scales, acceleration_scales))


def _scales(command: Command) -> tuple[float, float]:
    return command.request.velocity_scale, command.request.acceleration_scale


@dataclass(frozen=True, slots=True, eq=False)
class _SplitPath:
    """A path that leaves a sphere: its parts inside and outside, which share a point; shapes (n, joints)."""

    inside: Array
    outside: Array


def _split_at_sphere(
    model: RobotModel, command: Command, path: Array, center: Array, radius: float
) -> _SplitPath | None:
    """Return the parts of a path from the center of a sphere, or None if it does not leave the sphere.

    Args:
        model: the robot; it is moved.
        command: the motion of the path.
        path: the positions of the group's joints, starting at the center, shape (n, joints).
        center: the center in m, shape (3,).
        radius: the radius in m.
    """

    def is_inside(configuration: Array) -> bool:
        return bool(np.linalg.norm(_tip_positions(model, command, configuration[None])[0] - center) < radius)

    for number, (first, last) in enumerate(pairwise(path)):
        line = subdivide(np.array((first, last)), _SEARCH_STEP)
        for inner, outer in pairwise(line):
            if is_inside(outer):
                continue
            for _ in range(_BISECTIONS):
                middle = (inner + outer) / 2.0
                inner, outer = (middle, outer) if is_inside(middle) else (inner, middle)
            return _SplitPath(np.array((*path[: number + 1], outer)), np.array((outer, *path[number + 1 :])))
    return None


def _mix(incoming: Array, outgoing: Array) -> Array:
    """Return the blend of a path to a point and a path from it, shape (n, joints)."""
    shares = np.linspace(0.0, 1.0, _BLEND_POINTS + 1, dtype=np.float64)
    weights = (shares**3 * (10.0 + shares * (6.0 * shares - 15.0)))[:, None]
    first, second = (_resample(path, shares) for path in (incoming, outgoing))
    return np.asarray((1.0 - weights) * first + weights * second, dtype=np.float64)


def _resample(path: Array, shares: Array) -> Array:
    """Return the points of a path at shares of its length."""
    lengths = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))))
    return np.column_stack([np.interp(shares * lengths[-1], lengths, column) for column in path.T])


def _tip_positions(model: RobotModel, command: Command, path: Array) -> Array:
    """Return the positions in m of the tip of a motion along a path of its group, shape (n, 3)."""
    group = command.request.group
    assert group.tip is not None, "only groups with a tip have a blend radius"
    indexes = np.array([model.index(name) for name in group.joint_names])
    positions, tips = command.plan.start.copy(), []
    for configuration in path:
        positions[indexes] = configuration
        model.move(positions)
        tips.append(model.link_pose(group.tip)[:3])
    return np.array(tips)
