# SPDX-License-Identifier: Apache-2.0
"""Launch two turtlesim nodes in the namespaces turtlesim1 and turtlesim2."""

from launch_ros.actions import Node

from launch import LaunchDescription


def generate_launch_description():
    """Return a launch description with both nodes."""
    return LaunchDescription(
        [
            Node(package="turtlesim", executable="turtlesim_node", namespace=namespace, output="screen")
            for namespace in ("turtlesim1", "turtlesim2")
        ]
    )
