"""Find comments, brackets and arguments in the text of a C++ source."""

from __future__ import annotations

import re
from collections.abc import Iterator

_COMMENT_OR_TEXT = re.compile(r"""//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<!\w)'(?:\\.|[^'\\\n])'""", re.DOTALL)
_BRACKETS = {"(": ")", "<": ">", "[": "]", "{": "}"}


def blank_comments(text: str) -> str:
    """Return a source with spaces for comments and character literals."""
    return _COMMENT_OR_TEXT.sub(
        lambda match: match[0] if match[0].startswith('"') else re.sub(r"[^\n]", " ", match[0]), text
    )


def find_closing_bracket(text: str, start: int) -> int:
    """Return the offset of the matching closing bracket, or the end of the text."""
    depth, opening = 0, text[start]
    for index in range(start, len(text)):
        depth += (text[index] == opening) - (text[index] == _BRACKETS[opening])
        if depth == 0:
            return index
    return len(text)


def find_arguments(text: str, start: int) -> Iterator[tuple[int, int]]:
    """Yield the offsets of the arguments in the parentheses or braces that begin at an offset."""
    depth, begin, is_text = 0, start + 1, False
    closing = "}" if text.startswith("{", start) else ")"
    for index in range(start + 1, len(text)):
        character = text[index]
        if character == '"' and text[index - 1] != "\\":
            is_text = not is_text
        if is_text:
            continue
        if depth == 0 and character in (",", closing):
            if text[begin:index].strip():
                yield begin, index
            if character == closing:
                return
            begin = index + 1
        depth += (character in "([{") - (character in ")]}")
