"""Terminal colors for markup such as ``@{redf}`` (API of ``osrf_pycommon.terminal_color``)."""

from __future__ import annotations

import re
from string import Template
from typing import Any

_ESCAPE_SEQUENCE = re.compile(r"\033\[\d{1,2}[m]")
_STYLE_CODES = {
    "boldon": 1,
    "italicson": 3,
    "ulon": 4,
    "invon": 7,
    "boldoff": 22,
    "italicsoff": 23,
    "uloff": 24,
    "invoff": 27,
}
_COLOR_NAMES = ("black", "red", "green", "yellow", "blue", "purple", "cyan", "white")
_SHORT_FORMS = {"@!": "@{boldon}", "@/": "@{italicson}", "@_": "@{ulon}", "@|": "@{reset}"}


def _create_ansi_codes() -> dict[str, str]:
    numbers = {"reset": 0, **_STYLE_CODES}
    for index, color in enumerate(_COLOR_NAMES):
        numbers[f"{color}f"], numbers[f"{color}b"] = 30 + index, 40 + index
    sequences = {name: f"\033[{number}m" for name, number in numbers.items()}
    escapes = {"escape": "\033", "atexclamation": "@!", "atfwdslash": "@/", "atunderscore": "@_", "atbar": "@|"}
    return {**sequences, **escapes}


_SEQUENCES_BY_NAME = _create_ansi_codes()


class _ColorSetting:
    """Whether markup is replaced with escape sequences, or removed."""

    is_on = True


class _MarkupTemplate(Template):
    delimiter = "@"


def ansi(key: str) -> str:
    """Return the escape sequence of a style such as ``redf`` or ``reset``.

    The result is empty while colors are disabled.

    Raises:
        KeyError: there is no such style.
    """
    return get_ansi_dict()[key]


def get_ansi_dict() -> dict[str, str]:
    """Return the escape sequences of all styles by name.

    They are empty while colors are disabled.
    """
    return dict(_SEQUENCES_BY_NAME) if _ColorSetting.is_on else dict.fromkeys(_SEQUENCES_BY_NAME, "")


def enable_ansi_color_substitution_globally() -> None:
    """Enable colors, so that markup is replaced with escape sequences."""
    _ColorSetting.is_on = True


def disable_ansi_color_substitution_globally() -> None:
    """Disable colors, so that markup is removed."""
    _ColorSetting.is_on = False


def format_color(msg: str) -> str:
    """Replace the markup in a string, and append the sequence ``reset``.

    Short forms such as ``@!`` are also replaced.

    Raises:
        KeyError: there is no such color or style.
        ValueError: an ``@`` does not start any markup; `sanitize` escapes it.
    """
    for short_form, long_form in _SHORT_FORMS.items():
        msg = msg.replace(short_form, long_form)
    return _MarkupTemplate(msg).substitute(get_ansi_dict()) + ansi("reset")


def print_color(*args: Any, **kwargs: Any) -> None:
    """Print strings after replacing their markup, with the arguments of ``print``."""
    end, separator = kwargs.pop("end", "\n"), kwargs.pop("sep", " ")
    print(format_color(separator.join(map(str, args))), end=end, **kwargs)


def sanitize(msg: str) -> str:
    """Escape a string so that `format_color` returns the original string."""
    return (
        msg.replace("@", "@@")
        .replace("@@!", "@{atexclamation}")
        .replace("@@/", "@{atfwdslash}")
        .replace("@@_", "@{atunderscore}")
        .replace("@@|", "@{atbar}")
    )


def remove_ansi_escape_sequences(string: str) -> str:
    """Return a string without its escape sequences."""
    return _ESCAPE_SEQUENCE.sub("", string)


def split_by_ansi_escape_sequence(string: str, include_delimiters: bool = False) -> list[str]:
    """Split a string at escape sequences.

    Args:
        string: the string to split.
        include_delimiters: whether the result contains the escape sequences.
    """
    return re.split(f"({_ESCAPE_SEQUENCE.pattern})" if include_delimiters else _ESCAPE_SEQUENCE, string)
