# SPDX-License-Identifier: Apache-2.0
"""Launch the substitute for Gazebo's window.

The arguments are those of the gazebo_ros file of this name.
"""

from launch.actions import DeclareLaunchArgument, OpaqueFunction, Shutdown
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription

IGNORED = ("extra_gazebo_args", "gdb", "help", "profile", "valgrind", "verbose", "version")
"""Arguments of Gazebo's window that have no effect here."""


def start(context):
    """Return the node that replaces Gazebo's window."""
    required = IfCondition(LaunchConfiguration("gui_required")).evaluate(context)
    on_exit = [Shutdown()] if required else None
    return [Node(package="gazebo_ros", executable="gzclient", on_exit=on_exit)]


def generate_launch_description():
    """Return a launch description that declares the arguments and starts the node."""
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value="", description="Not used") for name in IGNORED),
            DeclareLaunchArgument(
                "gui_required", default_value="false", description="Whether to shut down when the window closes"
            ),
            OpaqueFunction(function=start),
        ]
    )
