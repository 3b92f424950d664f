"""Parser for the commands, arguments and blocks of CMake files."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import SourceText
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass

_TOKEN_PATTERN = lazy_pattern(
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
_REFERENCE = lazy_pattern(r"\$(\{|ENV\{|<)")
_ESCAPE = lazy_pattern(r"\\([^A-Za-z0-9;])")
BLOCK_ENDS = {
    "if": "endif",
    "foreach": "endforeach",
    "while": "endwhile",
    "function": "endfunction",
    "macro": "endmacro",
}
"""The commands that end blocks, by the commands that begin them."""
MAX_NESTED_BLOCKS = 60
"""The depth of nested blocks up to which commands are read."""


def is_open(text: str) -> bool:
    """Return whether a text contains an expression that only CMake can evaluate.

    This is a variable or a generator expression.
    """
    return _REFERENCE.search(text) is not None


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


def parse_statements(source: SourceText) -> Iterator[Statement]:
    """Yield the commands of a file in the order of the text.

    Nested parentheses are treated as arguments.
    """
    text = source.text
    position, name, depth = 0, "", 0
    tokens: list[Token] = []
    while position < len(text):
        match = _TOKEN_PATTERN.match(text, position)
        if match is None:
            position += 1
            continue
        position = match.end()
        if match["open"] or match["close"]:
            if (depth > 0 and match["open"]) or depth > 1:
                tokens.append(Token(match[0], match.start(), match.end(), is_quoted=False, has_variables=False))
            depth = depth + 1 if match["open"] else max(0, depth - 1)
            if depth == 0 and name:
                yield Statement(name.lower(), tuple(tokens), source)
                name, tokens = "", []
        elif match["word"] and depth == 0:
            name, tokens = match["word"], []
        elif depth and match["blank"] is None and match["comment"] is None:
            tokens.append(_make_token(match))


def _make_token(match: re.Match[str]) -> Token:
    if match["bracket"] is not None:
        return Token(match["bracket"], match.start(), match.end(), is_quoted=True, has_variables=False)
    quote = 1 if match["quoted"] is not None else 0
    text = match["word"] or match["quoted"] or ""
    return Token(
        _ESCAPE.sub(r"\1", text), match.start() + quote, match.end() - quote, is_quoted=bool(quote), has_variables=True
    )


def find_end_of_block(commands: Sequence[Statement], first_index: int, name: str) -> int:
    """Return the index of the command that closes a block.

    If the block is not closed, return the number of commands.

    Args:
        commands: the commands of the file or of a block.
        first_index: the index after the command that opens the block.
        name: the name of the command that opens the block.
    """
    depth = 1
    for index in range(first_index, len(commands)):
        depth += (commands[index].name == name) - (commands[index].name == BLOCK_ENDS[name])
        if not depth:
            return index
    return len(commands)


def split_branches(
    opening: Statement, body: Sequence[Statement]
) -> Iterator[tuple[Statement | None, Sequence[Statement]]]:
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
