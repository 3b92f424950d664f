# SPDX-License-Identifier: Apache-2.0
"""Launch the simulation as ``gz sim`` does.

The arguments are those of the ros_gz_sim file of this name.
"""

import shlex

from launch.actions import DeclareLaunchArgument, OpaqueFunction, Shutdown
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription
from linkwright.simulation.nodes.command_line import parse_gz_server_command

ARGUMENTS = {
    "gz_args": ("", "The command line of gz sim"),
    "gz_version": ("", "Not used"),
    "ign_args": ("", "The command line of gz sim if gz_args is empty"),
    "ign_version": ("", "Not used"),
    "debugger": ("false", "Not used"),
    "on_exit_shutdown": ("false", "Whether to shut down when the simulation ends"),
}


def start(context):
    """Return the node of the server, or of the window's substitute if only that is requested."""
    arguments = LaunchConfiguration("gz_args").perform(context) or LaunchConfiguration("ign_args").perform(context)
    command = parse_gz_server_command(shlex.split(arguments))
    required = IfCondition(LaunchConfiguration("on_exit_shutdown")).evaluate(context)
    return [
        Node(
            package=command.package,
            executable=command.executable,
            output="screen",
            arguments=command.ros_arguments,
            parameters=[command.parameters],
            on_exit=[Shutdown()] if required else None,
        )
    ]


def generate_launch_description():
    """Return a launch description that declares the arguments and starts the server."""
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    return LaunchDescription([*arguments, OpaqueFunction(function=start)])
