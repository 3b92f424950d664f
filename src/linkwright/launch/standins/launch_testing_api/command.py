"""The command ``launch_test``: runs tests during and after their launch.

This module replaces ``launch_testing.launch_test``.
"""

from __future__ import annotations

import argparse
import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from linkwright.launch.arguments import format_arguments
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.ros2launch_api import parse_launch_arguments
from linkwright.launch.standins.launch_testing_api.results import unittestResultsToXml
from linkwright.launch.standins.launch_testing_api.runner import LaunchTestRunner
from linkwright.launch.standins.launch_testing_api.test_runs import LoadTestsFromPythonModule


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    parser.add_argument("launch_test_file", help="the file with generate_test_description and tests")
    parser.add_argument("--package-name", help="the package that the tests belong to, for the report")
    parser.add_argument("-v", "--verbose", action="store_true", help="log details of the launch")
    parser.add_argument(
        "-s",
        "--show-args",
        "--show-arguments",
        action="store_true",
        help="list the arguments of the launch description and exit",
    )
    parser.add_argument("launch_arguments", nargs="*", metavar="NAME:=VALUE", help="arguments of the description")
    parser.add_argument("--junit-xml", dest="xmlpath", metavar="FILE", help="write a JUnit report to this file")


def parse_arguments() -> tuple[argparse.ArgumentParser, argparse.Namespace]:
    """Parse ``sys.argv``, and return the parser of the command and the parsed arguments."""
    parser = argparse.ArgumentParser(prog="launch_test", description="Run the tests of a file and their launch.")
    add_arguments(parser)
    return parser, parser.parse_args()


def run(
    parser: argparse.ArgumentParser,
    args: argparse.Namespace,
    test_runner_cls: type[LaunchTestRunner] = LaunchTestRunner,
) -> int:
    """Run the tests of a file.

    Args:
        parser: the parser, for usage errors.
        args: the arguments that `add_arguments` declares.
        test_runner_cls: the class that runs the tests.

    Returns:
        0 if all tests passed, otherwise 1.
    """
    path = Path(args.launch_test_file).absolute()
    if not path.is_file():
        parser.error(f"Test file '{args.launch_test_file}' does not exist")
    package = args.package_name or path.stem
    module = _load_module(package, path)
    if not hasattr(module, "generate_test_description"):
        parser.error(f"Test file '{args.launch_test_file}' has no function generate_test_description")
    runs = LoadTestsFromPythonModule(module, name=f"{package}.{path.stem}.launch_tests")
    runner = test_runner_cls(test_runs=runs, launch_file_arguments=args.launch_arguments, debug=args.verbose)
    try:
        parse_launch_arguments(args.launch_arguments)
        runner.validate()
    except Exception as error:  # noqa: BLE001 - launch_testing raises plain Exception
        parser.error(str(error))
    if args.show_args:
        print_arguments_of_launch_description(launch_description=runs[0].get_launch_description())
        return 0
    results: dict[Any, Any] = runner.run()
    if args.xmlpath:
        report = unittestResultsToXml(name=f"{package}.{path.stem}", test_results=results)
        report.write(args.xmlpath, encoding="utf-8", xml_declaration=True)
    return 0 if all(result.wasSuccessful() for result in results.values()) else 1


def print_arguments_of_launch_description(*, launch_description: LaunchDescription) -> None:
    """Print the arguments of a launch description."""
    print(format_arguments(launch_description))


def main() -> None:
    """Run the command, and exit.

    The status is 0 if all tests passed, 1 if not, and 2 for a usage error.
    """
    parser, args = parse_arguments()
    sys.exit(run(parser, args))


def _load_module(name: str, path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise ImportError(f"'{path}' is not a Python file", path=str(path))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
