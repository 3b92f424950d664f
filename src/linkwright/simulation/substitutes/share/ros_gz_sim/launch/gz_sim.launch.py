# SPDX-License-Identifier: Apache-2.0
"""Launch the simulation as ``gz sim`` does.

The arguments are those of the ros_gz_sim file of this name.
"""

import shlex

from launch.actions import DeclareLaunchArgument, OpaqueFunction, RegisterEventHandler, Shutdown
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessExit, OnProcessStart, OnShutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription
from linkwright.simulation.nodes.command_line import parse_gz_server_command
from linkwright.simulation.nodes.process_list import ListedCommand

ARGUMENTS = {
    "gz_args": ("", "The command line of gz sim"),
    "gz_version": ("", "Not used"),
    "ign_args": ("", "The command line of gz sim if gz_args is empty"),
    "ign_version": ("", "Not used"),
    "debugger": ("false", "Not used"),
    "on_exit_shutdown": ("false", "Whether to shut down when the simulation ends"),
}


def start(context):
    """Return the node of the server, or of the window's substitute if only that is requested.

    While the node runs, the command is in the list of processes.
    """
    arguments = LaunchConfiguration("gz_args").perform(context) or LaunchConfiguration("ign_args").perform(context)
    command = parse_gz_server_command(shlex.split(arguments))
    required = IfCondition(LaunchConfiguration("on_exit_shutdown")).evaluate(context)
    node = Node(
        package=command.package,
        executable=command.executable,
        output="screen",
        arguments=command.ros_arguments,
        parameters=[command.parameters],
        on_exit=[Shutdown()] if required else None,
    )
    listed_commands = []

    def list_command(*_):
        listed_commands.append(ListedCommand(["gz", "sim", *shlex.split(arguments)]))

    def close(*_):
        for listed_command in listed_commands:
            listed_command.close()

    return [
        RegisterEventHandler(OnProcessStart(target_action=node, on_start=list_command)),
        RegisterEventHandler(OnProcessExit(target_action=node, on_exit=close)),
        RegisterEventHandler(OnShutdown(on_shutdown=close)),
        node,
    ]


def generate_launch_description():
    """Return a launch description that declares the arguments and starts the server."""
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    return LaunchDescription([*arguments, OpaqueFunction(function=start)])
