"""Colored messages on standard error, as in ``xacro.color``."""

from __future__ import annotations

import sys
from typing import IO, Any

_COLOR_CODES = {"red": 91, "yellow": 93}


def is_tty(stream: object) -> bool:
    """Return whether a stream is a terminal."""
    isatty = getattr(stream, "isatty", None)
    return isatty is not None and bool(isatty())


def colorize(msg: object, color: str | int | None, file: IO[str] | None = None, alt_text: str | None = None) -> str:
    """Return a message in a color for a terminal, or otherwise with the prefix `alt_text`."""
    code = _COLOR_CODES.get(color, 0) if isinstance(color, str) else color
    if code and is_tty(sys.stderr if file is None else file):
        return f"\x1b[{code}m{msg}\x1b[0m"
    return f"{alt_text or ''}{msg}"


def message(
    msg: object, *args: Any, file: IO[str] | None = None, alt_text: str | None = None, color: str | None = None
) -> None:
    """Print a message to a stream, by default standard error."""
    stream = sys.stderr if file is None else file
    print(colorize(msg, color, stream, alt_text), *args, file=stream)


def warning(*args: Any, **options: Any) -> None:
    """Print a warning. See `message`."""
    message(*args, **{"alt_text": "warning: ", "color": "yellow", **options})


def error(*args: Any, **options: Any) -> None:
    """Print an error. See `message`."""
    message(*args, **{"alt_text": "error: ", "color": "red", **options})
