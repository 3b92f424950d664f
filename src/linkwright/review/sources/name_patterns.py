"""Read names that sources compute from a pattern.

Patterns are f-strings and the formats of ``snprintf``.
"""

from __future__ import annotations

import re

_TEXT = re.compile(r"\"(?P<double>(?:\\.|[^\"\\])*)\"|'(?P<single>(?:\\.|[^'\\])*)'")
_F_STRING = re.compile(r"\b[fF][rR]?[\"']|\b[rR][fF][\"']")
_PLACEHOLDER = re.compile(r"\{[^{}]*\}|%[-+ #0]*\d*(?:\.\d+)?[hlzjt]*[a-zA-Z]|%\(\w+\)[a-z]")
_CALLED = re.compile(r"(\w+)\s*\(")
_JOINING_CALLS = frozenset({"format", "string", "to_string", "str", "c_str", "String"})
"""The functions whose results contain the texts in their arguments."""
_LISTING = re.compile(r"\b(?:get_parameters_by_prefix|list_parameters|get_param_names|getParamNames)\b")
"""A function that returns the names of the parameters that are set."""
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


def is_sum_of_texts(expression: str) -> bool:
    """Return whether an expression joins texts with others, without calls that give other texts."""
    is_sum = "+" in _TEXT.sub("", expression) and _TEXT.search(expression) is not None
    return is_sum and set(_CALLED.findall(expression)) <= _JOINING_CALLS


def ends_with_name(expression: str, name: str) -> bool:
    """Return whether an expression puts a namespace or another text before a name, as ``prefix + ".name"`` does.

    Args:
        expression: the expression that gives a name, in Python or C++.
        name: the name.
    """
    pattern = extract_pattern(expression)
    if pattern is None or not set(_CALLED.findall(expression)) <= _JOINING_CALLS:
        return False
    return pattern.rpartition(_UNKNOWN_PART)[2].lstrip("~./_") == name.lstrip("~/")


def lists_names(old: str | None, new: str | None, text: str) -> bool:
    """Return whether a source reads the parameters that are set by a prefix, and a new pattern covers an old one.

    Args:
        old: the old pattern of the names.
        new: the new pattern.
        text: the text of the new source.
    """
    if old is None or new is None or _LISTING.search(text) is None:
        return False
    return re.fullmatch(".*".join(map(re.escape, new.split(_UNKNOWN_PART))), old) is not None


def make_expression_pattern(expression: str) -> str | None:
    """Return a regular expression for the names that an expression gives; None if its end is not a known word.

    Args:
        expression: the expression that gives a name, in Python or C++.
    """
    pattern = extract_pattern(expression)
    if pattern is None or not re.search(r"/\w+\Z", pattern):
        return None
    return ".*".join(re.escape(text) for text in pattern.split(_UNKNOWN_PART))


def can_make(expression: str, name: str) -> bool:
    """Return whether an expression may have a name as its value; True if it is unknown.

    Args:
        expression: the expression that gives a name, in Python or C++.
        name: the name.
    """
    pattern = extract_pattern(expression)
    if pattern is None or not set(_CALLED.findall(expression)) <= _JOINING_CALLS:
        return True
    start = 0
    for text in pattern.split(_UNKNOWN_PART):
        position = name.find(text, start)
        if position < 0:
            return False
        start = position + len(text)
    return True


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
