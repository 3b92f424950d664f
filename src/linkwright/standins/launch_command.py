"""What programs use of ``ros2 launch`` from Python (``ros2launch.api``)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from linkwright.launch import LaunchOptions, LaunchTarget, print_description, run_launch, show_arguments
from linkwright.launch.arguments import parse_arguments


def get_share_file_path_from_package(*, package_name: str, file_name: str) -> str:
    """The path of a launch file of a package.

    Raises:
        LinkwrightError: PKG101, an unknown package; LAUNCH101, the package has no such file, or several.
    """
    target = LaunchTarget(file_name, package_name)
    return str(target.resolve(target.finder()))


def is_launch_file(path: str) -> bool:
    """Whether a path is one of a file that may be a launch file."""
    return Path(path).is_file() and Path(path).suffix in (".py", ".xml", ".yaml", ".yml")


def parse_launch_arguments(launch_arguments: Sequence[str]) -> list[tuple[str, str]]:
    """Names and values of words ``name:=value``; of several with one name the last counts.

    Raises:
        LinkwrightError: LAUNCH111, words of another form.
    """
    return list(parse_arguments(launch_arguments).items())


def print_a_launch_file(*, launch_file_path: str) -> None:
    """Print what a launch file describes."""
    print(print_description(LaunchTarget(launch_file_path)))


def print_arguments_of_launch_file(*, launch_file_path: str) -> None:
    """Print the arguments of a launch file."""
    print(show_arguments(LaunchTarget(launch_file_path)))


def launch_a_launch_file(
    *,
    launch_file_path: str,
    launch_file_arguments: Sequence[str],
    noninteractive: bool = False,
    debug: bool = False,
) -> int:
    """Run a launch file to its end; returns the exit status."""
    options = LaunchOptions(noninteractive=noninteractive, debug=debug)
    return run_launch(LaunchTarget(launch_file_path), parse_arguments(launch_file_arguments), options)
