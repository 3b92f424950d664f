"""Inverse kinematics by damped least squares, with random restarts within the joint limits.

The damping follows Sugihara, "Solvability-Unconcerned Inverse Kinematics by the Levenberg-Marquardt Method", IEEE
Transactions on Robotics 27 (2011): it is the current error plus a small constant, so that the steps are small near
singularities and large near the solution.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import count

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.planning.effort import ATTEMPT_S, elapsed_s, spend
from linkwright.planning.groups import JointGroup
from linkwright.planning.robot_model import RobotModel
from linkwright.simulation.library import load_mujoco

_MAX_ITERATIONS = 12
"""The iterations of an attempt. A restart takes less time, on average, than more iterations."""
_MIN_ATTEMPTS = 30
"""The attempts that are made even if they take longer than the time limit, as on a busy computer: some 10 ms."""
_MIN_DAMPING = 1e-7
"""The damping at the solution. A larger one needs many iterations near singularities, such as a stretched wrist."""
_DAMPING_PER_SQUARED_ERROR = 0.005
_POSITION_TOLERANCE_M = 1e-5
_ROTATION_TOLERANCE_RAD = 1e-4
_MAX_STEP = 1.0
"""The maximum change of a joint in one iteration, in rad or m."""


class ChainSolver:
    """A solver for the joint positions of a group whose tip has a given pose.

    Args:
        model: the robot; the solver moves it.
        group: the joints to move.
        tip: the link that is moved to the target.
        seed: the seed of the random restarts.
    """

    def __init__(self, model: RobotModel, group: JointGroup, tip: str, seed: int = 0) -> None:
        self._model = model
        self._mujoco = load_mujoco()
        self._group = group
        self._body = model.body(tip)
        self.indexes = np.array([model.index(name) for name in group.joint_names])
        self._dofs = np.array(model.dof_indexes(group.joint_names))
        self._random = np.random.default_rng(seed)
        self._jacobian = np.zeros((6, model.mujoco_model.nv))
        self._error = np.zeros(6)
        self._quaternion = np.zeros(4)
        self._inverse = np.zeros(4)
        self._identity = np.eye(len(self.indexes))

    def solve(
        self,
        target: Array,
        start: Array,
        timeout_s: float,
        is_valid: Callable[[Array], bool] | None = None,
    ) -> Array | None:
        """Return positions of all joints at which the tip has a pose, or None.

        Args:
            target: the pose of the tip in the frame of the root link, shape (7,).
            start: the positions of all joints, in the order of the model; the first attempt starts there.
            timeout_s: the time after which no new attempt starts; the first 30 attempts are made in any case.
            is_valid: returns whether a solution is acceptable, such as free of collisions.
        """
        deadline = elapsed_s() + timeout_s
        target_quaternion = np.array((target[6], *target[3:6]))
        positions = start.copy()
        for number in count(1):
            if self._converge(positions, target[:3], target_quaternion):
                positions[self.indexes] = self._group.unwind(positions[self.indexes], start[self.indexes])
                if is_valid is None or is_valid(positions):
                    return positions
            spend(ATTEMPT_S)
            if number >= _MIN_ATTEMPTS and elapsed_s() >= deadline:
                break
            positions[self.indexes] = self._group.sample(self._random)
        return None

    def solve_from(self, target: Array, start: Array) -> Array | None:
        """Return the positions that are reached from the start without a restart, or None."""
        positions = start.copy()
        return positions if self._converge(positions, target[:3], np.array((target[6], *target[3:6]))) else None

    def _converge(self, positions: Array, target: Array, quaternion: Array) -> bool:
        indexes, jacobian, body, max_step = self.indexes, self._jacobian, self._body, _MAX_STEP
        lower, upper = self._group.lower, self._group.upper
        model, data, mujoco, error = self._model.mujoco_model, self._model.data, self._mujoco, self._error
        offset, turn = error[:3], error[3:]
        for _ in range(_MAX_ITERATIONS):
            self._model.move(positions)
            np.subtract(target, data.xpos[body], out=offset)
            mujoco.mju_negQuat(self._inverse, data.xquat[body])
            mujoco.mju_mulQuat(self._quaternion, quaternion, self._inverse)
            mujoco.mju_quat2Vel(turn, self._quaternion, 1.0)
            squared_offset, squared_turn = float(offset @ offset), float(turn @ turn)
            if squared_offset < _POSITION_TOLERANCE_M**2 and squared_turn < _ROTATION_TOLERANCE_RAD**2:
                return True
            mujoco.mj_comPos(model, data)
            mujoco.mj_jacBody(model, data, jacobian[:3], jacobian[3:], body)
            columns = jacobian[:, self._dofs]
            damping = _DAMPING_PER_SQUARED_ERROR * (squared_offset + squared_turn) + _MIN_DAMPING
            step = np.linalg.solve(columns.T @ columns + damping * self._identity, error @ columns)
            step = np.minimum(np.maximum(step, -max_step), max_step)  # np.clip takes three times as long.
            positions[indexes] = np.minimum(np.maximum(positions[indexes] + step, lower), upper)
        return False
