"""Plans of motions: from a goal to a trajectory without collisions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from itertools import islice, pairwise
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.planning.barriers import Barriers
from linkwright.planning.cartesian import ArcError, ArcPoint, arc_poses, follow_poses, line_poses
from linkwright.planning.collision_scene import CollisionScene, Contact
from linkwright.planning.effort import elapsed_s
from linkwright.planning.goals import Goal, goal_configurations
from linkwright.planning.groups import JointGroup
from linkwright.planning.inverse_kinematics import ChainSolver
from linkwright.planning.link_speed import LinkSpeedLimits
from linkwright.planning.motion_checks import RANGE_M, MotionCheck
from linkwright.planning.robot_model import RobotModel
from linkwright.planning.sampling import DEFAULT_PLANNER, SamplingProblem, subdivide
from linkwright.planning.smoothing import parameterize_smoothly
from linkwright.planning.timing import Trajectory

_GOAL_SHARE = 0.3
"""The share of the planning time in which configurations for the goal are searched."""
_MAX_BOUND_VIOLATION = 0.1
"""The distance in rad or m by which the start may be outside of the bounds; it is then moved to the bound."""
_LINE_STEP_M = 0.01
_CHECK_STEP = 0.005
"""The largest step between two checked configurations of a trajectory, in rad or m over all joints."""
_DEVIATIONS = (0.1, 0.02, 0.0)
"""The distances by which corners are rounded, in rad or m; the next one is tried if the trajectory collides."""
_STOP_INTERVAL_S = 0.02
"""The maximum time in s between two points of a trajectory that stops at corners, so that splines keep to the path."""


class Method(Enum):
    """How the path to the goal is found."""

    SAMPLING = "sampling"
    JOINT_LINE = "PTP"
    CARTESIAN_LINE = "LIN"
    CARTESIAN_ARC = "CIRC"


_CARTESIAN = (Method.CARTESIAN_LINE, Method.CARTESIAN_ARC)
"""The methods that need to know only whether the goal can be reached, and not in which configurations."""


class Failure(Enum):
    """Why there is no plan; the names are those of moveit_msgs/msg/MoveItErrorCodes."""

    PLANNING_FAILED = "no path to the goal was found"
    START_STATE_IN_COLLISION = "the start is in collision"
    START_STATE_VIOLATES_PATH_CONSTRAINTS = "the start violates the path constraints"
    GOAL_IN_COLLISION = "the goal is in collision"
    NO_IK_SOLUTION = "the goal is out of reach"
    INVALID_GOAL_CONSTRAINTS = "a joint of the goal is outside of its bounds"
    INVALID_MOTION_PLAN = "there is no arc through the points"
    INVALID_ROBOT_STATE = "a joint of the start is outside of its bounds"
    FAILURE = "two motions of a sequence cannot be blended"
    PREEMPTED = "the planning was canceled"


class PlanError(Exception):
    """Raised when there is no plan.

    Attributes:
        failure: the kind of failure.
        contacts: what collides at the start or at the goal.
    """

    def __init__(self, failure: Failure, contacts: Sequence[Contact] = (), reason: str = "") -> None:
        super().__init__(failure, contacts, reason)  # Pickle calls the class with these.
        self.failure = failure
        self.contacts = contacts
        self._reason = reason

    def __str__(self) -> str:
        return self._reason or self.failure.value


@dataclass(frozen=True, slots=True, eq=False)
class PlanRequest:
    """The parameters of a plan.

    Attributes:
        group: the joints to move.
        start: the positions of all joints in rad or m, in the order of the model.
        goals: the goals; one of them must be reached.
        path_constraint: what must hold along the path, or None.
        method: how the path is found.
        planner: the planner of OMPL for `Method.SAMPLING`.
        planner_parameters: its parameters.
        timeout_s: the maximum planning time in s.
        velocity_scale: the share of the maximum velocities, from 0 to 1.
        acceleration_scale: the share of the maximum accelerations, from 0 to 1.
        interval_s: the time in s between two points of the trajectory.
        arc: the center or a point of the arc for `Method.CARTESIAN_ARC`.
        max_link_speeds: the maximum speeds of links' origins in m/s, by link.
    """

    group: JointGroup
    start: Array
    goals: Sequence[Goal]
    path_constraint: Goal | None = None
    method: Method = Method.SAMPLING
    planner: str = DEFAULT_PLANNER
    planner_parameters: Mapping[str, Any] = field(default_factory=dict)
    timeout_s: float = 5.0
    velocity_scale: float = 1.0
    acceleration_scale: float = 1.0
    interval_s: float = 0.1
    arc: ArcPoint | None = None
    max_link_speeds: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """A planned motion of a group.

    Attributes:
        start: the positions of all joints at the start.
        path: the corners of the path of the group's joints, shape (n, joints).
        trajectory: the motion along the path.
    """

    start: Array
    path: Array
    trajectory: Trajectory


class MotionPlanner:
    """A planner of motions of a robot among objects.

    Args:
        model: the robot; it is moved.
        scene: the robot among objects.
        is_canceled: returns whether the planning must stop; it is called often, and raises no error.
    """

    def __init__(
        self, model: RobotModel, scene: CollisionScene, is_canceled: Callable[[], bool] = lambda: False
    ) -> None:
        self._model = model
        self._scene = scene
        self._is_canceled = is_canceled

    def plan(self, request: PlanRequest) -> Trajectory:
        """Return a trajectory of the group's joints.

        Raises:
            PlanError: there is no plan.
        """
        return self.plan_path(request).trajectory

    def plan_path(self, request: PlanRequest) -> Plan:
        """Return a trajectory of the group's joints, with the path that it follows.

        Raises:
            PlanError: there is no plan.
        """
        deadline = elapsed_s() + request.timeout_s
        indexes = np.array([self._model.index(name) for name in request.group.joint_names])
        start = self._checked_start(request, indexes)

        def is_valid(positions: Array) -> bool:  # After a cancellation, no configuration is, so that searches end.
            return not self._is_canceled() and self._is_valid(request, positions)

        goals = self._find_goals(request, start, is_valid)

        def leave_out_separated() -> list[Array]:
            return self._find_unseparated_goals(request, start, goals, indexes, is_valid)

        while (
            path := self._find_path(request, start, goals, indexes, is_valid, deadline, leave_out_separated)
        ) is not None:
            trajectory = self._find_free_trajectory(request, start, path)
            if trajectory is not None:
                return Plan(start, path, trajectory)
            if request.method is not Method.SAMPLING or elapsed_s() >= deadline:
                break
        self._stop_if_canceled()
        turns = _explain_turns(request.group, start[indexes], goals, indexes)
        raise PlanError(Failure.PLANNING_FAILED, reason=f"{Failure.PLANNING_FAILED.value}{turns}")

    def time_path(
        self, request: PlanRequest, start: Array, path: Array, scales: tuple[Array, Array] | None = None
    ) -> Trajectory:
        """Return the fastest trajectory along a path that is free of collisions.

        Args:
            request: the request, with the scales of the limits.
            start: the positions of all joints.
            path: the positions of the group's joints, shape (n, joints).
            scales: the shares of the maximum velocities and accelerations between two corners, each of shape (n - 1,),
                instead of those of the request.

        Raises:
            PlanError: even the trajectory that stops at each corner collides, or the planning is canceled.
        """
        trajectory = self._find_free_trajectory(request, start, path, scales)
        if trajectory is None:
            raise PlanError(Failure.PLANNING_FAILED)
        return trajectory

    def is_path_free(self, request: PlanRequest, start: Array, path: Array) -> bool:
        """Return whether the straight lines of a path are free of collisions and fulfill the path constraint.

        Args:
            request: the request, with the group and the constraint.
            start: the positions of all joints.
            path: the positions of the group's joints, shape (n, joints).

        Raises:
            PlanError: the planning is canceled.
        """
        indexes = np.array([self._model.index(name) for name in request.group.joint_names])
        positions = start.copy()
        for configuration in subdivide(path, _CHECK_STEP):
            self._stop_if_canceled()
            positions[indexes] = configuration
            if not self._is_valid(request, positions):
                return False
        return True

    def _find_free_trajectory(
        self, request: PlanRequest, start: Array, path: Array, scales: tuple[Array, Array] | None = None
    ) -> Trajectory | None:
        """Return the fastest trajectory along a path that is free of collisions, or None."""
        group = request.group
        velocity_scale, acceleration_scale = (
            (request.velocity_scale, request.acceleration_scale)
            if scales is None
            else (shares[:, None] for shares in scales)
        )
        indexes = np.array([self._model.index(name) for name in group.joint_names])
        speed_limits = LinkSpeedLimits(self._model, group, start, request.max_link_speeds)
        for deviation in _DEVIATIONS:
            self._stop_if_canceled()
            trajectory = parameterize_smoothly(
                path,
                group.max_velocities * velocity_scale,
                group.max_accelerations * acceleration_scale,
                group.max_jerks,
                max_deviation=deviation,
                interval_s=request.interval_s if deviation > 0.0 else min(request.interval_s, _STOP_INTERVAL_S),
                max_path_speeds=speed_limits.max_path_speeds if request.max_link_speeds else None,
            )
            if request.max_link_speeds:
                trajectory = speed_limits.slow(trajectory)
            if all(self._is_motion_free(request, start, indexes, motion) for motion in self._motions(trajectory)):
                return trajectory
        return None

    def _is_motion_free(self, request: PlanRequest, start: Array, indexes: Any, motion: Array) -> bool:
        """Return whether configurations are valid, and certainly nothing collides between them.

        Shapes that touch at the start or at the end may do so in the first and last steps, as in a grasp.
        """
        has_left, arrives = False, False
        with self._scene.measuring_up_to(RANGE_M):
            for number, checked in enumerate(MotionCheck(self._scene, start, indexes).check(motion)):
                self._stop_if_canceled()
                if checked.collides or not self._fulfills_constraint(request, checked.positions):
                    return False
                if not number:
                    continue
                if not checked.is_reached_freely:
                    arrives = has_left
                elif arrives:
                    return False
                else:
                    has_left = True
        return True

    @staticmethod
    def _motions(trajectory: Trajectory) -> tuple[Array, Array]:
        """Return the configurations between the points of a trajectory, in steps that are fine enough to check.

        Controllers execute splines between the points, and other programs draw straight lines.
        """
        pieces = np.linalg.norm(np.diff(trajectory.positions, axis=0), axis=1)
        count = max(1, int(np.ceil(float(pieces.max(initial=0.0)) / _CHECK_STEP)))
        splits = [np.linspace(*ends, count, endpoint=False) for ends in pairwise(trajectory.times)]
        executed = trajectory.interpolate(np.concatenate((*splits, trajectory.times[-1:])))[0]
        return executed, subdivide(trajectory.positions, _CHECK_STEP)

    def _checked_start(self, request: PlanRequest, indexes: Any) -> Array:
        """Return the start, moved to the bounds of the group's joints."""
        start, group = request.start.copy(), request.group
        bounded = np.clip(start[indexes], group.lower, group.upper)
        bounded[group.is_continuous] = start[indexes][group.is_continuous]
        if np.any(np.abs(bounded - start[indexes]) > _MAX_BOUND_VIOLATION):
            raise PlanError(Failure.INVALID_ROBOT_STATE)
        start[indexes] = bounded
        if contacts := self._scene.contacts(start):
            raise PlanError(Failure.START_STATE_IN_COLLISION, contacts)
        if request.path_constraint is not None and not request.path_constraint.is_met(self._model, start):
            raise PlanError(Failure.START_STATE_VIOLATES_PATH_CONSTRAINTS)
        return start

    def _find_goals(self, request: PlanRequest, start: Array, is_valid: Any) -> list[Array]:
        group, configurations = request.group, []
        failure, contacts = Failure.NO_IK_SOLUTION, []
        for goal in request.goals:
            for name, target in goal.joints.items():
                if name not in group.joint_names:
                    continue
                number = group.joint_names.index(name)
                nearest = min(max(target.position, group.lower[number]), group.upper[number])
                if not group.is_continuous[number] and abs(nearest - target.position) > 1e-3 + max(
                    target.above, target.below
                ):
                    raise PlanError(Failure.INVALID_GOAL_CONSTRAINTS)
            timeout_s = request.timeout_s * _GOAL_SHARE
            possible = goal_configurations(goal, self._model, group, start, is_valid, timeout_s, self._is_canceled)
            found = list(islice(possible, 1 if request.method in _CARTESIAN else None))
            if not found and not goal.links:
                positions = start.copy()
                for name, target in goal.joints.items():
                    positions[self._model.index(name)] = target.position
                failure, contacts = Failure.GOAL_IN_COLLISION, self._scene.contacts(positions)
            configurations += found
        self._stop_if_canceled()
        if not configurations:
            raise PlanError(failure, contacts)
        return configurations

    def _find_unseparated_goals(
        self, request: PlanRequest, start: Array, goals: Sequence[Array], indexes: Any, is_valid: Any
    ) -> list[Array]:
        """Return the goals that no barrier separates from the start, or other configurations for their poses.

        Raises:
            PlanError: there are none.
        """
        barriers = Barriers(self._scene, request.group, indexes, start)
        found = [barriers.find(goal) for goal in goals]
        reachable = [goal for goal, barrier in zip(goals, found, strict=True) if barrier is None]
        if reachable:
            return reachable
        try:
            return self._find_goals(request, start, lambda goal: is_valid(goal) and barriers.find(goal) is None)
        except PlanError as error:
            if error.failure is Failure.PREEMPTED:
                raise
        turns = _explain_turns(request.group, start[indexes], goals, indexes)
        reason = f"{Failure.PLANNING_FAILED.value}: {found[0]}{turns}"
        raise PlanError(Failure.PLANNING_FAILED, reason=reason)

    def _find_path(
        self,
        request: PlanRequest,
        start: Array,
        goals: Sequence[Array],
        indexes: Any,
        is_valid: Any,
        deadline: float,
        leave_out_separated: Callable[[], list[Array]],
    ) -> Array | None:
        """Return the corners of a path of the group's joints, shape (n, joints), or None."""
        if request.method in _CARTESIAN:
            return self._follow_curve(request, start, indexes, is_valid)

        def is_free(configuration: Array) -> bool:
            positions[indexes] = configuration
            return bool(is_valid(positions))

        positions = start.copy()
        planner, parameters = request.planner, request.planner_parameters
        problem = SamplingProblem(request.group, is_free, planner, parameters, self._is_canceled)
        ends = [goal[indexes] for goal in goals]
        if request.method is Method.JOINT_LINE:
            path = np.array((start[indexes], min(ends, key=lambda end: float(np.linalg.norm(end - start[indexes])))))
            return path if problem.is_path_free(path, _CHECK_STEP) else None

        def revise() -> list[Array]:
            return [goal[indexes] for goal in leave_out_separated()]

        return problem.solve(start[indexes], ends, max(deadline - elapsed_s(), 0.1), revise)

    def _follow_curve(self, request: PlanRequest, start: Array, indexes: Any, is_valid: Any) -> Array | None:
        """Return the path on which the tip of the group moves on a straight line or an arc to the goal."""
        goal = request.goals[0]
        tip = goal.links[0].link if goal.links else request.group.tip
        if tip is None:
            return None
        self._model.move(start)
        first = self._model.link_pose(tip)
        if goal.links:
            last = goal.links[0].sample(None, first)
        else:
            positions = start.copy()
            for name, target in goal.joints.items():
                positions[self._model.index(name)] = target.position
            self._model.move(positions)
            last = self._model.link_pose(tip)
        solver = ChainSolver(self._model, request.group, tip)
        try:
            poses = (
                line_poses(first, last, _LINE_STEP_M)
                if request.arc is None
                else arc_poses(first, last, request.arc, _LINE_STEP_M)
            )
        except ArcError as error:
            raise PlanError(Failure.INVALID_MOTION_PLAN, reason=str(error)) from None
        path, fraction = follow_poses(solver, start, poses, indexes, is_valid)
        return path[:, indexes] if fraction == 1.0 else None

    def _is_valid(self, request: PlanRequest, positions: Array) -> bool:
        return self._scene.is_free(positions) and self._fulfills_constraint(request, positions)

    def _stop_if_canceled(self) -> None:
        if self._is_canceled():
            raise PlanError(Failure.PREEMPTED)

    def _fulfills_constraint(self, request: PlanRequest, positions: Array) -> bool:
        constraint = request.path_constraint
        return constraint is None or constraint.is_met(self._model, positions)


def _explain_turns(group: JointGroup, start: Array, goals: Sequence[Array], indexes: Any) -> str:
    """Return a clause that names a nearer configuration which equals a goal up to full turns of joints, or nothing.

    Collisions of neighboring links often separate such goals, which then have no path at all.
    """
    for goal in goals:
        nearer = group.unwind(goal[indexes], start)
        if np.any(turned := np.abs(nearer - goal[indexes]) > np.pi):
            joints = " and ".join(
                f"'{name}' at {position:.2f}"
                for name, position, is_turned in zip(group.joint_names, nearer, turned, strict=True)
                if is_turned
            )
            return f"; the same configuration is nearer to the start with {joints}"
    return ""
