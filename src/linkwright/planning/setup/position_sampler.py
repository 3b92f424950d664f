"""Random positions of all joints of a robot, within their limits."""

from __future__ import annotations

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.planning.groups import joint_limits
from linkwright.planning.robot_model import RobotModel
from linkwright.urdf import Robot


class PositionSampler:
    """Random positions of all joints of a robot within their limits.

    Attributes:
        joint_names: the joints with a position of their own, in the order of positions.
        limits: their limits.
        lower: their lower limits in rad or m, shape (joints,).
        upper: their upper limits in rad or m, shape (joints,).
    """

    def __init__(self, robot: Robot) -> None:
        self.joint_names = RobotModel(robot).joint_names
        self.limits = [joint_limits(robot.joints[name]) for name in self.joint_names]
        self.lower: Array = np.array([limit.lower for limit in self.limits])
        self.upper: Array = np.array([limit.upper for limit in self.limits])

    def default(self) -> Array:
        """Return MoveIt's default positions: 0, or the middle of limits that do not include 0."""
        is_inside = (self.lower <= 0.0) & (self.upper >= 0.0)
        return np.where(is_inside, 0.0, (self.lower + self.upper) / 2)

    def sample(self, random: np.random.Generator) -> Array:
        """Return random positions."""
        return random.uniform(self.lower, self.upper)
