# SPDX-License-Identifier: Apache-2.0
"""Launch the robot description of a package with sliders for its joints and RViz.

The arguments are those of urdf_launch's file of the same name.
"""

from ament_index_python.packages import get_package_share_path
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription

FORWARDED = ("urdf_package", "urdf_package_path")


def generate_launch_description():
    """Return a launch description with the arguments, the description's launch file and the nodes."""
    share = get_package_share_path("urdf_launch")
    has_sliders = LaunchConfiguration("jsp_gui")
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "jsp_gui",
                default_value="true",
                choices=["true", "false"],
                description="Whether to start joint_state_publisher_gui instead of joint_state_publisher",
            ),
            DeclareLaunchArgument(
                "rviz_config",
                default_value=str(share / "config" / "urdf.rviz"),
                description="The path of the RViz configuration",
            ),
            IncludeLaunchDescription(
                str(share / "launch" / "description.launch.py"),
                launch_arguments={name: LaunchConfiguration(name) for name in FORWARDED}.items(),
            ),
            Node(
                package="joint_state_publisher",
                executable="joint_state_publisher",
                condition=UnlessCondition(has_sliders),
            ),
            Node(
                package="joint_state_publisher_gui",
                executable="joint_state_publisher_gui",
                condition=IfCondition(has_sliders),
            ),
            Node(
                package="rviz2",
                executable="rviz2",
                output="screen",
                arguments=["-d", LaunchConfiguration("rviz_config")],
            ),
        ]
    )
