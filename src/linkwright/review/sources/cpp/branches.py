"""Find the branches of conditions in the text of a C++ source, and those that end with a failure."""

from __future__ import annotations

import re

from linkwright.review.sources.cpp.text import find_closing_bracket

FAILURE = re.compile(
    r"\bthrow\b|\breturn\s+(?:false|-\s*1|EXIT_FAILURE|[\w:]*\b(?:ERROR|FAILURE))\s*;|\b(?:exit|abort|shutdown)\s*\("
)
"""The end of a program or function that fails."""
MAX_CONDITION_CHARACTERS = 400
_MAX_FUNCTION_CHARACTERS = 20_000
_BRACE = re.compile(r"[{}]")
_CONDITIONAL_HEAD = re.compile(r"\b(?:if|else|case|switch|catch)\b")


def is_in_branch(text: str, position: int) -> bool:
    """Return whether a place is in a block that a condition opens."""
    depth = 0
    for match in reversed(list(_BRACE.finditer(text, max(0, position - _MAX_FUNCTION_CHARACTERS), position))):
        depth += 1 if match[0] == "}" else -1
        if depth < 0:
            depth = 0
            head = re.split(r"[;{}]", text[max(0, match.start() - MAX_CONDITION_CHARACTERS) : match.start()])[-1]
            if _CONDITIONAL_HEAD.search(head):
                return True
    return False


def read_branch(text: str, start: int) -> str:
    """Return the statement or block behind a condition."""
    begin = start + len(text[start:]) - len(text[start:].lstrip())
    if text.startswith("{", begin):
        return text[begin : find_closing_bracket(text, begin)]
    end = text.find(";", begin)
    return text[begin : end + 1]
