"""Texts with substitutions ``$(...)`` in launch files in XML and YAML."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from linkwright.packages import PackageFinder

_CLOSED_SUBSTITUTION = re.compile(r"\$\(\s*([\w-]+)(?:\s+([^()]*?))?\s*\)")
_BRACKET = re.compile(r"\$\(|\)")
_WORD = re.compile(r"""(?:\$\((?:[^()]|\$\([^()]*\))*\)|[^\s"'\[\],;])+""")
_MAX_PASSES = 8


@dataclass(frozen=True, slots=True)
class Substitution:
    """A ``$(...)`` that is not closed before the cursor.

    Attributes:
        command: the word after the parenthesis, up to the cursor.
        arguments: the arguments, the last one up to the cursor, or empty while the command is typed.
        start: the offset of the command in the text.
    """

    command: str
    arguments: tuple[str, ...]
    start: int

    @property
    def typed(self) -> str:
        """The word that ends at the cursor."""
        return self.arguments[-1] if self.arguments else self.command


def find_open_substitution(typed: str) -> Substitution | None:
    """Return the innermost ``$(...)`` around the end of a text, or None if all are closed."""
    opened: list[int] = []
    for mark in _BRACKET.finditer(typed):
        if mark[0] == ")":
            opened = opened[:-1]
        else:
            opened.append(mark.end())
    if not opened:
        return None
    inner = typed[opened[-1] :]
    command, space, arguments = inner.lstrip().partition(" ")
    start = opened[-1] + len(inner) - len(inner.lstrip())
    return Substitution(command, tuple(arguments.split(" ")) if space else (), start)


def substitution_around(text: str, offset: int) -> re.Match[str] | None:
    """Return the match of the innermost closed ``$(...)`` around an offset, or None.

    Its groups are the command and the arguments.
    """
    return next(
        (match for match in _CLOSED_SUBSTITUTION.finditer(text) if match.start() <= offset <= match.end()), None
    )


def evaluate(text: str, file: Path, finder: PackageFinder, configurations: Mapping[str, str | None]) -> str | None:
    """Evaluate the substitutions in a text, or return None if one is unknown.

    Args:
        text: an attribute value, as written.
        file: the launch file.
        finder: finds packages.
        configurations: the values of ``$(var NAME)`` by name, which may contain substitutions.
    """

    def value(match: re.Match[str]) -> str:
        command, argument = match[1], (match[2] or "").strip("'\" ")
        if command in ("find-pkg-share", "find"):
            share = finder.find(argument)
            return match[0] if share is None else str(share)
        if command == "dirname":
            return str(file.parent)
        if command in ("var", "arg"):
            default = configurations.get(argument.partition(" ")[0])
            return match[0] if default is None else default
        return match[0]

    for _ in range(_MAX_PASSES):
        replaced = _CLOSED_SUBSTITUTION.sub(value, text)
        if replaced == text or len(replaced) > len(text) + 10_000:
            break
        text = replaced
    return None if "$(" in text else text


def path_words(text: str) -> Iterator[tuple[int, int]]:
    """Yield the start and end of each word of a text. A ``$(...)`` is never split."""
    for match in _WORD.finditer(text):
        yield match.span()


def find_typed_word(typed: str) -> str:
    """Return the word at the end of a text without open substitutions, or an empty string."""
    for start, end in path_words(typed):
        if end == len(typed):
            return typed[start:]
    return ""


@cache
def substitution_names() -> Mapping[str, str]:
    """Return the names of all substitutions, each with the first line of its documentation."""
    from linkwright.launch.frontend.extensions import ACTION_GROUP, load
    from linkwright.launch.model.markup.expose import substitution_parse_methods

    for _ in load(ACTION_GROUP):
        pass
    return {
        name: _find_purpose(method)
        for name, method in sorted(substitution_parse_methods.items(), key=_rank_substitution)
    }


def _find_purpose(method: Callable[..., Any]) -> str:
    owner = getattr(method, "__self__", method)
    return (getattr(owner, "__doc__", None) or "").partition("\n")[0].replace("``", "`")


_COMMON_SUBSTITUTIONS = (
    "var",
    "find-pkg-share",
    "env",
    "dirname",
    "eval",
    "command",
    "find-exec",
    "exec-in-pkg",
    "path-join",
)


def _rank_substitution(entry: tuple[str, object]) -> tuple[int, str]:
    return (
        _COMMON_SUBSTITUTIONS.index(entry[0]) if entry[0] in _COMMON_SUBSTITUTIONS else len(_COMMON_SUBSTITUTIONS)
    ), entry[0]
