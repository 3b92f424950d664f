# SPDX-License-Identifier: Apache-2.0
"""Launch robot_state_publisher with the robot description of a package.

The arguments are those of urdf_launch's file of the same name.
"""

from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription

ARGUMENTS = {
    "urdf_package": "The package with the robot description",
    "urdf_package_path": "The path of the robot description in the package",
}


def generate_launch_description():
    """Return a launch description with the arguments and the node."""
    share = FindPackageShare(LaunchConfiguration("urdf_package"))
    path = PathJoinSubstitution([share, LaunchConfiguration("urdf_package_path")])
    description = ParameterValue(Command(["xacro '", path, "'"]), value_type=str)
    node = Node(
        package="robot_state_publisher",
        executable="robot_state_publisher",
        parameters=[{"robot_description": description}],
    )
    declared = [DeclareLaunchArgument(name, description=text) for name, text in ARGUMENTS.items()]
    return LaunchDescription([*declared, node])
