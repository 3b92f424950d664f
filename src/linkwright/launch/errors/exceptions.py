"""The exceptions of ``launch`` that programs catch.

Some of Linkwright's errors are also instances of these exceptions.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError


class InvalidLaunchFileError(Exception):
    """Raised when a launch file cannot be read.

    Args:
        extension: the file name extension; empty if it does not determine the parser.
        likely_errors: the exceptions of the parsers that tried to read the file.
        launch_file_path: the path of the file.
    """

    def __init__(
        self, extension: str = "", *, likely_errors: Sequence[BaseException] | None = None, launch_file_path: Any = None
    ) -> None:
        errors = list(likely_errors or ())
        lines = [f" - {type(error).__name__}: {error}" for error in errors]
        if extension and errors:
            exception_count = "multiple exceptions" if len(errors) > 1 else "exception"
            lines.insert(0, f"Caught {exception_count} when trying to load file of format [{extension}]:")
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
    """Raised when no parser can read a launch file in a markup language."""


class InvalidPythonLaunchFileError(InvalidLaunchFileError):
    """Raised when a Python launch file does not provide a launch description."""


class SubstitutionFailure(RuntimeError):  # noqa: N818 - its name in ROS
    """Raised when a substitution cannot be evaluated to a string."""


def as_ros_error(ros_error: Exception | None, *diagnostics: Diagnostic) -> LinkwrightError:
    """Return a LinkwrightError that is also an instance of a ROS exception's class.

    Args:
        ros_error: the exception that a program may expect; its text precedes the text of the new error. If it is None,
            the result is a plain LinkwrightError.
        diagnostics: the findings for the user.
    """
    if ros_error is None:
        return LinkwrightError(*diagnostics)
    error = _combine_classes(_find_constructible_base(type(ros_error)))(*diagnostics)
    vars(error)["ros_text"] = str(ros_error)
    return error


def _find_constructible_base(kind: type[Exception]) -> type[Exception]:
    """Return an exception class or its nearest base class that accepts a single string."""
    candidates: list[type[Any]] = [
        candidate for candidate in kind.__mro__ if not issubclass(candidate, LinkwrightError)
    ]
    for base in candidates:
        try:
            base("")
        except TypeError:
            continue
        return base
    return Exception


_classes: dict[type, type[LinkwrightError]] = {}


def _combine_classes(kind: type[Exception]) -> type[LinkwrightError]:
    if kind in _classes:
        return _classes[kind]
    if issubclass(kind, LinkwrightError) or issubclass(LinkwrightError, kind):
        return LinkwrightError

    def __str__(self: Any) -> str:  # noqa: N807 - becomes the method of that name
        own_text = LinkwrightError.__str__(self)
        return own_text if self.ros_text in own_text else f"{self.ros_text}\n{own_text}"

    combined_class = _classes[kind] = type(kind.__name__, (LinkwrightError, kind), {"__str__": __str__})
    return combined_class
