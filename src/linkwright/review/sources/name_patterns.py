"""Read names that sources compute from a pattern.

Patterns are f-strings and the formats of ``snprintf``.
"""

from __future__ import annotations

import re

_TEXT = re.compile(r"\"(?P<double>(?:\\.|[^\"\\])*)\"|'(?P<single>(?:\\.|[^'\\])*)'")
_F_STRING = re.compile(r"\b[fF][rR]?[\"']|\b[rR][fF][\"']")
_PLACEHOLDER = re.compile(r"\{[^{}]*\}|%[-+ #0]*\d*(?:\.\d+)?[hlzjt]*[a-zA-Z]|%\(\w+\)[a-z]")
_UNKNOWN_PART = "{}"
"""The mark for a part of a pattern with an unknown value."""


def extract_pattern(expression: str) -> str | None:
    """Return the texts in an expression, joined by ``{}``, or None if it has no texts.

    Args:
        expression: the expression that gives a name, in Python or C++.
    """
    if _F_STRING.search(expression):
        expression = re.sub(r"\{[^{}]*\}", _UNKNOWN_PART, expression)  # its parts may have texts of their own
    texts = [match["double"] if match["single"] is None else match["single"] for match in _TEXT.finditer(expression)]
    pattern = _UNKNOWN_PART.join(_PLACEHOLDER.sub(_UNKNOWN_PART, text) for text in texts)
    return pattern if re.search(r"\w", pattern.replace(_UNKNOWN_PART, "")) else None


def find_format(text: str, variable: str) -> str | None:
    """Return the last format with which a C++ source writes a variable, or None.

    It is a literal with quotation marks.

    Args:
        text: the source up to the use of the variable, without comments.
        variable: the name of the variable.
    """
    calls = re.compile(rf"\bsn?printf\s*\(\s*{re.escape(variable)}\s*,[^;\"]*(?P<format>\"(?:\\.|[^\"\\])*\")")
    formats = [match["format"] for match in calls.finditer(text)]
    return formats[-1] if formats else None
