"""Find the ``if`` statements around the names in a source, and compare those of both versions."""

from __future__ import annotations

import ast
import re
from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import NamedTuple

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.review.sources.cpp.preprocessor import blank_repeated_braces
from linkwright.review.sources.names import ConditionalLines, NameKind, SourceNames

_KINDS = (NameKind.PUBLISHER, NameKind.SUBSCRIPTION, NameKind.SERVICE, NameKind.ACTION, NameKind.PARAMETER)
_IF = re.compile(r"\bif\s*(?:constexpr\s*)?\(")
_ELSE = re.compile(r"\s*else\b\s*")
_TEXT = re.compile(r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'')
_BRACKET = re.compile(r"[()\[\]{}]")
_END = re.compile(r"[;(\[{}]")
_SPACES = re.compile(r"\s*")
_MAX_STATEMENTS = 2000
"""The maximum number of ``if`` statements of a source."""
_MAX_DEPTH = 30
_MAX_TOKENS = 100
"""The maximum number of brackets in a statement without a block."""
_MAX_SOURCE_CHARACTERS = 400
_MAX_CHARACTERS = 160
"""The maximum number of characters of a shown condition."""


class ConditionChange(NamedTuple):
    """A name that depends on a condition in only one version.

    Attributes:
        text: the change in one line.
        line: the line of the ``if`` statement.
        is_old: whether the line is in the old version.
        kind: the kind of the names.
        names: the names.
        conditions: the conditions that only this version has.
    """

    text: Phrase
    line: int
    is_old: bool
    kind: NameKind
    names: Sequence[str]
    conditions: Sequence[str]


def find_python_conditions(tree: ast.Module) -> Iterator[ConditionalLines]:
    """Yield the lines in the branches of ``if`` statements, without the check whether the file is run."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.If) or "__name__" in ast.unparse(node.test):
            continue
        text = ast.unparse(node.test)
        for branch, condition in ((node.body, text), (node.orelse, f"not ({text})")):
            if branch:
                last = branch[-1].end_lineno or branch[-1].lineno
                yield ConditionalLines(branch[0].lineno, last, condition, node.lineno)


def find_cpp_conditions(text: str) -> Iterator[ConditionalLines]:
    """Yield the lines in the branches of ``if`` statements.

    Args:
        text: the text of the source without comments.
    """
    code = _TEXT.sub(lambda match: '"' + " " * (len(match[0]) - 2) + '"', text)
    code = blank_repeated_braces(code)
    brackets = _match_brackets(code)
    breaks = [match.start() for match in re.finditer("\n", code)]
    for match in islice(_IF.finditer(code), _MAX_STATEMENTS):
        end = brackets.get(match.end() - 1, len(code))
        condition = " ".join(text[match.end() : min(end, match.end() + _MAX_SOURCE_CHARACTERS)].split())
        line = bisect_left(breaks, match.start()) + 1
        last = _find_statement_end(code, brackets, end + 1)
        branches = [(end + 1, last, condition)]
        other = _ELSE.match(code, last + 1)
        if other is not None:
            branches.append((other.end(), _find_statement_end(code, brackets, other.end()), f"!({condition})"))
        for start, stop, text_of_branch in branches:
            first = start + len(code[start:stop]) - len(code[start:stop].lstrip())
            yield ConditionalLines(bisect_left(breaks, first) + 1, bisect_left(breaks, stop) + 1, text_of_branch, line)


def _match_brackets(code: str) -> dict[int, int]:
    """Return the offset of the closing bracket of each opening one."""
    pairs: dict[int, int] = {}
    opened: list[int] = []
    for match in _BRACKET.finditer(code):
        if match[0] in "([{":
            opened.append(match.start())
        elif opened:
            pairs[opened.pop()] = match.start()
    return pairs


def _find_statement_end(code: str, brackets: Mapping[int, int], start: int, depth: int = 0) -> int:
    """Return the offset of the last character of the statement or block that begins at an offset."""
    spaces = _SPACES.match(code, start)
    start = start if spaces is None else spaces.end()
    nested = _IF.match(code, start)
    if nested is not None and depth < _MAX_DEPTH:
        end = brackets.get(nested.end() - 1, len(code))
        end = _find_statement_end(code, brackets, end + 1, depth + 1)
        other = _ELSE.match(code, end + 1)
        return end if other is None else _find_statement_end(code, brackets, other.end(), depth + 1)
    if code.startswith("{", start):
        return brackets.get(start, len(code))
    for _ in range(_MAX_TOKENS):
        match = _END.search(code, start)
        if match is None or match[0] not in "([{":
            return len(code) if match is None else match.start()
        start = brackets.get(match.start(), len(code)) + 1
    return start


def compare_conditions(old: SourceNames, new: SourceNames) -> Iterator[ConditionChange]:
    """Yield the topics, services, actions and parameters that depend on a condition in only one version.

    Names that a version makes in several places are left out. So are parameters with a condition that has their names,
    such as whether they are set.
    """
    found: dict[tuple[bool, tuple[str, ...], int, NameKind, bool], list[str]] = {}
    for kind, name, is_read, lines_of_sides in _list_places(old, new):
        sides = [
            [lines for lines in names.conditional_lines if lines.first <= line <= lines.last]
            for names, line in zip((old, new), lines_of_sides, strict=True)
        ]
        for is_old in (False, True):
            own, others = sides if is_old else reversed(sides)
            texts = {lines.condition for lines in others}
            if texts < {lines.condition for lines in own}:
                lines = [lines for lines in own if lines.condition not in texts]
                conditions = tuple(dict.fromkeys(item.condition for item in lines))
                if kind is not NameKind.PARAMETER or name.lstrip("~") not in " ".join(conditions):
                    found.setdefault((is_old, conditions, lines[0].line, kind, is_read), []).append(name)
    for (is_old, conditions, line, kind, is_read), names in found.items():
        text = _format(kind, names, " and ".join(conditions), is_old=is_old, is_read=is_read)
        yield ConditionChange(text, line, is_old, kind, names, conditions)


def _list_places(old: SourceNames, new: SourceNames) -> Iterator[tuple[NameKind, str, bool, tuple[int, int]]]:
    """Yield the names that both versions have in one place: kind, name, whether it is only read, and both lines."""
    before = {(item.kind, item.name): item for item in old.names}
    for item in new.names:
        key = item.kind, item.name
        if item.kind in _KINDS and key in before and old.counts[key] == new.counts[key] == 1:
            yield item.kind, item.name, False, (before[key].span.line, item.span.line)
    for name, lines in new.parameter_reads.items():
        old_lines = old.parameter_reads.get(name, [])
        if len(lines) == len(old_lines) == 1:
            yield NameKind.PARAMETER, name, True, (old_lines[0], lines[0])


def _format(kind: NameKind, names: Sequence[str], condition: str, *, is_old: bool, is_read: bool) -> Phrase:
    title = kind.title if len(names) == 1 else kind.plural
    shown = condition if len(condition) <= _MAX_CHARACTERS else f"{condition[:_MAX_CHARACTERS]}..."
    if is_read and is_old:
        text = phrase("{kind} {names}: no longer read only if {condition}", kind=title, names="", condition=shown)
    elif is_read:
        text = phrase("{kind} {names}: read now only if {condition}", kind=title, names="", condition=shown)
    elif is_old:
        text = phrase("{kind} {names}: no longer only if {condition}", kind=title, names="", condition=shown)
    else:
        text = phrase("{kind} {names}: now only if {condition}", kind=title, names="", condition=shown)
    return text.with_arguments(names=quoted_names(names))
