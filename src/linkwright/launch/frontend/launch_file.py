"""Readers for launch files of any kind: Python, XML and YAML."""

from __future__ import annotations

import io
import os
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from linkwright.diagnostics import LinkwrightError, display_path, phrase
from linkwright.launch.errors.exceptions import InvalidLaunchFileError
from linkwright.launch.errors.locations import error_at
from linkwright.launch.errors.user_code import too_deep_error
from linkwright.launch.frontend.python_file import load_python_launch_file, load_python_module, read_launch_file
from linkwright.launch.model.description import LaunchDescription
from linkwright.packages.share_layout import find_source

_MARKUP_LANGUAGES = {".xml": "xml", ".launch": "xml", ".yaml": "yaml", ".yml": "yaml"}


def load_launch_file(path: Path) -> LaunchDescription:
    """Load the description of a launch file.

    The file name determines the language. If it does not, the markup languages are tried first, and then Python.

    Raises:
        LinkwrightError: LAUNCH101 to LAUNCH109 and LAUNCH115 to LAUNCH119, errors in the file.
    """
    if path.suffix == ".py":
        return load_python_launch_file(path)
    text = read_launch_file(path).text
    from linkwright.launch.frontend.parser import Parser

    if path.suffix in _MARKUP_LANGUAGES or Parser.is_filename_valid(path.name):
        return load_markup_launch_file(path, text)
    try:
        return load_markup_launch_file(path, text)
    except LinkwrightError as error:
        errors: list[Exception] = [error]
    try:
        return load_python_launch_file(path)
    except LinkwrightError as error:
        errors.append(error)
    message = phrase("launch file '{path}' is neither Python, XML nor YAML", path=display_path(path))
    hint = phrase("give it a name that ends in .launch.py, .launch.xml or .launch.yaml")
    ros_error = InvalidLaunchFileError("", likely_errors=errors, launch_file_path=path)
    raise error_at(None, "LAUNCH107", message, hint, ros_error=ros_error) from errors[0]


def load_markup_launch_file(path: Path, text: str | None = None) -> LaunchDescription:
    """Load the description of a launch file in a markup language.

    The language is XML, YAML, or another one for which a package provides a parser.

    Raises:
        LinkwrightError: LAUNCH101, LAUNCH102, LAUNCH107 to LAUNCH109 and LAUNCH115 to LAUNCH119.
    """
    from linkwright.launch.frontend.parser import Parser

    file = io.StringIO(read_launch_file(path).text if text is None else text)
    file.name = find_source(str(path))
    try:
        entity, parser = Parser.load(file)
        return parser.parse_description(entity)
    except RecursionError as error:
        raise too_deep_error(file.name) from error


_PUBLIC_MODULE = "launch.launch_description_sources.any_launch_file_utilities"


def load_python_launch_file_as_module(launch_file_path: str | os.PathLike[str]) -> ModuleType:
    """Run a Python launch file, and return its module.

    Raises:
        FileNotFoundError: LAUNCH101, there is no such file.
    """
    return load_python_module(Path.cwd() / launch_file_path)


def get_launch_description_from_python_launch_file(launch_file_path: str | os.PathLike[str]) -> LaunchDescription:
    """Load the description of a Python launch file.

    Raises:
        FileNotFoundError: LAUNCH101, there is no such file.
        InvalidPythonLaunchFileError: LAUNCH105, the file has no ``generate_launch_description``.
    """
    return load_python_launch_file(Path.cwd() / launch_file_path)


def get_launch_description_from_frontend_launch_file(
    launch_file_path: str | os.PathLike[str], *, parser: Any = None
) -> LaunchDescription:
    """Load the launch description from an XML or YAML launch file."""
    if parser is None:
        return load_markup_launch_file(Path.cwd() / launch_file_path)
    entity, file_parser = parser.load(launch_file_path)
    description: LaunchDescription = file_parser.parse_description(entity)
    return description


def get_launch_description_from_any_launch_file(
    launch_file_path: str | os.PathLike[str],
    *,
    parser: Any = None,  # noqa: ARG001 - the interface in ROS
) -> LaunchDescription:
    """Load the description of a launch file in Python or markup.

    The language that the file name suggests is tried first, and then the other one.

    Raises:
        InvalidLaunchFileError: LAUNCH107, neither Python nor markup can be read from the file.
    """
    functions = sys.modules.get(_PUBLIC_MODULE, sys.modules[__name__])  # users and tests may replace these functions
    load_markup = functions.get_launch_description_from_frontend_launch_file
    load_python = functions.get_launch_description_from_python_launch_file
    path = Path(launch_file_path)
    errors: list[Exception] = []
    for load in (load_python, load_markup) if path.suffix == ".py" else (load_markup, load_python):
        try:
            return load(launch_file_path)  # type: ignore[no-any-return]  # may be a user's function
        except Exception as error:  # noqa: BLE001, PERF203 - launch files are programs; there are two attempts
            errors.append(error)
    ros_error = InvalidLaunchFileError(path.suffix[1:], likely_errors=errors, launch_file_path=launch_file_path)
    message = phrase("launch file '{path}' cannot be read", path=display_path(path))
    raise error_at(None, "LAUNCH107", message, ros_error=ros_error) from errors[0]
