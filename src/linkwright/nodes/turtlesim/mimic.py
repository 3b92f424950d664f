"""mimic: one turtle gets the velocities with which another moves."""

from __future__ import annotations

from typing import Any

from linkwright.graph import Graph
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.turtlesim.interfaces import TOPIC_QOS, find_interface_package


class Mimic(SingleNode):
    """The running mimic, which reads ``input/pose`` and publishes ``output/cmd_vel``."""

    DEFAULT_NAME = "turtle_mimic"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            pose_type = f"{find_interface_package(options.environment)}/msg/Pose"
            self._twist = get_message("geometry_msgs/msg/Twist")
            self._publisher = self._node.create_publisher(self._twist, "output/cmd_vel", TOPIC_QOS)
            self._node.create_subscription(pose_type, "input/pose", self._on_pose, TOPIC_QOS)

    def _on_pose(self, pose: Any) -> None:
        twist = self._twist()
        twist.linear.x, twist.angular.z = pose.linear_velocity, pose.angular_velocity
        self._publisher.publish(twist)
