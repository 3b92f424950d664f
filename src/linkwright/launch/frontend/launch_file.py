"""Launch files of any kind: Python, XML and YAML."""

from __future__ import annotations

import io
from pathlib import Path

from linkwright.diagnostics import LinkwrightError, display_path, phrase
from linkwright.launch.errors.exceptions import InvalidLaunchFileError
from linkwright.launch.errors.places import error_at
from linkwright.launch.frontend.python_file import load_python_launch_file, read_launch_file
from linkwright.launch.model.description import LaunchDescription
from linkwright.packages.share_layout import source_of

_MARKUP = {".xml": "xml", ".launch": "xml", ".yaml": "yaml", ".yml": "yaml"}


def load_launch_file(path: Path) -> LaunchDescription:
    """The description of a launch file; its kind is told by its name, else by trying.

    Raises:
        LinkwrightError: LAUNCH101 to LAUNCH109 and LAUNCH115 to LAUNCH119, what is wrong with the file.
    """
    if path.suffix == ".py":
        return load_python_launch_file(path)
    text = read_launch_file(path).text
    from linkwright.launch.frontend.parser import Parser

    if path.suffix in _MARKUP or Parser.is_filename_valid(path.name):
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
    hint = phrase("its name should end in .launch.py, .launch.xml or .launch.yaml, which tells what it is")
    ros_error = InvalidLaunchFileError("", likely_errors=errors, launch_file_path=path)
    raise error_at(None, "LAUNCH107", message, hint, ros_error=ros_error) from errors[0]


def load_markup_launch_file(path: Path, text: str | None = None) -> LaunchDescription:
    """The description of an XML or YAML launch file, or one in a language that a package has a parser for.

    Raises:
        LinkwrightError: LAUNCH101, LAUNCH102, LAUNCH107 to LAUNCH109 and LAUNCH115 to LAUNCH119.
    """
    from linkwright.launch.frontend.parser import Parser

    opened = io.StringIO(read_launch_file(path).text if text is None else text)
    opened.name = source_of(str(path))
    entity, parser = Parser.load(opened)
    return parser.parse_description(entity)
