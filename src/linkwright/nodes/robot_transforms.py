"""Transforms of a robot for joint states, and their rates: robot_state_publisher without its node."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import quaternion_multiply, rotate, row_from_pose
from linkwright.messages import FloatSequence, TransformBatch
from linkwright.urdf import Joint, Robot

Array = NDArray[np.float64]


class JointMotion:
    """Poses of child links in their parent links as functions of joint positions.

    Turning by q about an axis composes the rotation r of the joint's origin with (axis sin q/2, cos q/2), which is
    r cos q/2 + (r * axis) sin q/2; shifting along it adds q times the turned axis. So each pose is
    ``fixed + cosine cos q/2 + sine sin q/2 + linear q`` with constant rows, and all joints take a few array operations
    whatever their types are.

    Args:
        joints: revolute, continuous and prismatic ones move, all others stay at their origin. Axes need not be of
            unit length (KDL normalises them); a joint with a zero axis does not move.
    """

    def __init__(self, joints: Sequence[Joint]) -> None:
        self._fixed, self._cosine, self._sine, self._linear = np.zeros((4, len(joints), 7))
        for row, joint in enumerate(joints):
            self._add(row, joint)

    def poses(self, positions: Array) -> Array:
        """Array, shape (n, 7), of x y z (metres) and qx qy qz qw, for positions (n,) in radians or metres."""
        half = (0.5 * positions)[:, np.newaxis]
        turned: Array = self._cosine * np.cos(half)
        turned += self._sine * np.sin(half)
        turned += self._linear * positions[:, np.newaxis]
        turned += self._fixed
        return turned

    def select(self, rows: Sequence[int]) -> JointMotion:
        """The same for some of the joints, in the order given."""
        selected = JointMotion(())
        selected._fixed, selected._cosine = self._fixed[rows], self._cosine[rows]
        selected._sine, selected._linear = self._sine[rows], self._linear[rows]
        return selected

    def _add(self, row: int, joint: Joint) -> None:
        rotation = row_from_pose(joint.origin)[3:]
        length = sqrt(sum(component * component for component in joint.axis))
        axis = np.array(joint.axis) / length if length else np.zeros(3)
        self._fixed[row, :3] = joint.origin.xyz
        if joint.type in ("revolute", "continuous") and length:
            self._cosine[row, 3:] = rotation
            self._sine[row, 3:] = quaternion_multiply(rotation, [*axis, 0.0])
        else:
            self._fixed[row, 3:] = rotation
            if joint.type == "prismatic":
                self._linear[row, :3] = rotate(rotation, axis)


MOVING_TYPES = frozenset({"revolute", "continuous", "prismatic"})
FIXED_TYPES = frozenset({"fixed", "planar"})
"""kdl_parser turns planar joints into fixed ones. Floating ones it does too, but robot_state_publisher skips them:
where such a link is must come from elsewhere."""


@dataclass(frozen=True, slots=True, eq=False)
class Recipe:
    """The way from a message with a certain list of joint names to transforms.

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


class JointGroup:
    """The joints of a message for a throttle; one object for each list of names."""

    __slots__ = ("positions", "rows")

    def __init__(self, rows: NDArray[np.intp]) -> None:
        self.rows = rows
        self.positions: NDArray[np.float64] | None = None
        """A copy of the transforms published last, because a publisher may reuse its message."""


class Throttle:
    """Remembers when the transforms of each joint were published. Times are nanoseconds; 0 is never.

    A message is published when its stamp is an interval or more after that of its joints was published that has waited
    longest. Messages that repeat the positions of the one before, such as the steady beat of joint_state_publisher,
    must keep that distance from all messages; those with new positions only from other new ones. So a beat does not
    hold up the move that comes after it.

    Args:
        interval_ns: the least time between two messages about the same joints.
    """

    def __init__(self, interval_ns: int) -> None:
        self.interval_ns = interval_ns
        self._places: dict[str, int] = {}
        self._groups: dict[tuple[str, ...], JointGroup] = {}
        self._sent_ns: NDArray[np.int64] = np.zeros(0, dtype=np.int64)
        self._moved_ns: NDArray[np.int64] = np.zeros(0, dtype=np.int64)
        self._stamp_ns: NDArray[np.int64] = np.zeros(0, dtype=np.int64)

    def group(self, names: Sequence[str]) -> JointGroup:
        """The group of these joints, at least one."""
        key = tuple(names)
        group = self._groups.get(key)
        if group is None:
            rows = [self._places.setdefault(name, len(self._places)) for name in key]
            new = np.zeros(len(self._places) - len(self._sent_ns), dtype=np.int64)
            self._sent_ns = np.append(self._sent_ns, new)
            self._moved_ns = np.append(self._moved_ns, new)
            self._stamp_ns = np.append(self._stamp_ns, new)
            group = self._groups[key] = JointGroup(np.array(rows, dtype=np.intp))
        return group

    def is_move(self, group: JointGroup, positions: FloatSequence) -> bool:
        """Whether these positions differ from those published last."""
        return group.positions is None or not np.array_equal(group.positions, positions)

    def opens_ns(self, group: JointGroup, now_ns: int, *, move: bool) -> int:
        """Return the earliest stamp at which a message may be published."""
        before = self._moved_ns if move else self._sent_ns
        return min(int(before[group.rows].min()), now_ns) + self.interval_ns

    def is_in_order(self, group: JointGroup, stamp_ns: int) -> bool:
        """Whether all joints were published before, and none with a later stamp."""
        stamps = self._stamp_ns[group.rows]
        return bool(stamps.all() and (stamps <= stamp_ns).all())

    def published(self, group: JointGroup, positions: FloatSequence, stamp_ns: int, at_ns: int) -> None:
        """Record that a message with a stamp was published at a time."""
        if self.is_move(group, positions):
            self._moved_ns[group.rows] = at_ns
        self._sent_ns[group.rows] = at_ns
        self._stamp_ns[group.rows] = stamp_ns
        group.positions = np.array(positions, dtype=np.float64)

    def clear(self) -> None:
        """Reset."""
        for times in (self._sent_ns, self._moved_ns, self._stamp_ns):
            times[:] = 0
