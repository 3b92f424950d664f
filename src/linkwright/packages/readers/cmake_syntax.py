"""Parser for CMake files, which returns commands with their arguments, and blocks."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import SourceText
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass

_PIECE = lazy_pattern(
    r"""
    (?P<blank>\s+)
  | (?P<comment>\#\[(?P<level>=*)\[.*?\](?P=level)\] | \#[^\n]*)
  | \[(?P<equals>=*)\[(?P<bracket>.*?)\](?P=equals)\]
  | "(?P<quoted>(?:[^"\\]|\\.)*)"
  | (?P<open>\() | (?P<close>\))
  | (?P<word>(?:[^\s()"\#\\]|\\.|"(?:[^"\\]|\\.)*")+)
    """,
    re.VERBOSE | re.DOTALL,
)
_OPEN = lazy_pattern(r"\$(\{|ENV\{|<)")
_ESCAPED = lazy_pattern(r"\\([^A-Za-z0-9;])")
ENDS = {
    "if": "endif",
    "foreach": "endforeach",
    "while": "endwhile",
    "function": "endfunction",
    "macro": "endmacro",
}
"""The commands that begin a block, and those that end it."""


def is_open(text: str) -> bool:
    """Return whether a text contains a variable or generator expression that only CMake can evaluate."""
    return _OPEN.search(text) is not None


@dataclass(frozen=True, slots=True)
class Token:
    """An argument of a command.

    Attributes:
        text: the text without quotes.
        start: the character offset where the argument starts.
        end: the character offset where the argument ends, exclusive.
        is_quoted: whether the argument is in quotes or brackets, so that a list in it is not split.
        has_variables: whether ``${...}`` in the text is replaced.
    """

    text: str
    start: int
    end: int
    is_quoted: bool
    has_variables: bool


@dataclass(frozen=True, slots=True)
class Statement:
    """A command as it is written in a file.

    Attributes:
        name: the name in lower case.
        tokens: the arguments.
        source: the file.
    """

    name: str
    tokens: tuple[Token, ...]
    source: SourceText


def statements(source: SourceText) -> Iterator[Statement]:
    """Yield the commands of a file in the order of the text.

    Nested parentheses are treated as arguments.
    """
    text = source.text
    at, name, depth = 0, "", 0
    tokens: list[Token] = []
    while at < len(text):
        piece = _PIECE.match(text, at)
        if piece is None:
            at += 1
            continue
        at = piece.end()
        if piece["open"] or piece["close"]:
            if (depth > 0 and piece["open"]) or depth > 1:
                tokens.append(Token(piece[0], piece.start(), piece.end(), is_quoted=False, has_variables=False))
            depth = depth + 1 if piece["open"] else max(0, depth - 1)
            if depth == 0 and name:
                yield Statement(name.lower(), tuple(tokens), source)
                name, tokens = "", []
        elif piece["word"] and depth == 0:
            name, tokens = piece["word"], []
        elif depth and piece["blank"] is None and piece["comment"] is None:
            tokens.append(_argument(piece))


def _argument(piece: re.Match[str]) -> Token:
    if piece["bracket"] is not None:
        return Token(piece["bracket"], piece.start(), piece.end(), is_quoted=True, has_variables=False)
    quote = 1 if piece["quoted"] is not None else 0
    text = piece["word"] or piece["quoted"] or ""
    return Token(
        _ESCAPED.sub(r"\1", text), piece.start() + quote, piece.end() - quote, is_quoted=bool(quote), has_variables=True
    )


def end_of_block(commands: Sequence[Statement], at: int, name: str) -> int:
    """Return the index of the command that closes a block.

    If the block is not closed, return the number of commands.

    Args:
        commands: the commands.
        at: the index after the command that opens the block.
        name: the name of the command that opens the block.
    """
    depth = 1
    for index in range(at, len(commands)):
        depth += (commands[index].name == name) - (commands[index].name == ENDS[name])
        if not depth:
            return index
    return len(commands)


def branches(opening: Statement, body: Sequence[Statement]) -> Iterator[tuple[Statement | None, Sequence[Statement]]]:
    """Yield the branches of an ``if``.

    Each branch is the command with the condition, or None for ``else``, and the body.
    """
    condition: Statement | None = opening
    depth = start = 0
    for index, command in enumerate(body):
        depth += (command.name == "if") - (command.name == "endif")
        if depth == 0 and command.name in ("elseif", "else"):
            yield condition, body[start:index]
            condition, start = (command if command.name == "elseif" else None), index + 1
    yield condition, body[start:]
