"""Find the commands of the shell and other programs that only one version of a source starts."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from linkwright.diagnostics import Phrase, joined, joined_first, phrase
from linkwright.review.sources.names import CPP_SUFFIXES
from linkwright.review.sources.reading import try_read_source
from linkwright.review.sources.statements.added_texts import TextsChange
from linkwright.review.sources.statements.cpp import read_cpp_statements
from linkwright.review.sources.statements.literals import Statement
from linkwright.review.sources.statements.python import read_python_statements
from linkwright.review.sources.statements.tokens import Token, TokenKind, match_brackets
from linkwright.review.texts.excerpts import shorten_middle

_CALL = re.compile(
    r"(?:os\.(?:system|popen)|(?:subprocess|sp)\.(?:call|run|Popen|check_call|check_output)|(?:std::|::)?system"
    r"|popen|Popen|check_call|check_output)"
)
"""The functions that start a program, with their modules and namespaces."""
_QUOTATION_MARKS = re.compile(r"^[A-Za-z]*[\"']+|[\"']+$")
_SEPARATORS = frozenset({".", "::"})
_MAX_COMMANDS = 8
_MAX_CHARACTERS = 80


class _Command(NamedTuple):
    """A call that starts a program: the call, the texts of its first argument, and the token at its location."""

    shown: str
    texts: tuple[str, ...]
    token: Token


def find_command_changes(
    paths: tuple[Path, Path], has_text: tuple[Callable[[str], bool], Callable[[str], bool]], reported: Sequence[str]
) -> Iterator[TextsChange]:
    """Yield the commands with a literal text that only one version of a source starts.

    Args:
        paths: the old and the new source.
        has_text: functions that return whether the old or the new version has a text in any changed source.
        reported: the other lines about the source. Commands in these lines are left out.
    """
    old, new = (_read_commands(path) for path in paths)
    known = {item.texts for item in old} & {item.texts for item in new}
    removed, added = (
        [
            item
            for item in {item.texts: item for item in reversed(items)}.values()
            if item.texts not in known and not all(map(has_other, item.texts)) and not _is_told(item, reported)
        ][::-1]
        for items, has_other in ((old, has_text[1]), (new, has_text[0]))
    )
    parts = [phrase("commands added: {commands}", commands=_join(added))] if added else []
    parts += [phrase("commands removed: {commands}", commands=_join(removed))] if removed else []
    source = try_read_source(paths[1] if added else paths[0]) if parts else None
    if source is not None:
        token = (added or removed)[0].token
        yield TextsChange(joined(parts, "; "), source.span(token.start, token.end), is_old=not added)


def _join(commands: Sequence[_Command]) -> Phrase:
    return joined_first([shorten_middle(item.shown, _MAX_CHARACTERS) for item in commands], _MAX_COMMANDS)


def _is_told(command: _Command, reported: Sequence[str]) -> bool:
    """Return whether one line has all texts of a command."""
    return any(all(text in line for text in command.texts) for line in reported)


def _read_commands(path: Path) -> list[_Command]:
    """Return the commands that a source starts, in its order."""
    source = try_read_source(path)
    if source is None:
        return []
    try:
        scopes = (
            read_cpp_statements(source.text) if path.suffix in CPP_SUFFIXES else read_python_statements(source.text)
        )
    except (ValueError, SyntaxError, RecursionError):
        return []
    return sorted(_find_commands(scopes), key=lambda item: item.token.start)


def _find_commands(scopes: Mapping[str, Sequence[Statement]]) -> Iterator[_Command]:
    for statement in chain.from_iterable(scopes.values()):
        tokens = statement.tokens
        brackets = match_brackets(tokens) if any(token.text == "(" for token in tokens) else {}
        for index, token in enumerate(tokens):
            first = _find_start(tokens, index) if token.text == "(" and index in brackets else index
            if first == index or not _CALL.fullmatch("".join(item.text for item in tokens[first:index])):
                continue
            last = _find_argument_end(tokens, index, brackets)
            texts = [_read_text(item) for item in tokens[index + 1 : last + 1] if item.kind is TokenKind.TEXT]
            texts = [text for text in texts if any(character.isalnum() for character in text)]
            if texts:
                yield _Command(f"{statement.get_text(first, last)})", tuple(texts), tokens[first])


def _find_start(tokens: Sequence[Token], index: int) -> int:
    """Return the index of the first token of the function before a parenthesis, with its modules and namespaces.

    The result is the index of the parenthesis if there is no such function, or it is a method of an object.
    """
    first = index
    while first > 0 and tokens[first - 1].kind is TokenKind.WORD:
        first -= 1
        if first == 0 or tokens[first - 1].text not in _SEPARATORS:
            break
        first -= 1
    return index if first > 0 and tokens[first - 1].text == "->" else first


def _find_argument_end(tokens: Sequence[Token], index: int, brackets: Mapping[int, int]) -> int:
    """Return the index of the last token of the first argument of a call.

    Args:
        tokens: the tokens of the statement.
        index: the index of the parenthesis before the arguments.
        brackets: the index of the other bracket of each bracket.
    """
    last = index
    while last + 1 < brackets[index] and tokens[last + 1].text != ",":
        last = brackets.get(last + 1, last + 1)
    return last


def _read_text(token: Token) -> str:
    """Return the characters between the quotation marks of a literal text."""
    return _QUOTATION_MARKS.sub("", token.text)
