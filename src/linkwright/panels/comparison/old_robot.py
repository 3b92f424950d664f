"""The older of two descriptions as a robot in the graph, posed like the newer robot."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from linkwright.descriptions.comparison import Comparison
from linkwright.geometry.arrays import compose, invert, row_from_pose
from linkwright.graph import (
    DESCRIPTION_QOS,
    SENSOR_DATA_QOS,
    STATIC_TF_PUBLISHER_QOS,
    TF_QOS,
    Node,
)
from linkwright.messages import JointState, String, TFMessage, TransformBatch
from linkwright.nodes.joint_layout import JointSettings, layout_of
from linkwright.nodes.robot_state_publisher import MOVING_TYPES, RobotTransforms
from linkwright.urdf import Robot

PREFIX = "old"
"""The TF Prefix of its frames."""
TOPIC = "/old/robot_description"
"""The topic of its description."""


class OldRobot:
    """Publishes a description, and its transforms with the joint positions of another robot.

    Joints that both robots have follow the other robot. Joints that only the old robot has are at zero, or in the
    middle of their limits if the limits exclude zero.

    Args:
        node: the node that publishes, which other programs need not see.
        listener: the node that receives the other robot's joint states.
    """

    def __init__(self, node: Node, listener: Node) -> None:
        self._listener = listener
        self._text = node.create_publisher(String, TOPIC, DESCRIPTION_QOS)
        self._fixed = node.create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS)
        self._moving = node.create_publisher(TFMessage, "/tf", TF_QOS)
        self._positions: dict[str, float] = {}
        self._transforms: RobotTransforms | None = None
        self._leaders: dict[str, str] = {}
        self._zeros: dict[str, float] = {}
        listener.create_subscription(JointState, "joint_states", self._moved, SENSOR_DATA_QOS)

    def publish(self, text: str) -> None:
        """Publish a description; call `place` to publish the poses of its links."""
        self._text.publish(String(text))

    def place(self, old: Robot, new: Robot, comparison: Comparison) -> None:
        """Publish the poses of the old robot's links, now and with each of the new robot's joint states.

        Args:
            old: the robot of the published description.
            new: the robot whose joint states are received.
            comparison: the links and joints that correspond.
        """
        now = self._listener.get_clock().now_ns()
        self._transforms = RobotTransforms(old, f"{PREFIX}/")
        self._leaders = joints_that_follow(old, new, comparison.joints)
        self._zeros = _positions_at_zero(old, self._leaders)
        fixed = self._transforms.fixed(now)
        parent, pose = _anchor(old, new, comparison.links)
        batch = TransformBatch(
            (*fixed.parents, parent),
            (*fixed.children, f"{PREFIX}/{old.root}"),
            now,
            np.vstack([fixed.poses, pose[np.newaxis]]),
        )
        self._fixed.publish(TFMessage(batch=batch))
        self._publish_moving(now)

    def _moved(self, message: JointState) -> None:
        self._positions.update(zip(message.name, message.position, strict=False))
        self._publish_moving(message.header.stamp.nanoseconds)

    def _publish_moving(self, stamp_ns: int) -> None:
        if self._transforms is None or not self._zeros:
            return
        known, leaders = self._positions, self._leaders
        positions = [known.get(leaders.get(name, ""), zero) for name, zero in self._zeros.items()]
        batch = self._transforms.recipe(tuple(self._zeros)).batch(positions, stamp_ns)
        self._moving.publish(TFMessage(batch=batch))


def joints_that_follow(old: Robot, new: Robot, same: Mapping[str, str]) -> dict[str, str]:
    """Return the joints of the old robot that follow one of the new robot: new names by old names.

    A joint and the joint that it follows are both revolute, or both prismatic.
    """
    return {
        name: twin
        for name, twin in same.items()
        if {old.joints[name].type, new.joints[twin].type} <= MOVING_TYPES
        and (old.joints[name].type == "prismatic") == (new.joints[twin].type == "prismatic")
    }


def _positions_at_zero(robot: Robot, leaders: Mapping[str, str]) -> dict[str, float]:
    """Return the initial positions of the movable joints by name, in rad or m.

    Joints that mimic another movable joint are omitted.
    """
    zeros = {joint.name: joint.zero for joint in layout_of(robot, JointSettings()).ranges.values()}
    moving = [joint for joint in robot.joints.values() if joint.type in MOVING_TYPES]
    given = {joint.name for joint in moving if joint.mimic is None or joint.name in leaders}
    return {
        joint.name: zeros.get(joint.name, 0.0)
        for joint in moving
        if joint.name in given or joint.mimic is None or joint.mimic.joint not in given
    }


def _anchor(old: Robot, new: Robot, same: Mapping[str, str]) -> tuple[str, NDArray[np.float64]]:
    """Return the frame of the new robot to which the old root is attached, and the root's pose in it.

    The common link nearest to the old root coincides in both robots, with the joints between that link and the root at
    zero.
    """
    below: dict[str, list[tuple[str, NDArray[np.float64]]]] = {}
    for joint in old.joints.values():
        below.setdefault(joint.parent, []).append((joint.child, row_from_pose(joint.origin)))
    start = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
    waiting = deque([(old.root, start)])
    while waiting:
        link, pose = waiting.popleft()
        if link in same:
            return same[link], invert(pose)
        waiting += [(child, compose(pose, origin)) for child, origin in below.get(link, ())]
    return new.root, start
