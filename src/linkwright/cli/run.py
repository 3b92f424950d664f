"""``linkwright run``: run an executable of a package, as ``ros2 run`` does."""

from __future__ import annotations

import argparse
import shlex

from linkwright.cli.process_replacement import replace_process
from linkwright.cli.view import add_viewer_options, find_terminal_folder


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``run``."""
    parser.usage = f"{parser.prog} [options] PACKAGE EXECUTABLE [ARGUMENT ...] [--ros-args ...]"
    parser.add_argument(
        "--prefix", metavar="COMMAND", help="prefix the command line with this command, such as 'gdb -ex run --args'"
    )
    add_viewer_options(parser)
    parser.add_argument("package", metavar="PACKAGE", help="the package")
    parser.add_argument("executable", metavar="EXECUTABLE", help="an executable of the package")
    parser.add_argument(
        "words",
        metavar="ARGUMENT",
        nargs=argparse.REMAINDER,
        help="arguments of the executable, including ROS arguments",
    )


def run(arguments: argparse.Namespace) -> int:
    """Run an executable of a package, and return its exit status.

    The viewer and Linkwright's own nodes run in this process. Another executable replaces this process, so that it
    receives the signals. On Windows, it runs in a child process.
    """
    from linkwright import standins
    from linkwright.launch import LaunchOptions, find_program, opens_page, run_viewer
    from linkwright.packages import PackageFinder

    program_arguments = list(arguments.words)
    if opens_page(arguments.package, arguments.executable):
        options = LaunchOptions(
            arguments.host,
            arguments.port,
            not arguments.no_open,
            foxglove=arguments.foxglove,
            history=arguments.history,
            terminal=find_terminal_folder(arguments),
        )
        return run_viewer(arguments.package, arguments.executable, program_arguments, options)
    standins.activate()
    program = find_program(PackageFinder(), arguments.package, arguments.executable)
    prefix = shlex.split(arguments.prefix) if arguments.prefix else []
    if program.is_linkwright and not prefix:
        from linkwright.nodes.process import main

        return main(arguments.package, arguments.executable, program_arguments)
    return replace_process([*prefix, *program.command, *program_arguments], program.environment)
