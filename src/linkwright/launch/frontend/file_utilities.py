"""Launch files read by their path, as functions of ``launch.launch_description_sources``."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from linkwright.diagnostics import display_path, phrase
from linkwright.launch.errors.exceptions import InvalidLaunchFileError
from linkwright.launch.errors.places import error_at
from linkwright.launch.frontend.launch_file import load_markup_launch_file
from linkwright.launch.frontend.python_file import load_python_launch_file, load_python_module
from linkwright.launch.model.description import LaunchDescription

_ANY = "launch.launch_description_sources.any_launch_file_utilities"


def load_python_launch_file_as_module(launch_file_path: str | os.PathLike[str]) -> ModuleType:
    """Run a Python launch file as a module.

    Raises:
        FileNotFoundError: LAUNCH101, there is no such file.
    """
    return load_python_module(Path.cwd() / launch_file_path)


def get_launch_description_from_python_launch_file(launch_file_path: str | os.PathLike[str]) -> LaunchDescription:
    """The description of a Python launch file.

    Raises:
        FileNotFoundError: LAUNCH101, there is no such file.
        InvalidPythonLaunchFileError: LAUNCH105, it has no ``generate_launch_description``.
    """
    return load_python_launch_file(Path.cwd() / launch_file_path)


def get_launch_description_from_frontend_launch_file(
    launch_file_path: str | os.PathLike[str], *, parser: Any = None
) -> LaunchDescription:
    """The description of an XML or YAML launch file."""
    if parser is None:
        return load_markup_launch_file(Path.cwd() / launch_file_path)
    entity, made = parser.load(launch_file_path)
    description: LaunchDescription = made.parse_description(entity)
    return description


def get_launch_description_from_any_launch_file(
    launch_file_path: str | os.PathLike[str],
    *,
    parser: Any = None,  # noqa: ARG001 - the interface in ROS
) -> LaunchDescription:
    """The description of a launch file of any kind; first as its name says, then as the other kind.

    Raises:
        InvalidLaunchFileError: LAUNCH107, neither can read it.
    """
    names = sys.modules.get(_ANY, sys.modules[__name__])  # where users and tests put functions of their own
    in_markup = names.get_launch_description_from_frontend_launch_file
    in_python = names.get_launch_description_from_python_launch_file
    path = Path(launch_file_path)
    errors: list[Exception] = []
    for load in (in_python, in_markup) if path.suffix == ".py" else (in_markup, in_python):
        try:
            return load(launch_file_path)  # type: ignore[no-any-return]
        except Exception as error:  # noqa: BLE001, PERF203 - launch files are programs, and there are two tries
            errors.append(error)
    ros_error = InvalidLaunchFileError(path.suffix[1:], likely_errors=errors, launch_file_path=launch_file_path)
    message = phrase("launch file '{path}' cannot be read", path=display_path(path))
    raise error_at(None, "LAUNCH107", message, ros_error=ros_error) from errors[0]
