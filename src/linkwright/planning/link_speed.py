"""Limits of the speed of links along a motion of joints."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.planning.groups import JointGroup
from linkwright.planning.robot_model import RobotModel
from linkwright.planning.timing import Trajectory
from linkwright.simulation.library import load_mujoco

_MIN_RATIO = 1e-9
"""The share of a limit per rad or m of the path up to which a link counts as not moving."""
_MARGIN = 0.999
"""The share of the limits that is used, because the speeds are computed at points only."""


class LinkSpeedLimits:
    """The limits of the speeds of links' origins.

    Args:
        model: the robot; it is moved.
        group: the joints that move.
        start: the positions of all joints.
        limits: the maximum speeds in m/s by link.
    """

    def __init__(self, model: RobotModel, group: JointGroup, start: Array, limits: Mapping[str, float]) -> None:
        self._model, self._start = model, start
        self._limits = [(model.body(link), speed) for link, speed in limits.items()]
        self._indexes = np.array([model.index(name) for name in group.joint_names])
        self._dofs = model.dof_indexes(group.joint_names)

    def ratios(self, positions: Array, rates: Array) -> Array:
        """Return the largest ratio of a link's speed to its limit, shape (n,).

        Args:
            positions: the positions of the group's joints, shape (n, joints).
            rates: the derivatives of the positions, by time or by the length of a path, shape (n, joints).
        """
        mujoco, model, data = load_mujoco(), self._model.mujoco_model, self._model.data
        jacobian = np.zeros((3, model.nv))
        all_positions, result = self._start.copy(), np.zeros(len(positions))
        for number, (configuration, rate) in enumerate(zip(positions, rates, strict=True)):
            all_positions[self._indexes] = configuration
            self._model.move(all_positions)
            mujoco.mj_comPos(model, data)
            for body, limit in self._limits:
                mujoco.mj_jacBody(model, data, jacobian, None, body)
                speed = float(np.linalg.norm(jacobian[:, self._dofs] @ rate))
                result[number] = max(result[number], speed / limit)
        return result

    def max_path_speeds(self, positions: Array, slopes: Array) -> Array:
        """Return the maximum speeds along a path at which the links keep their limits, shape (n,).

        Args:
            positions: shape (n, joints).
            slopes: the derivatives of the positions by the length of the path, shape (n, joints).
        """
        ratios = np.maximum(self.ratios(positions, slopes), _MIN_RATIO)
        return np.asarray(_MARGIN / ratios, dtype=np.float64)

    def slow(self, trajectory: Trajectory) -> Trajectory:
        """Return a trajectory in which the links keep their limits: the same one, or one that is slower everywhere."""
        times = np.concatenate((trajectory.times, (trajectory.times[1:] + trajectory.times[:-1]) / 2.0))
        positions, velocities, _ = trajectory.interpolate(times)
        return trajectory.slowed(max(1.0, float(self.ratios(positions, velocities).max(initial=0.0)) / _MARGIN))
