"""Read names that sources make from a pattern, such as an f-string or the format of ``snprintf``."""

from __future__ import annotations

import re

_TEXT = re.compile(r"\"(?P<double>(?:\\.|[^\"\\])*)\"|'(?P<single>(?:\\.|[^'\\])*)'")
_FORMATTED = re.compile(r"\b[fF][rR]?[\"']|\b[rR][fF][\"']")
_PLACE = re.compile(r"\{[^{}]*\}|%[-+ #0]*\d*(?:\.\d+)?[hlzjt]*[a-zA-Z]|%\(\w+\)[a-z]")
_OPEN = "{}"
"""The mark for a part of a pattern with an unknown value."""


def pattern_of(expression: str) -> str | None:
    """Return the texts in an expression with ``{}`` for the parts between them, or None if it has no texts.

    Args:
        expression: the expression that gives a name, in Python or C++.
    """
    if _FORMATTED.search(expression):
        expression = re.sub(r"\{[^{}]*\}", _OPEN, expression)  # its parts may have texts of their own
    texts = [match["double"] if match["single"] is None else match["single"] for match in _TEXT.finditer(expression)]
    pattern = _OPEN.join(_PLACE.sub(_OPEN, text) for text in texts)
    return pattern if re.search(r"\w", pattern.replace(_OPEN, "")) else None


def format_of(text: str, variable: str) -> str | None:
    """Return the last format that a C++ source writes into a text, as a literal with quotation marks, or None.

    Args:
        text: the source up to the use of the variable, without comments.
        variable: the name of the variable.
    """
    calls = re.compile(rf"\bsn?printf\s*\(\s*{re.escape(variable)}\s*,[^;\"]*(?P<format>\"(?:\\.|[^\"\\])*\")")
    formats = [match["format"] for match in calls.finditer(text)]
    return formats[-1] if formats else None
