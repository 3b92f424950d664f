"""The exceptions of ``launch`` that programs catch."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


class InvalidLaunchFileError(Exception):
    """A launch file cannot be read.

    Args:
        extension: how its name ends; empty where that tells nothing.
        likely_errors: what was raised by those who tried.
        launch_file_path: the file.
    """

    def __init__(
        self, extension: str = "", *, likely_errors: Sequence[BaseException] | None = None, launch_file_path: Any = None
    ) -> None:
        errors = list(likely_errors or ())
        lines = [f" - {type(error).__name__}: {error}" for error in errors]
        if extension and errors:
            number = "multiple exceptions" if len(errors) > 1 else "exception"
            lines.insert(0, f"Caught {number} when trying to load file of format [{extension}]:")
        else:
            lines.insert(0, "The launch file may have a syntax error, or its format is unknown")
        if launch_file_path is not None:
            lines.insert(0, f"Launch file '{launch_file_path}':")
        elif not extension:
            del lines[1:]
        super().__init__("\n".join(lines))
        if errors:
            self.__cause__ = errors[0]


class InvalidFrontendLaunchFileError(InvalidLaunchFileError):
    """No parser can read a launch file in a markup language."""


class InvalidPythonLaunchFileError(InvalidLaunchFileError):
    """A Python launch file does not give a launch description."""


class SubstitutionFailure(RuntimeError):  # noqa: N818 - its name in ROS
    """A substitution cannot give a text."""
