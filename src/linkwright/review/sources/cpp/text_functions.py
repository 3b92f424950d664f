"""Evaluate the functions of C++ sources that take no arguments and only return a text."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

_DEFINITION = re.compile(
    r"\b(?:string|string_view|char|auto)\b[\s*&]*(?:const\s*[*&]?\s*)?(?:\w+\s*::\s*)*(?P<name>[A-Za-z_]\w*)"
    r"\s*\(\s*(?:void)?\s*\)\s*(?:const|noexcept|override|final|\s)*(?:->[\s\w:&*]+)?\{\s*return\b(?P<value>[^;{}]*);\s*\}"
)
_PART = re.compile(
    r"\s*(?:(?:std\s*::\s*)?string\s*\(\s*)?\"(?P<text>[^\"\\]*)\"\s*\)?\s*|"
    r"\s*(?:this\s*->\s*)?(?:\w+\s*::\s*)*(?P<name>[A-Za-z_]\w*)\s*(?P<call>\(\s*\))?\s*"
)
_RESOLVE = re.compile(r"\b(?:ros\s*::\s*)?names\s*::\s*resolve\s*\(\s*(?P<text>\"[^\"\\]*\")\s*\)")
"""A call of ROS 1 that returns a name with the remappings of the node, which is the same by default."""
_MAX_DEPTH = 5


class TextFunctions:
    """The functions that always return the same text.

    Functions that share their name but return something else are left out.

    Args:
        texts: the source and its headers, without comments.
        constants: the text constants that functions may return, by name.
    """

    def __init__(self, texts: Iterable[str], constants: Mapping[str, str]) -> None:
        self._constants = constants
        self._returned: dict[str, set[str]] = {}
        for text in texts:
            for match in _DEFINITION.finditer(text):
                self._returned.setdefault(match["name"], set()).add(match["value"].strip())

    def evaluate(self, expression: str) -> str | None:
        """Return the text of an expression that calls such a function, or None for any other expression.

        Args:
            expression: the expression, such as ``prefix() + "/state"``.
        """
        resolved = _RESOLVE.sub(lambda match: match["text"], expression)
        is_resolved = resolved != expression
        if "(" not in expression or not (self._returned or is_resolved):
            return None
        return self._evaluate(resolved, 0)

    def find_returned(self, call: str) -> str | None:
        """Return the expression that a function without arguments returns, such as a member, or None if it is unknown.

        Args:
            call: the call, such as ``this->prefix()``.
        """
        match = _PART.fullmatch(call)
        values = self._returned.get(match["name"], ()) if match is not None and match["call"] else ()
        return next(iter(values)) if len(values) == 1 else None

    def _evaluate(self, expression: str, depth: int) -> str | None:
        if depth > _MAX_DEPTH:
            return None
        parts = [self._evaluate_part(part, depth) for part in expression.split("+")]
        return None if None in parts else "".join(part for part in parts if part is not None)

    def _evaluate_part(self, part: str, depth: int) -> str | None:
        match = _PART.fullmatch(part)
        if match is None or match["text"] is not None:
            return None if match is None else match["text"]
        if not match["call"]:
            return self._constants.get(match["name"])
        values = self._returned.get(match["name"], set())
        return self._evaluate(next(iter(values)), depth + 1) if len(values) == 1 else None
