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
from linkwright.launch.invalid_file import InvalidPythonLaunchFileError
from linkwright.launch.places import error_at, not_reading
from linkwright.launch.promises import keeping
from linkwright.launch.user_errors import explain

_FUNCTION = "generate_launch_description"
_MODULE_NAME = "python_launch_file"
_ENDINGS = tuple(dot + "launch" + suffix for dot in "._" for suffix in (".py", ".xml", ".yaml", ".yml"))


def load_python_launch_file(path: Path) -> LaunchDescription:
    """Run a launch file and return the description that its ``generate_launch_description()`` makes.

    Raises:
        LinkwrightError: LAUNCH101 no such file, LAUNCH102 unreadable, LAUNCH103 a syntax error, LAUNCH104 an
            exception inside it, LAUNCH105 no such function in it, LAUNCH106 no description returned.
    """
    with not_reading():
        source = read_launch_file(path)
        module = _run(source)
        function = getattr(module, _FUNCTION, None)
        if not callable(function):
            hint = did_you_mean(_FUNCTION, vars(module)) or f"define {_FUNCTION}() in it"
            message = f"launch file '{display_path(path)}' has no function '{_FUNCTION}'"
            text = f"launch file at '{path}' does not contain the required function '{_FUNCTION}()'"
            raise error_at(None, "LAUNCH105", message, hint, promises=InvalidPythonLaunchFileError(text))
        try:
            description = function()
        except Exception as error:
            raise explain(error, f"launch file '{display_path(path)}'") from error
    if not isinstance(description, LaunchDescription):
        line = function.__code__.co_firstlineno if hasattr(function, "__code__") else 1
        start = source.offset(line, 1)
        span = source.span(start, start + len(source.line(line)))
        message = f"'{_FUNCTION}' returned {_kind(description)}, not a LaunchDescription"
        hint = "end it with: return LaunchDescription([...])"
        diagnostic = Diagnostic("LAUNCH106", message, span, hint=hint, source=source)
        raise keeping(InvalidPythonLaunchFileError(message), diagnostic)
    return description


def load_python_module(path: Path) -> ModuleType:
    """Run a launch file and return it as a module.

    Raises:
        LinkwrightError: LAUNCH101 to LAUNCH104, see `load_python_launch_file`.
    """
    with not_reading():
        return _run(read_launch_file(path))


def _run(source: SourceText) -> ModuleType:
    path = Path(source.name)
    try:
        code = compile(source.text, str(path), "exec", dont_inherit=True)
    except SyntaxError as error:
        raise keeping(error, _syntax_diagnostic(error, source)) from error
    except ValueError as error:  # a null byte, before Python 3.12
        raise _error("LAUNCH103", f"launch file '{display_path(path)}' is not Python: {error}") from error
    module = ModuleType(_MODULE_NAME)
    module.__file__ = str(path)
    try:
        exec(code, module.__dict__)  # noqa: S102 - a launch file is a program that the user asks to run
    except Exception as error:
        raise explain(error, f"launch file '{display_path(path)}'") from error
    return module


def read_launch_file(path: Path) -> SourceText:
    """The text of a launch file of any kind.

    Raises:
        LinkwrightError: LAUNCH101 no such file, LAUNCH102 unreadable.
    """
    shown = display_path(path)
    try:
        return SourceText(str(path), path.read_text(encoding="utf-8-sig"))
    except FileNotFoundError as error:
        hint = missing_file_hint(path, is_launch_file_name)
        message = f"launch file '{shown}' does not exist"
        raise error_at(None, "LAUNCH101", message, hint, promises=error) from error
    except IsADirectoryError as error:
        hint = missing_file_hint(path / "_", is_launch_file_name)
        raise error_at(None, "LAUNCH101", f"'{shown}' is a folder, not a launch file", hint, promises=error) from error
    except OSError as error:
        message = f"launch file '{shown}' cannot be read: {error.strerror}"
        raise error_at(None, "LAUNCH102", message, promises=error) from error
    except UnicodeDecodeError as error:
        raise _error("LAUNCH102", f"launch file '{shown}' is not UTF-8: {error.reason}") from error


def is_launch_file_name(name: str) -> bool:
    """Whether a file is called as launch files are."""
    return name.endswith(_ENDINGS)


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
