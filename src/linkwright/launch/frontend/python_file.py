"""Reads and runs Python launch files, and reports their errors."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    SourceText,
    Span,
    as_typed,
    did_you_mean,
    display_path,
    foreign,
    missing_file_hint,
    phrase,
)
from linkwright.diagnostics.lookalikes import lookalike_hint
from linkwright.files.input_files import read_text
from linkwright.launch.errors.exceptions import InvalidPythonLaunchFileError, as_ros_error
from linkwright.launch.errors.locations import MarkupLocation, SourceLocation, error_at, outside_markup
from linkwright.launch.errors.user_code import explain
from linkwright.launch.model.description import LaunchDescription
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.packages.share_layout import find_source

_FUNCTION_NAME = "generate_launch_description"
_MODULE_NAME = "python_launch_file"


def load_python_launch_file(path: Path) -> LaunchDescription:
    """Run a launch file and return the description from its ``generate_launch_description()``.

    Raises:
        LinkwrightError: LAUNCH101, there is no such file; LAUNCH102, the file cannot be read; LAUNCH103, it has a
            syntax error; LAUNCH104, it raised an exception; LAUNCH105, it does not define the function; LAUNCH106, the
            function does not return a `LaunchDescription`.
    """
    with outside_markup():
        source = read_launch_file(path)
        module = _run_module(source, path)
        function = getattr(module, _FUNCTION_NAME, None)
        if not callable(function):
            hint = did_you_mean(_FUNCTION_NAME, vars(module)) or phrase(
                "define {function}(), which returns a LaunchDescription", function=_FUNCTION_NAME
            )
            message = phrase(
                "launch file '{path}' has no function '{function}'",
                path=display_path(source.name),
                function=_FUNCTION_NAME,
            )
            text = f"launch file at '{path}' does not contain the required function '{_FUNCTION_NAME}()'"
            raise error_at(None, "LAUNCH105", message, hint, ros_error=InvalidPythonLaunchFileError(text))
        try:
            description = function()
        except (Exception, SystemExit) as error:
            if isinstance(error, SystemExit) and not error.code:
                raise
            subject = phrase("launch file '{path}'", path=display_path(source.name))
            raise explain(error, subject, _locate_definition(function, source)) from error
    if not isinstance(description, LaunchDescription):
        message = phrase(
            "'{function}' returned {kind}, not a LaunchDescription",
            function=_FUNCTION_NAME,
            kind=_describe_type(description),
        )
        hint = phrase("end the function with: return LaunchDescription([...])")
        ros_error = InvalidPythonLaunchFileError(message)
        raise error_at(_locate_definition(function, source), "LAUNCH106", message, hint, ros_error=ros_error)
    return description


def _locate_definition(function: Callable[..., Any], source: SourceText) -> SourceLocation:
    """Return the location of the line that defines a function in a launch file.

    If the function is defined in another file, the location is the first line of the launch file.
    """
    code = getattr(function, "__code__", None)
    line = code.co_firstlineno if code is not None and code.co_filename == source.name else 1
    start = source.offset(line, 1)
    return MarkupLocation(source, start, start + len(source.line(line)))


def load_python_module(path: Path) -> ModuleType:
    """Run a launch file, and return its module.

    Raises:
        LinkwrightError: LAUNCH101 to LAUNCH104, see `load_python_launch_file`.
    """
    with outside_markup():
        return _run_module(read_launch_file(path), path)


def _run_module(source: SourceText, path: Path) -> ModuleType:
    """Run a launch file, and return its module with ``__file__`` set to the path.

    Messages name the user's original file, even if the path leads to a copy.
    """
    try:
        code = compile(source.text, source.name, "exec", dont_inherit=True)
    except SyntaxError as error:
        raise as_ros_error(error, _create_syntax_diagnostic(error, source)) from error
    except ValueError as error:  # Python before 3.12 raises this for a null byte
        raise _create_error(
            "LAUNCH103",
            phrase("launch file '{path}' is not Python: {error}", path=display_path(source.name), error=foreign(error)),
        ) from error
    module = ModuleType(_MODULE_NAME)
    module.__file__ = str(path)
    try:
        exec(code, module.__dict__)  # noqa: S102 - a launch file is a program that the user runs
    except (Exception, SystemExit) as error:
        if isinstance(error, SystemExit) and not error.code:
            raise  # the launch file exited normally
        raise explain(error, phrase("launch file '{path}'", path=display_path(source.name))) from error
    return module


def read_launch_file(path: Path) -> SourceText:
    """Return the text of a launch file in any language.

    The text has the name of the user's original file (see `source_of`).

    Raises:
        LinkwrightError: LAUNCH101, there is no such file; LAUNCH102, the file cannot be read.
    """
    name = find_source(str(path))
    shown_path = display_path(name)
    try:
        return SourceText(name, read_text(path, "utf-8-sig"))
    except FileNotFoundError as error:
        hint = missing_file_hint(path, is_launch_file_name)
        message = phrase("launch file '{path}' does not exist", path=as_typed(shown_path))
        raise error_at(None, "LAUNCH101", message, hint, ros_error=error) from error
    except IsADirectoryError as error:
        hint = missing_file_hint(path / "_", is_launch_file_name)
        raise error_at(
            None,
            "LAUNCH101",
            phrase("'{path}' is a folder, not a launch file", path=shown_path),
            hint,
            ros_error=error,
        ) from error
    except OSError as error:
        message = phrase(
            "launch file '{path}' cannot be read: {strerror}", path=shown_path, strerror=foreign(error.strerror)
        )
        raise error_at(None, "LAUNCH102", message, ros_error=error) from error
    except UnicodeDecodeError as error:
        raise _create_error(
            "LAUNCH102",
            phrase("launch file '{path}' is not UTF-8: {reason}", path=shown_path, reason=foreign(error.reason)),
        ) from error


def _create_syntax_diagnostic(error: SyntaxError, source: SourceText) -> Diagnostic:
    line = error.lineno or 1
    column = max(error.offset or 1, 1)
    end_line = error.end_lineno or line
    end_column = error.end_offset or column + 1
    if end_line < line or (end_line == line and end_column <= column):
        end_line, end_column = line, column + 1
    span = Span(source.name, line, column, end_line, end_column)
    hint = lookalike_hint(source.line(line)[column - 1 :]) if "invalid character" in error.msg else None
    message = phrase("the launch file has a syntax error: {msg}", msg=foreign(error.msg))
    return Diagnostic("LAUNCH103", message, span, hint=hint, source=source)


def _describe_type(value: object) -> Phrase:
    return phrase("None") if value is None else phrase("a {type}", type=type(value).__name__)


def _create_error(code: str, message: Phrase, hint: Phrase | None = None) -> LinkwrightError:
    return LinkwrightError(Diagnostic(code, message, hint=hint))
