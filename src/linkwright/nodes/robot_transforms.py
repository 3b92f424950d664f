"""Which transforms a robot description gives for which joint states: robot_state_publisher without its node."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.messages import FloatSequence, TransformBatch
from linkwright.nodes.joint_motion import JointMotion
from linkwright.urdf import Joint, Robot

Array = NDArray[np.float64]

MOVING_TYPES = frozenset({"revolute", "continuous", "prismatic"})
FIXED_TYPES = frozenset({"fixed", "planar"})
"""kdl_parser turns planar joints into fixed ones. Floating ones it does too, but robot_state_publisher skips them:
where such a link is must come from elsewhere."""


@dataclass(frozen=True, slots=True, eq=False)
class Recipe:
    """How to make transforms of the positions in a message with a certain list of joint names.

    Transform i is that of joint i of `motion` at position ``message[source[i]] * factor[i] + offset[i]``.
    """

    parents: tuple[str, ...]
    children: tuple[str, ...]
    source: NDArray[np.intp]
    factor: Array
    offset: Array
    motion: JointMotion

    def batch(self, positions: FloatSequence, stamp_ns: int) -> TransformBatch:
        """The transforms for a message's positions."""
        values = np.asarray(positions, dtype=np.float64)[self.source] * self.factor + self.offset
        return TransformBatch(self.parents, self.children, stamp_ns, self.motion.poses(values))


class RobotTransforms:
    """The transforms of one robot.

    Args:
        robot: the description.
        frame_prefix: put before every frame name, with nothing between.
    """

    def __init__(self, robot: Robot, frame_prefix: str) -> None:
        self._prefix = frame_prefix
        self._moving: Mapping[str, Joint] = {
            name: joint for name, joint in robot.joints.items() if joint.type in MOVING_TYPES
        }
        self._rows = {name: row for row, name in enumerate(self._moving)}
        self._motion = JointMotion(tuple(self._moving.values()))
        self._fixed = tuple(joint for joint in robot.joints.values() if joint.type in FIXED_TYPES)
        self._recipes: dict[tuple[str, ...], Recipe] = {}

    def fixed(self, stamp_ns: int) -> TransformBatch:
        """The transforms of the joints that do not move."""
        poses = JointMotion(self._fixed).poses(np.zeros(len(self._fixed)))
        return TransformBatch(*self._frames(self._fixed), stamp_ns, poses)

    def recipe(self, names: Sequence[str]) -> Recipe:
        """How to make the transforms for messages with these joint names.

        Names that are not of moving joints are passed over. A joint that mimics one in the message follows it, unless
        the message has a position of its own for it; a joint that mimics such a joint in turn does not follow.
        """
        key = tuple(names)
        recipe = self._recipes.get(key)
        if recipe is None:
            recipe = self._recipes[key] = self._make_recipe(key)
        return recipe

    def _make_recipe(self, names: tuple[str, ...]) -> Recipe:
        position_of: dict[str, int] = {}
        for number, name in enumerate(names):
            position_of.setdefault(name, number)
        chosen: list[tuple[Joint, int, float, float]] = []
        for name, joint in self._moving.items():
            mimic = joint.mimic
            if name in position_of:
                chosen.append((joint, position_of[name], 1.0, 0.0))
            elif mimic is not None and mimic.joint in position_of:
                chosen.append((joint, position_of[mimic.joint], mimic.multiplier, mimic.offset))
        joints = tuple(joint for joint, *_ in chosen)
        return Recipe(
            *self._frames(joints),
            np.array([source for _, source, _, _ in chosen], dtype=np.intp),
            np.array([factor for _, _, factor, _ in chosen], dtype=np.float64),
            np.array([offset for *_, offset in chosen], dtype=np.float64),
            self._motion.select([self._rows[joint.name] for joint in joints]),
        )

    def _frames(self, joints: Sequence[Joint]) -> tuple[tuple[str, ...], tuple[str, ...]]:
        parents = tuple(self._prefix + joint.parent for joint in joints)
        children = tuple(self._prefix + joint.child for joint in joints)
        return parents, children
