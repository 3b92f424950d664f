"""``linkwright launch``: run a ROS 2 launch file, and open rviz2 as a page in the browser."""

from __future__ import annotations

import argparse
import os
import shlex

from linkwright.cli.view import add_viewer_options, find_terminal_folder


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``launch``."""
    parser.usage = "linkwright launch [options] (PACKAGE FILE | PATH) [NAME:=VALUE ...]"
    parser.add_argument(
        "words",
        metavar="PACKAGE FILE | PATH [NAME:=VALUE ...]",
        nargs="*",
        help="a package and a launch file in it, or the path of a launch file; then values for its arguments",
    )
    parser.add_argument(
        "-s", "--show-args", "--show-arguments", action="store_true", help="list the launch file's arguments and exit"
    )
    parser.add_argument(
        "-p", "--print", "--print-description", action="store_true", help="print the launch description and exit"
    )
    parser.add_argument(
        "--isolate", action="store_true", help="run each node that comes with Linkwright in its own process"
    )
    parser.add_argument(
        "--skip-missing",
        action="store_true",
        help="skip entities whose package, program or file is missing, and run the rest",
    )
    parser.add_argument(
        "-n",
        "--noninteractive",
        action="store_true",
        help="run without a terminal, which would also send signals to the processes",
    )
    parser.add_argument("-d", "--debug", action="store_true", help="print detailed log messages of the launch system")
    parser.add_argument(
        "-a",
        "--show-all-subprocesses-output",
        action="store_true",
        help="show the output of all processes on the screen, even if the launch file sets another destination",
    )
    parser.add_argument(
        "--launch-prefix", metavar="COMMAND", help="prefix the command lines of processes with this command"
    )
    parser.add_argument(
        "--launch-prefix-filter",
        metavar="PATTERN",
        help="apply the prefix only to programs whose names match this regular expression",
    )
    add_viewer_options(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the launch file until it ends, and return the exit status."""
    from linkwright import standins
    from linkwright.launch import LaunchOptions, parse_launch_words, print_description, run_launch, show_arguments
    from linkwright.shell.programs import append_programs_to_path, set_ros_variables

    target, values = parse_launch_words(arguments.words)
    standins.activate()
    set_ros_variables(os.environ)
    append_programs_to_path(os.environ)
    if arguments.show_args:
        print(show_arguments(target))
        return 0
    if arguments.print:
        print(print_description(target))
        return 0
    if arguments.show_all_subprocesses_output:
        os.environ["OVERRIDE_LAUNCH_PROCESS_OUTPUT"] = "both"
    options = LaunchOptions(
        arguments.host,
        arguments.port,
        not arguments.no_open,
        isolate=arguments.isolate,
        debug=arguments.debug,
        noninteractive=arguments.noninteractive,
        prefix=arguments.launch_prefix,
        prefix_filter=arguments.launch_prefix_filter,
        foxglove=arguments.foxglove,
        history=arguments.history,
        terminal=find_terminal_folder(arguments),
        skip_missing=arguments.skip_missing,
        command_to_skip_missing=shlex.join(["linkwright", "launch", "--skip-missing", *arguments.words]),
    )
    return run_launch(target, values, options)
