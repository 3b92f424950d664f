"""Find parameters of ROS 2 that sources declare but never read, so that their values have no effect."""

from __future__ import annotations

import re
from collections.abc import Iterable

from linkwright.review.sources.cpp.text import blank_comments

_ANY_READING = re.compile(
    r"\b(?:get_parameters|get_parameters_by_prefix|list_parameters|ParamListener|get_node_parameters_interface"
    r"|automatically_declare_parameters_from_overrides)\b"
)
"""Code that reads parameters whose names it need not contain."""
_PYTHON_COMMENT = re.compile(r"(?:^|(?<=\s))#[^\n]*")
_DECLARATION = (
    r"(?:{start})\s*(?:\w+(?:->|\.))?declare_parameter\s*(?:<[^;()]*>)?\s*\(\s*[\"']{name}[\"']",
    r"[;{}]",
    r"(?<=[^\s(,=\\\[{+])[ \t]*\n",
)
"""The pattern of a statement that declares a parameter, and the text before it in C++ and in Python."""


def is_only_declared(text: str, others: Iterable[str], name: str, *, is_python: bool) -> bool:
    """Return whether a source declares a parameter in a statement of its own, and no source of the package reads it.

    Args:
        text: the text of the source.
        others: the texts of the other sources of the package.
        name: the name of the parameter.
        is_python: whether the source is in Python.
    """
    text = _PYTHON_COMMENT.sub("", text) if is_python else blank_comments(text)
    literal = re.compile(rf"[\"'](?:[\w.~/]*[./])?{re.escape(name)}[\"']")
    pattern, *starts = _DECLARATION
    statement = re.compile(pattern.format(start=starts[is_python], name=re.escape(name)))
    declared = len(statement.findall(text))
    if not declared or declared != len(literal.findall(text)) or _ANY_READING.search(text):
        return False
    return not any(literal.search(other) for other in others)
