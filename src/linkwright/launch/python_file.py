"""Python launch files: reading them, running them, and saying what is wrong with them."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    SourceText,
    Span,
    did_you_mean,
    display_path,
    missing_file_hint,
)
from linkwright.launch.description import LaunchDescription
from linkwright.launch.user_errors import explain

_FUNCTION = "generate_launch_description"
_MODULE_NAME = "python_launch_file"


def load_python_launch_file(path: Path) -> LaunchDescription:
    """Run a launch file and return the description that its ``generate_launch_description()`` makes.

    Raises:
        LinkwrightError: LAUNCH101 no such file, LAUNCH102 unreadable, LAUNCH103 a syntax error, LAUNCH104 an
        exception
            inside it, LAUNCH105 no such function in it, LAUNCH106 no description returned, LAUNCH107 not a
            Python file.
    """
    source = _read(path)
    try:
        code = compile(source.text, str(path), "exec", dont_inherit=True)
    except SyntaxError as error:
        raise LinkwrightError(_syntax_diagnostic(error, source)) from error
    except ValueError as error:  # a null byte, before Python 3.12
        raise _error("LAUNCH103", f"launch file '{display_path(path)}' is not Python: {error}") from error
    module = ModuleType(_MODULE_NAME)
    module.__file__ = str(path)
    try:
        exec(code, module.__dict__)  # noqa: S102 - a launch file is a program that the user asks to run
        function = getattr(module, _FUNCTION, None)
        description = function() if callable(function) else None
    except Exception as error:
        raise explain(error, f"launch file '{display_path(path)}'") from error
    if not callable(function):
        hint = did_you_mean(_FUNCTION, vars(module)) or f"define {_FUNCTION}() in it"
        raise _error("LAUNCH105", f"launch file '{display_path(path)}' has no function '{_FUNCTION}'", hint)
    if not isinstance(description, LaunchDescription):
        line = function.__code__.co_firstlineno if hasattr(function, "__code__") else 1
        start = source.offset(line, 1)
        span = source.span(start, start + len(source.line(line)))
        message = f"'{_FUNCTION}' returned {_kind(description)}, not a LaunchDescription"
        hint = "end it with: return LaunchDescription([...])"
        raise LinkwrightError(Diagnostic("LAUNCH106", message, span, hint=hint, source=source))
    return description


def _read(path: Path) -> SourceText:
    shown = display_path(path)
    if path.suffix in (".xml", ".yaml", ".yml"):
        hint = "write it as NAME.launch.py"
        raise _error("LAUNCH107", f"launch file '{shown}' is not Python, the only kind that runs so far", hint)
    try:
        return SourceText(str(path), path.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise _error(
            "LAUNCH101", f"launch file '{shown}' does not exist", missing_file_hint(path, is_launch_file_name)
        ) from error
    except IsADirectoryError as error:
        raise _error(
            "LAUNCH101", f"'{shown}' is a folder, not a launch file", missing_file_hint(path / "_", is_launch_file_name)
        ) from error
    except OSError as error:
        raise _error("LAUNCH102", f"launch file '{shown}' cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise _error("LAUNCH102", f"launch file '{shown}' is not UTF-8: {error.reason}") from error


def is_launch_file_name(name: str) -> bool:
    """Whether a file is called as launch files are."""
    return name.endswith((".launch.py", "_launch.py"))


def _syntax_diagnostic(error: SyntaxError, source: SourceText) -> Diagnostic:
    line = error.lineno or 1
    column = max(error.offset or 1, 1)
    end_line = error.end_lineno or line
    end_column = error.end_offset or column + 1
    if end_line < line or (end_line == line and end_column <= column):
        end_line, end_column = line, column + 1
    span = Span(source.name, line, column, end_line, end_column)
    return Diagnostic("LAUNCH103", f"syntax error in the launch file: {error.msg}", span, source=source)


def _kind(value: object) -> str:
    return "None" if value is None else f"a {type(value).__name__}"


def _error(code: str, message: str, hint: str | None = None) -> LinkwrightError:
    return LinkwrightError(Diagnostic(code, message, hint=hint))
