# SPDX-License-Identifier: Apache-2.0
"""Launch the simulation without a window.

The arguments are those of the ros_gz_sim file of this name.
"""

from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription

ARGUMENTS = {
    "world_sdf_file": ("", "The path of the world file"),
    "world_sdf_string": ("", "The text of the world in SDF"),
    "container_name": ("ros_gz_container", "Not used"),
    "create_own_container": ("False", "Not used"),
    "use_composition": ("False", "Not used"),
}


def start(context):
    """Return the node of the server with the requested world."""
    arguments = {name: LaunchConfiguration(name).perform(context) for name in ("world_sdf_file", "world_sdf_string")}
    parameters = {name: value for name, value in arguments.items() if value}
    return [Node(package="ros_gz_sim", executable="gzserver", output="screen", parameters=[parameters])]


def generate_launch_description():
    """Return a launch description that declares the arguments and starts the server."""
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    return LaunchDescription([*arguments, OpaqueFunction(function=start)])
