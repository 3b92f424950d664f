"""``linkwright test``: run the launch_testing tests of a file, as ``launch_test`` does."""

from __future__ import annotations

import argparse
import os

from linkwright.cli.process_replacement import replace_process

_LAUNCH_TEST_CODE = "from launch_testing.launch_test import main; main()"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``test``."""
    parser.usage = f"{parser.prog} [options] FILE [NAME:=VALUE ...]"
    parser.add_argument("file", metavar="FILE", help="a file with generate_test_description and tests")
    parser.add_argument("words", metavar="NAME:=VALUE", nargs="*", help="arguments of the file's launch description")
    parser.add_argument(
        "-s",
        "--show-args",
        "--show-arguments",
        action="store_true",
        help="list the arguments of the launch description and exit",
    )
    parser.add_argument("--junit-xml", metavar="REPORT", help="write a JUnit report for CI servers to this file")
    parser.add_argument("--package-name", metavar="NAME", help="the package name in the report")
    parser.add_argument("-v", "--verbose", action="store_true", help="print detailed log messages of the launch system")


def run(arguments: argparse.Namespace) -> int:
    """Run the tests in a separate process with the stand-ins, and return 0 if all tests passed."""
    from linkwright.packages import PackageFinder
    from linkwright.packages.programs.workspace_environment import make_workspace_environment
    from linkwright.shell.programs import append_programs_to_path, set_ros_variables
    from linkwright.standins import process

    set_ros_variables(os.environ)
    append_programs_to_path(os.environ)
    options = [f"--{name.replace('_', '-')}" for name in ("show_args", "verbose") if getattr(arguments, name)]
    for name in ("junit_xml", "package_name"):
        if getattr(arguments, name) is not None:
            options += [f"--{name.replace('_', '-')}", getattr(arguments, name)]
    command = process.python_command(["-c", _LAUNCH_TEST_CODE, arguments.file, *arguments.words, *options])
    return replace_process(command, process.create_environment(make_workspace_environment(PackageFinder(), os.environ)))
