"""Motions of a group by velocities that a user commands, with the checks of MoveIt Servo.

A velocity of the tip becomes velocities of joints by the pseudo-inverse of the Jacobian. Near a singularity, near a
collision and above the limits of joints, all velocities are scaled down; near a bound, joints are halted. A low-pass
filter smooths the result.

Source: the documentation of MoveIt Servo, and Bro, Acar and Kolda, "Resolving the sign ambiguity in the singular value
decomposition", Journal of Chemometrics 22 (2008), for the direction toward a singularity.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import exp, inf, log

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.planning.groups import JointGroup
from linkwright.planning.robot_model import RobotModel
from linkwright.simulation.library import load_mujoco

_COLLISION_DECAY = -log(0.001)
"""The velocity that is left at a distance of 0 is 0.1 %."""
_REST = 1e-4
"""The velocity in rad/s or m/s up to which a joint counts as at rest."""


class Condition(Enum):
    """The reason why a motion is slowed or halted."""

    INVALID = "Invalid"
    NO_WARNING = "No warnings"
    DECELERATE_FOR_APPROACHING_SINGULARITY = "Moving closer to a singularity, decelerating"
    HALT_FOR_SINGULARITY = "Very close to a singularity, emergency stop"
    DECELERATE_FOR_LEAVING_SINGULARITY = "Moving away from a singularity, decelerating"
    DECELERATE_FOR_COLLISION = "Close to a collision, decelerating"
    HALT_FOR_COLLISION = "Collision detected, emergency stop"
    JOINT_BOUND = "Close to a joint bound (position or velocity), halting"


@dataclass(frozen=True, slots=True, eq=False)
class ServoSettings:
    """The settings of a servo, with the names of MoveIt's parameters.

    Attributes:
        publish_period: the time in s between two steps.
        lower_singularity_threshold: the condition number of the Jacobian at which the motion slows down.
        hard_stop_singularity_threshold: the condition number at which it halts.
        leaving_singularity_threshold_multiplier: how much faster the motion away from a singularity is.
        singularity_step_scale: the step in m or rad in which the condition number is compared.
        joint_limit_margins: the distances in rad or m from the bounds at which joints halt, shape (joints,).
        override_velocity_scaling_factor: the share of all velocities, or 0 for all of them.
        self_collision_proximity_threshold: the distance in m between links at which the motion slows down.
        scene_collision_proximity_threshold: the distance in m from objects at which the motion slows down.
        low_pass_filter_coeff: the strength of the filter, above 1.
    """

    joint_limit_margins: Array
    publish_period: float = 0.01
    lower_singularity_threshold: float = 17.0
    hard_stop_singularity_threshold: float = 30.0
    leaving_singularity_threshold_multiplier: float = 2.0
    singularity_step_scale: float = 0.01
    override_velocity_scaling_factor: float = 0.0
    self_collision_proximity_threshold: float = 0.01
    scene_collision_proximity_threshold: float = 0.02
    low_pass_filter_coeff: float = 1.5


class Servo:
    """The motion of a group by commanded velocities.

    Args:
        model: the robot; it is moved.
        group: the joints to move, with a tip for velocities of the tip.
        settings: the settings.

    Attributes:
        positions: the positions of all joints, which the next step changes.
        velocities: the velocities of the group's joints in rad/s or m/s, shape (joints,).
        condition: the reason why the motion is slowed or halted.
        collision_scale: the share of the velocities that is allowed by collisions, see `set_clearances`.
        halts_all_joints: whether all joints halt when one of them must.
        drifts: in which dimensions the velocity of the tip is free, so that the others are easier to reach: linear and
            angular along and about x, y and z of the root link, shape (6,). One that is not free is left at least.
    """

    def __init__(self, model: RobotModel, group: JointGroup, settings: ServoSettings) -> None:
        self._model, self._group, self._settings = model, group, settings
        self._indexes = np.array([model.index(name) for name in group.joint_names])
        self._dofs = np.array(model.dof_indexes(group.joint_names))
        self.positions: Array = np.zeros(len(model.joint_names))
        self.collision_scale = 1.0
        self.halts_all_joints = True
        self.drifts: NDArray[np.bool_] = np.zeros(6, dtype=bool)
        self.reset(self.positions)

    @property
    def group_positions(self) -> Array:
        """The positions of the group's joints, shape (joints,)."""
        positions: Array = self.positions[self._indexes]
        return positions

    @property
    def is_at_rest(self) -> bool:
        """Whether no joint moves."""
        return bool(np.all(np.abs(self.velocities) < _REST))

    def reset(self, positions: Array) -> None:
        """Start at rest at the positions of all joints."""
        self.positions = positions.copy()
        self.velocities: Array = np.zeros(len(self._indexes))
        self._previous_input: Array = self.velocities
        self.condition = Condition.NO_WARNING

    def set_clearances(self, to_self: float, to_world: float) -> None:
        """Set the distances in m of the robot to itself and to objects; 0 for a collision."""
        settings = self._settings
        scales = [1.0]
        for distance, threshold in (
            (to_self, settings.self_collision_proximity_threshold),
            (to_world, settings.scene_collision_proximity_threshold),
        ):
            if distance <= 0.0:
                scales.append(0.0)
            elif distance < threshold:
                scales.append(exp(_COLLISION_DECAY / threshold * (distance - threshold)))
        self.collision_scale = min(scales)

    def step_twist(self, twist: Array) -> None:
        """Move for one period so that the tip has a velocity.

        Args:
            twist: the linear velocity of the tip in m/s and the angular one in rad/s, in the frame of the root link,
                shape (6,).
        """
        middle = self.positions.copy()  # The Jacobian in the middle of the step keeps the tip on a straight line.
        middle[self._indexes] += 0.5 * self._settings.publish_period * self.velocities
        jacobian, twist = self._jacobian(middle), twist[self._kept_dimensions()]
        left, values, right = np.linalg.svd(jacobian, full_matrices=False)
        if values[-1] <= 0.0:
            self._step(np.zeros(len(self._indexes)), Condition.HALT_FOR_SINGULARITY)
            return
        inverse = right.T / values @ left.T
        scale, condition = self._scale_for_singularity(twist, left[:, -1], inverse, float(values[0] / values[-1]))
        self._step(scale * (inverse @ twist), condition)

    def step_joints(self, velocities: Array) -> None:
        """Move for one period with velocities of the group's joints, shape (joints,)."""
        self._step(velocities, Condition.NO_WARNING)

    def step_halt(self) -> None:
        """Slow down for one period."""
        self._step(np.zeros(len(self._indexes)), Condition.NO_WARNING)

    def _step(self, velocities: Array, condition: Condition) -> None:
        group, settings = self._group, self._settings
        if self.collision_scale < 1.0:
            velocities = velocities * self.collision_scale
            condition = (
                Condition.DECELERATE_FOR_COLLISION if self.collision_scale > 0.0 else Condition.HALT_FOR_COLLISION
            )
        shares = np.divide(
            group.max_velocities, np.abs(velocities), out=np.full(len(velocities), inf), where=velocities != 0.0
        )
        velocities = velocities * min(1.0, settings.override_velocity_scaling_factor or 1.0, float(shares.min()))
        positions, margins = self.group_positions, settings.joint_limit_margins
        is_halted = ((velocities < 0.0) & (positions < group.lower + margins)) | (
            (velocities > 0.0) & (positions > group.upper - margins)
        )
        is_halted &= ~group.is_continuous
        if np.any(is_halted):
            condition = Condition.JOINT_BOUND
            velocities = np.where(self.halts_all_joints | is_halted, 0.0, velocities)
        self.condition = condition
        coefficient = settings.low_pass_filter_coeff
        total = velocities + self._previous_input - (1.0 - coefficient) * self.velocities
        self._previous_input, self.velocities = velocities, total / (1.0 + coefficient)
        moved = positions + self.velocities * settings.publish_period
        bounded = np.clip(moved, np.minimum(group.lower, positions), np.maximum(group.upper, positions))
        self.positions[self._indexes] = np.where(group.is_continuous, moved, bounded)

    def _scale_for_singularity(
        self, twist: Array, weakest: Array, inverse: Array, number: float
    ) -> tuple[float, Condition]:
        """Return the share of the velocity that is allowed, and why.

        Args:
            twist: the velocity of the tip in the dimensions in which it must not drift, shape (dimensions,).
            weakest: the direction in which the tip moves least, of the same shape.
            inverse: the pseudo-inverse of the Jacobian.
            number: the condition number of the Jacobian.
        """
        settings = self._settings
        lower, hard_stop = settings.lower_singularity_threshold, settings.hard_stop_singularity_threshold
        if number <= lower:
            return 1.0, Condition.NO_WARNING
        if number >= hard_stop:
            return 0.0, Condition.HALT_FOR_SINGULARITY
        ahead = self.positions.copy()
        ahead[self._indexes] += inverse @ (settings.singularity_step_scale * weakest)
        values = np.linalg.svd(self._jacobian(ahead), compute_uv=False)
        is_worse = values[0] > number * values[-1]
        is_approaching = float(weakest @ twist) * (1.0 if is_worse else -1.0) > 0.0
        if is_approaching:
            share = (number - lower) / (hard_stop - lower)
            return 1.0 - share, Condition.DECELERATE_FOR_APPROACHING_SINGULARITY
        share = (number - lower) / ((hard_stop - lower) * settings.leaving_singularity_threshold_multiplier)
        return max(0.0, 1.0 - share), Condition.DECELERATE_FOR_LEAVING_SINGULARITY

    def _kept_dimensions(self) -> NDArray[np.intp]:
        """Return the indexes of the dimensions in which the tip must not drift."""
        return np.flatnonzero(~self.drifts) if not np.all(self.drifts) else np.zeros(1, dtype=np.intp)

    def _jacobian(self, positions: Array) -> Array:
        """Return the Jacobian of the tip in the frame of the root link, shape (dimensions, joints).

        It lacks the rows of dimensions in which the tip may drift.
        """
        assert self._group.tip is not None, "only groups with a tip have velocities of the tip"
        mujoco, model, data = load_mujoco(), self._model.mujoco_model, self._model.data
        self._model.move(positions)
        mujoco.mj_comPos(model, data)
        jacobian = np.zeros((6, model.nv))
        mujoco.mj_jacBody(model, data, jacobian[:3], jacobian[3:], self._model.body(self._group.tip))
        kept: Array = jacobian[np.ix_(self._kept_dimensions(), self._dofs)]
        return kept
