"""The functions of the ``ros2 launch`` verb that programs use (``ros2launch.api``)."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from linkwright.launch.arguments import format_arguments
from linkwright.launch.engine.service import LaunchService
from linkwright.launch.frontend.include import IncludeLaunchDescription
from linkwright.launch.frontend.launch_file import load_launch_file
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.introspector import format_launch_description
from linkwright.packages import current_finder
from linkwright.packages.launch_files import is_launch_file_name


class MultipleLaunchFilesError(Exception):
    """Raised when a package has several files with the same name.

    Attributes:
        paths: the paths of the files.
    """

    def __init__(self, msg: str, paths: Sequence[str]) -> None:
        super().__init__(msg)
        self.paths = list(paths)


def get_share_file_path_from_package(*, package_name: str, file_name: str) -> str:
    """Return the path of a file in the share folder of a package or in one of its subfolders.

    Raises:
        PackageNotFoundError: PKG101, there is no such package.
        FileNotFoundError: the package has no such file.
        MultipleLaunchFilesError: the package has several files with this name.
    """
    share = current_finder().share(package_name)
    found = [str(Path(folder, file_name)) for folder, _, files in os.walk(share) if file_name in files]
    where = f"in the share directory of package '{package_name}'"
    if not found:
        raise FileNotFoundError(f"file '{file_name}' was not found {where} which is at '{share}'")
    if len(found) > 1:
        listed = ", ".join(f"'{path}'" for path in found)
        raise MultipleLaunchFilesError(f"file '{file_name}' was found more than once {where}: [{listed}]", found)
    return found[0]


def get_launch_file_paths(*, path: str) -> list[str]:
    """Return the paths of the launch files in a folder and its subfolders."""
    inside = (str(Path(folder, name)) for folder, _, files in os.walk(path) for name in files)
    return [candidate for candidate in inside if is_launch_file(candidate)]


def is_launch_file(path: str) -> bool:
    """Return whether a path names an existing file with the name of a launch file."""
    return is_launch_file_name(str(path)) and Path(path).is_file()


def parse_launch_arguments(launch_arguments: Sequence[str]) -> list[tuple[str, str]]:
    """Parse arguments ``name:=value`` into pairs.

    The last value of a repeated name wins.

    Raises:
        RuntimeError: an argument is malformed.
    """
    parsed: dict[str, str] = {}
    for argument in launch_arguments:
        name, sign, value = argument.partition(":=")
        if not name or not sign or not value:
            text = f"malformed launch argument '{argument}', expected format '<name>:=<value>'"
            raise RuntimeError(text)
        parsed[name] = value
    return list(parsed.items())


def print_a_launch_file(*, launch_file_path: str) -> None:
    """Print the entities of a launch file as a tree."""
    print(format_launch_description(load_launch_file(Path(launch_file_path))))


def print_arguments_of_launch_file(*, launch_file_path: str) -> None:
    """Print the arguments of a launch file."""
    print(format_arguments(load_launch_file(Path(launch_file_path))))


def launch_a_launch_file(
    *,
    launch_file_path: str,
    launch_file_arguments: Sequence[str],
    noninteractive: bool = False,
    debug: bool = False,
    **_: Any,
) -> int:
    """Launch a file with arguments, and wait for the launch to end.

    Returns:
        0, or 1 if something in the launch failed.
    """
    service = LaunchService(argv=launch_file_arguments, noninteractive=noninteractive, debug=debug)
    included = IncludeLaunchDescription(
        launch_file_path, launch_arguments=parse_launch_arguments(launch_file_arguments)
    )
    service.include_launch_description(LaunchDescription([included]))
    return service.run()
