"""Searches for positions in which two links collide, near those in which they are close to each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.planning.robot_model import RobotModel, Shapes, body_name
from linkwright.planning.setup.position_sampler import PositionSampler
from linkwright.simulation.library import load_mujoco
from linkwright.urdf import Robot, parent_joints

_STARTS = 128
_DESCENTS = 6
_STEPS = 60
_FIRST_STEP = 0.2
"""The first step of a descent, as a share of the ranges of the joints."""
_GROWTH, _DECAY = 1.6, 0.85
_FAR_M = 100.0


class ContactSearch:
    """The search for contacts between the links of a robot.

    Args:
        robot: the robot.
        shapes: the collision shapes of its links.
        sampler: the limits of its joints.
    """

    def __init__(self, robot: Robot, shapes: Shapes, sampler: PositionSampler) -> None:
        self.model = RobotModel(robot, shapes)
        self._mujoco = load_mujoco()
        self._robot = robot
        self._sampler = sampler
        self._parents = parent_joints(robot)
        mujoco_model = self.model.mujoco_model
        self._geoms: dict[str, Sequence[int]] = {}
        for link in shapes:
            body = mujoco_model.body(body_name(link)).id
            first, count = int(mujoco_model.body_geomadr[body]), int(mujoco_model.body_geomnum[body])
            self._geoms[link] = range(first, first + count)

    def distance(self, first: str, second: str) -> float:
        """Return the distance in m between two links in the current positions; it is negative if they overlap."""
        model, data = self.model.mujoco_model, self.model.data
        return min(
            float(self._mujoco.mj_geomDistance(model, data, one, other, _FAR_M, None))
            for one in self._geoms[first]
            for other in self._geoms[second]
        )

    def can_touch(self, first: str, second: str, random: np.random.Generator) -> bool:
        """Return whether positions are found in which two links collide.

        The joints between the links are moved from random positions toward smaller distances.
        """
        moved = self._joints_between(first, second)
        base = self._sampler.default()

        def measure(values: Array) -> float:
            base[moved] = values
            self.model.move(base)
            return self.distance(first, second)

        lower, upper = self._sampler.lower[moved], self._sampler.upper[moved]
        starts = random.uniform(lower, upper, (_STARTS, len(moved)))
        distances = np.array([measure(values) for values in starts])
        for index in np.argsort(distances, kind="stable")[:_DESCENTS]:
            values, distance, step = starts[index], float(distances[index]), _FIRST_STEP
            for _ in range(_STEPS):
                if distance < 0.0:
                    return True
                candidate = np.clip(values + random.normal(0.0, step, len(moved)) * (upper - lower), lower, upper)
                measured = measure(candidate)
                if measured < distance:
                    values, distance, step = candidate, measured, min(step * _GROWTH, 1.0)
                else:
                    step *= _DECAY
        return False

    def _joints_between(self, first: str, second: str) -> list[int]:
        """Return the indexes of the joints that move two links relative to each other."""
        above_first, above_second = self._leaders_above(first), self._leaders_above(second)
        names = above_first.symmetric_difference(above_second)
        shared = {name for name in above_first & above_second if self._is_followed(name)}
        return [index for index, name in enumerate(self._sampler.joint_names) if name in names or name in shared]

    def _leaders_above(self, link: str) -> set[str]:
        """Return the joints with a position of their own that move a link, also through joints that mimic them."""
        names = set()
        while link in self._parents:
            joint = self._parents[link]
            while joint.mimic is not None and joint.mimic.joint in self._robot.joints:
                joint = self._robot.joints[joint.mimic.joint]
            names.add(joint.name)
            link = self._parents[link].parent
        return names

    def _is_followed(self, name: str) -> bool:
        return any(joint.mimic is not None and joint.mimic.joint == name for joint in self._robot.joints.values())
