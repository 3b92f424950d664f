"""The nodes that come with Linkwright: those of ROS 2 that show and move a robot description."""

from linkwright.nodes.executables import EXECUTABLES
from linkwright.nodes.joint_panel import JointPanel, JointSlider, PanelChange
from linkwright.nodes.joint_state_publisher import JointStatePublisher
from linkwright.nodes.joint_state_publisher_gui import JointStatePublisherGui
from linkwright.nodes.options import Factory, NodeOptions, RunningNode
from linkwright.nodes.robot_state_publisher import RobotStatePublisher
from linkwright.nodes.static_transform_publisher import StaticTransformPublisher

__all__ = [
    "EXECUTABLES",
    "Factory",
    "JointPanel",
    "JointSlider",
    "JointStatePublisher",
    "JointStatePublisherGui",
    "NodeOptions",
    "PanelChange",
    "RobotStatePublisher",
    "RunningNode",
    "StaticTransformPublisher",
]
