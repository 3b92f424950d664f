"""Publishes the older of two descriptions, with the joint positions of the newer robot."""

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
from linkwright.nodes.joint_layout import JointSettings, make_layout
from linkwright.nodes.robot_state_publisher import MOVING_TYPES, RobotTransforms
from linkwright.urdf import Robot

FRAME_PREFIX = "old"
"""The TF Prefix of the frames of the old robot."""
DESCRIPTION_TOPIC = "/old/robot_description"
"""The topic of the description of the old robot."""


class OldRobot:
    """A publisher of a description and its transforms, with another robot's joint positions.

    Joints that both robots have follow the joints of the other robot. Joints that only the old robot has are at zero,
    or in the middle of their limits if the limits exclude zero.

    Args:
        node: the node that publishes.
        listener: the node that receives the other robot's joint states.
    """

    def __init__(self, node: Node, listener: Node) -> None:
        self._listener = listener
        self._text = node.create_publisher(String, DESCRIPTION_TOPIC, DESCRIPTION_QOS)
        self._fixed = node.create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS)
        self._tf_publisher = node.create_publisher(TFMessage, "/tf", TF_QOS)
        self._positions: dict[str, float] = {}
        self._transforms: RobotTransforms | None = None
        self._followed_joints: dict[str, str] = {}
        self._zero_positions: dict[str, float] = {}
        listener.create_subscription(JointState, "joint_states", self._on_joint_states, SENSOR_DATA_QOS)

    def publish(self, text: str) -> None:
        """Publish a description. Call `publish_poses` to publish the poses of its links."""
        self._text.publish(String(data=text))

    def publish_poses(self, old: Robot, new: Robot, comparison: Comparison) -> None:
        """Publish the poses of the old robot's links, now and at each joint state of the new robot.

        Args:
            old: the robot of the published description.
            new: the robot whose joint states are received.
            comparison: the links and joints that correspond.
        """
        now_ns = self._listener.get_clock().now_ns()
        self._transforms = RobotTransforms(old, f"{FRAME_PREFIX}/")
        self._followed_joints = find_leading_joints(old, new, comparison.joints)
        self._zero_positions = _find_initial_positions(old, self._followed_joints)
        fixed_batch = self._transforms.fixed_transforms(now_ns)
        parent, pose = _attach_root(old, new, comparison.links)
        batch = TransformBatch(
            (*fixed_batch.parents, parent),
            (*fixed_batch.children, f"{FRAME_PREFIX}/{old.root}"),
            now_ns,
            np.vstack([fixed_batch.poses, pose[np.newaxis]]),
        )
        self._fixed.publish(TFMessage(batch=batch))
        self._publish_moving(now_ns)

    def _on_joint_states(self, message: JointState) -> None:
        self._positions.update(zip(message.name, message.position, strict=False))
        self._publish_moving(message.header.stamp.nanoseconds)

    def _publish_moving(self, stamp_ns: int) -> None:
        if self._transforms is None or not self._zero_positions:
            return
        joint_positions, leaders = self._positions, self._followed_joints
        positions = [joint_positions.get(leaders.get(name, ""), zero) for name, zero in self._zero_positions.items()]
        batch = self._transforms.find_conversion(tuple(self._zero_positions)).batch(positions, stamp_ns)
        self._tf_publisher.publish(TFMessage(batch=batch))


def find_leading_joints(old: Robot, new: Robot, same_names: Mapping[str, str]) -> dict[str, str]:
    """Return the joints of the new robot that move the old robot's joints, by old names.

    Both joints are revolute or continuous, or both are prismatic.
    """
    return {
        name: new_name
        for name, new_name in same_names.items()
        if {old.joints[name].type, new.joints[new_name].type} <= MOVING_TYPES
        and (old.joints[name].type == "prismatic") == (new.joints[new_name].type == "prismatic")
    }


def _find_initial_positions(robot: Robot, leaders: Mapping[str, str]) -> dict[str, float]:
    """Return the initial positions of the movable joints by name, in rad or m.

    Joints that mimic another movable joint are omitted, unless they take the position of a joint of the new robot.
    """
    zeros = {joint.name: joint.zero for joint in make_layout(robot, JointSettings()).ranges.values()}
    movable_joints = [joint for joint in robot.joints.values() if joint.type in MOVING_TYPES]
    independent_joints = {joint.name for joint in movable_joints if joint.mimic is None or joint.name in leaders}
    return {
        joint.name: zeros.get(joint.name, 0.0)
        for joint in movable_joints
        if joint.name in independent_joints or joint.mimic is None or joint.mimic.joint not in independent_joints
    }


def _attach_root(old: Robot, new: Robot, same_names: Mapping[str, str]) -> tuple[str, NDArray[np.float64]]:
    """Return a frame of the new robot, and the pose of the old robot's root in this frame.

    The common link that is nearest to the old root has the same pose in both robots. The joints between this link and
    the root are assumed to be at zero.
    """
    children: dict[str, list[tuple[str, NDArray[np.float64]]]] = {}
    for joint in old.joints.values():
        children.setdefault(joint.parent, []).append((joint.child, row_from_pose(joint.origin)))
    identity = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
    pending = deque([(old.root, identity)])
    while pending:
        link, pose = pending.popleft()
        if link in same_names:
            return same_names[link], invert(pose)
        pending += [(child, compose(pose, origin)) for child, origin in children.get(link, ())]
    return new.root, identity
