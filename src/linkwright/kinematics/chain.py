"""The chain of joints between two links of a robot: poses of its links, and their Jacobians."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.geometry.arrays import Array
from linkwright.kinematics.tree import MOVING_TYPES, KinematicTree
from linkwright.urdf import Joint, Robot, parent_joints


class ChainConfiguration:
    """A chain with joint positions.

    Args:
        chain: the chain.
        frames: the frames of all links of the robot in its root, shape (links, 4, 4).
    """

    def __init__(self, chain: KinematicChain, frames: Array) -> None:
        self._chain = chain
        self._frames = frames
        base = frames[chain.tree.link_index(chain.base)]
        self._root_to_base = np.eye(4)
        self._root_to_base[:3, :3] = base[:3, :3].T
        self._root_to_base[:3, 3] = -base[:3, :3].T @ base[:3, 3]

    def link_frame(self, link: str) -> Array:
        """Return the frame of a link in the base of the chain, shape (4, 4).

        Raises:
            UnknownNameError: KIN103 if the robot has no such link.
        """
        frame: Array = self._root_to_base @ self._frames[self._chain.tree.link_index(link)]
        return frame

    def jacobian(self, link: str) -> Array:
        """Return the Jacobian of the origin of a link, in the base of the chain.

        Args:
            link: a link of the chain.

        Returns:
            The linear velocity in m/s and the angular velocity in rad/s for each joint velocity, shape (6, joints).
            Joints below the link do not move it.
        """
        chain = self._chain
        point = self.link_frame(link)[:3, 3]
        jacobian = np.zeros((6, len(chain.joint_names)))
        for joint, column, factor in chain.joints_above(link):
            frame = self.link_frame(joint.child)
            axis = frame[:3, :3] @ np.asarray(joint.axis) * (factor / np.linalg.norm(joint.axis))
            if joint.type == "prismatic":
                jacobian[:3, column] += axis
            else:
                jacobian[:3, column] += np.cross(axis, point - frame[:3, 3])
                jacobian[3:, column] += axis
        return jacobian


class KinematicChain:
    """The chain of joints from a link to a link below it.

    Args:
        robot: the robot.
        base: the first link of the chain.
        tip: the last link of the chain.

    Attributes:
        tree: the kinematic tree of the robot.
        base: the first link.
        links: the links of the chain, from the base to the tip.
        joint_names: the joints of the chain that have a position, from the base to the tip; mimic joints have none.

    Raises:
        LinkwrightError: KIN103, the robot has no such link; KIN104, the tip is not below the base.
    """

    def __init__(self, robot: Robot, base: str, tip: str) -> None:
        self.tree = KinematicTree(robot)
        for link in (base, tip):
            self.tree.link_index(link)
        self.base = base
        joints = _list_joints(robot, base, tip)
        self.links: tuple[str, ...] = (base, *(joint.child for joint in joints))
        self._moving_joints = [joint for joint in joints if joint.type in MOVING_TYPES and np.any(joint.axis)]
        leaders = {joint.name: self.tree.mimic_relation(joint.name) for joint in self._moving_joints}
        self.joint_names: tuple[str, ...] = tuple(dict.fromkeys(relation.leader for relation in leaders.values()))
        self._columns = {
            name: (self.joint_names.index(relation.leader), relation.factor) for name, relation in leaders.items()
        }

    def configure(self, positions: Mapping[str, float] | ArrayLike) -> ChainConfiguration:
        """Return the chain at joint positions.

        Args:
            positions: in rad or m, by name or in the order of `joint_names`. Other joints of the robot are at 0.
        """
        if not isinstance(positions, Mapping):
            positions = dict(zip(self.joint_names, np.asarray(positions, dtype=float).tolist(), strict=True))
        return ChainConfiguration(self, self.tree.forward(positions))

    def joints_above(self, link: str) -> Sequence[tuple[Joint, int, float]]:
        """Return the moving joints between the base and a link of the chain.

        Each has the index of its position in `joint_names` and the factor of this position.
        """
        links = self.links[: self.links.index(link) + 1]
        return [(joint, *self._columns[joint.name]) for joint in self._moving_joints if joint.child in links]


def _list_joints(robot: Robot, base: str, tip: str) -> list[Joint]:
    """Return the joints from the base to the tip."""
    parents = parent_joints(robot)
    joints: list[Joint] = []
    link = tip
    while link != base:
        joint = parents.get(link)
        if joint is None or len(joints) > len(robot.joints):
            message = phrase("link '{tip}' is not below link '{base}'", tip=tip, base=base)
            raise LinkwrightError(Diagnostic("KIN104", message))
        joints.append(joint)
        link = joint.parent
    return joints[::-1]
