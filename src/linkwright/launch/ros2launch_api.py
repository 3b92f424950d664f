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
    """Raised when a package has several launch files with the same name.

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
    paths = [str(Path(folder, file_name)) for folder, _, files in os.walk(share) if file_name in files]
    location = f"in the share directory of package '{package_name}'"
    if not paths:
        raise FileNotFoundError(f"file '{file_name}' was not found {location} which is at '{share}'")
    if len(paths) > 1:
        paths_text = ", ".join(f"'{path}'" for path in paths)
        raise MultipleLaunchFilesError(f"file '{file_name}' was found more than once {location}: [{paths_text}]", paths)
    return paths[0]


def get_launch_file_paths(*, path: str) -> list[str]:
    """Return the paths of all launch files in a folder and its subfolders."""
    file_paths = (str(Path(folder, name)) for folder, _, files in os.walk(path) for name in files)
    return [candidate for candidate in file_paths if is_launch_file(candidate)]


def is_launch_file(path: str) -> bool:
    """Return whether a path leads to an existing file with the name of a launch file."""
    return is_launch_file_name(str(path)) and Path(path).is_file()


def parse_launch_arguments(launch_arguments: Sequence[str]) -> list[tuple[str, str]]:
    """Return pairs of name and value for arguments in the form ``name:=value``.

    If a name is repeated, the last value counts.

    Raises:
        RuntimeError: an argument does not have this form.
    """
    values: dict[str, str] = {}
    for argument in launch_arguments:
        name, separator, value = argument.partition(":=")
        if not name or not separator or not value:
            text = f"malformed launch argument '{argument}', expected format '<name>:=<value>'"
            raise RuntimeError(text)
        values[name] = value
    return list(values.items())


def print_a_launch_file(*, launch_file_path: str) -> None:
    """Print the entities of a launch file as a tree."""
    print(format_launch_description(load_launch_file(Path(launch_file_path))))


def print_arguments_of_launch_file(*, launch_file_path: str) -> None:
    """Print the arguments that a launch file declares."""
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
        0 if the launch succeeded, and 1 if something in it failed.
    """
    service = LaunchService(argv=launch_file_arguments, noninteractive=noninteractive, debug=debug)
    include_action = IncludeLaunchDescription(
        launch_file_path, launch_arguments=parse_launch_arguments(launch_file_arguments)
    )
    service.include_launch_description(LaunchDescription([include_action]))
    return service.run()
