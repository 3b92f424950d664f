# SPDX-License-Identifier: Apache-2.0
"""Launch a bridge, with the arguments of the ros_gz_bridge file of this name."""

from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription

ARGUMENTS = {
    "bridge_name": ("ros_gz_bridge", "The node's name"),
    "config_file": ("", "The path of a YAML file with the topics to bridge"),
    "namespace": ("", "The namespace of the node"),
    "log_level": ("info", "The log level"),
    "container_name": ("ros_gz_container", "Not used"),
    "create_own_container": ("False", "Not used"),
    "use_composition": ("False", "Not used"),
    "use_respawn": ("False", "Not used"),
    "bridge_params": ("", "Not used"),
}


def generate_launch_description():
    """Return a launch description that declares the arguments and starts the bridge."""
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    bridge = Node(
        package="ros_gz_bridge",
        executable="parameter_bridge",
        name=LaunchConfiguration("bridge_name"),
        namespace=LaunchConfiguration("namespace"),
        output="screen",
        parameters=[{"config_file": LaunchConfiguration("config_file")}],
        arguments=["--ros-args", "--log-level", LaunchConfiguration("log_level")],
    )
    return LaunchDescription([*arguments, bridge])
