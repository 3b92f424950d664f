"""Substitutions written inside text, ``$(var NAME)``, as parameter files may have them."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.diagnostics import LinkwrightError, SourceText
from linkwright.launch.errors.places import MarkupPlace, located
from linkwright.launch.frontend.grammar import parse_substitution
from linkwright.launch.frontend.parser import Parser
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.markup.entity import PlacedText
from linkwright.launch.model.substitution import perform_substitutions

_OPENING = re.compile(r"(?<!\\)\$\(")
_COMMENT = re.compile(r"(?:^|(?<=\s))#[^\n]*", re.MULTILINE)
_QUOTED = re.compile(r"\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\n]|'')*'")


def substitute_text(source: SourceText, context: LaunchContext) -> str:
    """The text of a YAML file with its substitutions made; comments are left alone.

    Raises:
        LinkwrightError: LAUNCH119 and others, for one that is unknown, or that has no value; with its place.
    """
    Parser.load_launch_extensions()
    text = source.text
    comments = list(_comments(text))
    parts: list[str] = []
    done = 0
    for opening in _OPENING.finditer(text):
        start = opening.start()
        if start < done or any(begin <= start < end for begin, end in comments):
            continue
        end = _end_of(text, start)
        place = MarkupPlace(source, start, end)
        try:
            value = perform_substitutions(context, parse_substitution(PlacedText(text[start:end], place)))
        except LinkwrightError as error:
            raise located(error, place) from error
        parts += [text[done:start], value]
        done = end
    return "".join([*parts, text[done:]])


def _end_of(text: str, start: int) -> int:
    """Where the substitution that starts at an offset ends; the end of its line if it is never closed."""
    depth = 0
    for offset in range(start, len(text)):
        if text[offset] == "(":
            depth += 1
        elif text[offset] == ")":
            depth -= 1
            if depth == 0:
                return offset + 1
    line_end = text.find("\n", start)
    return line_end if line_end >= 0 else len(text)


def _comments(text: str) -> Iterator[tuple[int, int]]:
    quoted = [match.span() for match in _QUOTED.finditer(text)]
    for comment in _COMMENT.finditer(text):
        if not any(begin < comment.start() < end for begin, end in quoted):
            yield comment.span()
