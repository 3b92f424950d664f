# SPDX-License-Identifier: Apache-2.0
"""Launch the simulation, with the arguments of the gazebo_ros file of this name."""

import shlex

from ament_index_python.packages import get_package_share_path
from launch.actions import DeclareLaunchArgument, OpaqueFunction, Shutdown
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription
from linkwright.simulation.nodes.command_line import parse_classic_server_command

IGNORED = {
    "factory": "true",
    "force_system": "true",
    "gdb": "false",
    "help": "false",
    "init": "true",
    "initial_sim_time": "",
    "iters": "",
    "lockstep": "false",
    "minimal_comms": "false",
    "physics": "",
    "play": "",
    "profile": "",
    "record": "false",
    "record_encoding": "",
    "record_filter": "",
    "record_path": "",
    "record_period": "",
    "valgrind": "false",
    "verbose": "false",
    "version": "false",
}
"""Arguments of gzserver that have no effect here, and their defaults."""


def start_server(context):
    """Return the node of the server, configured by the launch arguments."""

    def value(name):
        return LaunchConfiguration(name).perform(context)

    arguments = [value("world")] if value("world") else []
    arguments += ["-u"] if value("pause").lower() in ("true", "1") else []
    arguments += ["--seed", value("seed")] if value("seed") else []
    command = parse_classic_server_command([*arguments, *shlex.split(value("extra_gazebo_args"))])
    required = IfCondition(LaunchConfiguration("server_required")).evaluate(context)
    return [
        Node(
            package=command.package,
            executable=command.executable,
            output="screen",
            arguments=command.ros_arguments,
            parameters=[*([value("params_file")] if value("params_file") else []), command.parameters],
            on_exit=[Shutdown()] if required else None,
        )
    ]


def generate_launch_description():
    """Return a launch description that declares the arguments and starts the server."""
    empty = get_package_share_path("gazebo_ros") / "worlds" / "empty.world"
    declared = {
        "world": (str(empty), "The path of the world file"),
        "pause": ("false", "Whether the simulation begins paused"),
        "seed": ("", "The seed of the random numbers"),
        "params_file": ("", "The path of a YAML file with the server's parameters"),
        "extra_gazebo_args": ("", "Additional command-line arguments"),
        "server_required": ("false", "Whether to shut down when the server ends"),
        **{name: (default, "Not used") for name, default in IGNORED.items()},
    }
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in declared.items()
    ]
    return LaunchDescription([*arguments, OpaqueFunction(function=start_server)])
