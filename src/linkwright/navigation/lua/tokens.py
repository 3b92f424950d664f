"""The words of a file in Lua.

Source: the Lua 5.3 Reference Manual, section 3.1.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, SourceText, phrase

SYNTAX_CODE = "NAV601"
"""The code of the errors about the content of a file."""

_TOKEN = re.compile(
    r"""
    (?P<space>\s+ | --\[(?P<comment>=*)\[(?s:.*?)\](?P=comment)\] | --[^\n]*)
    | (?P<number>0[xX][0-9a-fA-F]+ | (?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)
    | (?P<name>[A-Za-z_]\w*)
    | (?P<string>"(?:\\(?s:.)|[^"\\\n])*" | '(?:\\(?s:.)|[^'\\\n])*' | \[(?P<level>=*)\[(?s:.*?)\](?P=level)\])
    | (?P<symbol>\.\.\.|\.\.|==|~=|<=|>=|//|[-+*/%^\#<>=(){}\[\];:,.])
    """,
    re.VERBOSE,
)
_ESCAPE = re.compile(r"\\(\d{1,3}|x[0-9a-fA-F]{2}|z\s*|(?s:.))")
_ESCAPED = {"n": "\n", "t": "\t", "r": "\r", "a": "\a", "b": "\b", "f": "\f", "v": "\v"}


class Token(NamedTuple):
    """A word of a file.

    Attributes:
        kind: ``number``, ``name``, ``string``, ``symbol`` or ``end``.
        text: the word, or the content of a string.
        start: the offset of its first character.
        end: the offset after its last character.
    """

    kind: str
    text: str
    start: int
    end: int


def make_error(source: SourceText, token: Token, message: Phrase, hint: Phrase | None = None) -> LinkwrightError:
    """Return the error NAV601 at a word."""
    span = source.span(token.start, max(token.end, token.start + 1))
    return LinkwrightError(Diagnostic(SYNTAX_CODE, message, span, hint=hint, source=source))


def iterate_tokens(source: SourceText) -> Iterator[Token]:
    """Yield the words of a file without comments, and a word of kind ``end``.

    Raises:
        LinkwrightError: NAV601, a character does not begin a word.
    """
    offset, text = 0, source.text
    while offset < len(text):
        match = _TOKEN.match(text, offset)
        if match is None:
            token = Token("symbol", text[offset], offset, offset + 1)
            if text[offset] in "\"'[":
                raise make_error(source, token, phrase("the string that begins here does not end"))
            raise make_error(source, token, phrase("'{text}' is not part of Lua", text=token.text))
        end = match.end()
        kind = next(name for name in ("space", "number", "name", "string", "symbol") if match[name] is not None)
        if kind == "string":
            yield Token(kind, _content(match["string"], match["level"]), offset, end)
        elif kind != "space":
            yield Token(kind, match[kind], offset, end)
        offset = end
    yield Token("end", "", offset, offset)


def _content(text: str, level: str | None) -> str:
    """Return the content of a string as it is written."""
    if level is not None:
        return text[len(level) + 2 : -len(level) - 2].removeprefix("\n")
    return _ESCAPE.sub(_unescape, text[1:-1])


def _unescape(match: re.Match[str]) -> str:
    text = match[1]
    if text[0].isdigit():
        return chr(int(text))
    if text[0] == "x" and len(text) == 3:
        return chr(int(text[1:], 16))
    if text[0] == "z":
        return ""
    return _ESCAPED.get(text, text)
