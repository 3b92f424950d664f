"""The nodes that a launch file can name: package and executable to what starts one in this process."""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.nodes.joint_state_publisher import JointStatePublisher
from linkwright.nodes.joint_state_publisher_gui import JointStatePublisherGui
from linkwright.nodes.options import Factory
from linkwright.nodes.robot_state_publisher import RobotStatePublisher
from linkwright.nodes.static_transform_publisher import StaticTransformPublisher

EXECUTABLES: Mapping[tuple[str, str], Factory] = {
    ("robot_state_publisher", "robot_state_publisher"): RobotStatePublisher,
    ("joint_state_publisher", "joint_state_publisher"): JointStatePublisher,
    ("joint_state_publisher_gui", "joint_state_publisher_gui"): JointStatePublisherGui,
    ("tf2_ros", "static_transform_publisher"): StaticTransformPublisher,
}
