"""Runs an executable of a package without a launch file."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.plans import has_window
from linkwright.hosting.rqt_arguments import format_usage
from linkwright.hosting.rqt_programs import find_panel_program
from linkwright.hosting.rviz2_arguments import USAGE, asks_for_help
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.ros import Node
from linkwright.launch.ros.executables import Origin, find_executable
from linkwright.launch.run import LaunchOptions, run_description
from linkwright.packages import PackageFinder
from linkwright.packages.programs.child_python import process_environment
from linkwright.packages.programs.workspace_environment import make_workspace_environment


@dataclass(frozen=True)
class Program:
    """An executable with its command and environment.

    Attributes:
        command: the command as a list of arguments.
        environment: the environment variables of the process.
        is_linkwright: whether the executable is one of Linkwright's own nodes.
    """

    command: list[str]
    environment: dict[str, str]
    is_linkwright: bool


def find_program(finder: PackageFinder, package: str, executable: str) -> Program:
    """Return the command and environment for an executable of a package.

    Raises:
        LinkwrightError: LAUNCH131, there is no such package or executable.
    """
    executable_of_package = find_executable(finder, package, executable)
    environment = process_environment(make_workspace_environment(finder, os.environ))
    return Program(executable_of_package.command, environment, executable_of_package.origin is Origin.LINKWRIGHT)


def run_viewer(package: str, executable: str, arguments: Sequence[str], options: LaunchOptions | None = None) -> int:
    """Run the viewer, Linkwright's replacement for RViz, rqt and the window of turtlesim, until the user ends it.

    Args:
        package: the package of the program that the viewer replaces.
        executable: the name of the program, ``rviz2``, ``turtlesim_node`` or a program of rqt.
        arguments: the command-line arguments of the program.
        options: the options of the viewer; None for the defaults.

    Returns:
        The exit status, see `linkwright.launch.run_launch`.
    """
    if asks_for_help(arguments) and not has_window(package, executable):
        program = find_panel_program(package, executable)
        print(USAGE if program is None else format_usage(executable, program), end="")
        return 0
    viewer = Node(package=package, executable=executable, arguments=list(arguments))

    def load(_: LaunchLog) -> tuple[LaunchDescription, dict[str, Any]]:
        return LaunchDescription([viewer]), {}

    return run_description(load, {}, PackageFinder(), options or LaunchOptions(), executable)
