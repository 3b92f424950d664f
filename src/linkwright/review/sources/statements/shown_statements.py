"""Show the statements in which functions differ: conditions, results, formulas and calls."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from difflib import SequenceMatcher
from typing import NamedTuple

from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.review.changes import Change
from linkwright.review.sources.names import SourceNames
from linkwright.review.sources.statements.code import Code, Part
from linkwright.review.sources.statements.code_changes import CodeChange, ReportedLines, format_function
from linkwright.review.sources.statements.function_statements import (
    FunctionStatement,
    StatementKind,
    computes_otherwise,
    list_words,
    parse_part,
    read_text,
)
from linkwright.review.texts.excerpts import differing_excerpts, shorten

_CONSTANT_RESULT = re.compile(
    r"return (?:None|[Tt]rue|[Ff]alse|nullptr|-?[\d.]+|'[^']*'|\"[^\"]*\"|(?:\w+(?:\.|::))*[A-Z][A-Z0-9_]+)"
)
_SENDING = re.compile(
    r"(?:\.|->)"
    r"(?:publish|sendTransform|send_transform|send_goal|send_goal_async|async_send_goal|call|call_async|"
    r"async_send_request|wait_for_service|wait_for_server|wait_for_action_server)\("
)
"""A call that sends something, or waits for the one who gets it."""
_FORMULA = re.compile(r"[\w)\]] ?[-+*/%<>] ?[\w(]|[<>=!]=|&&|\|\||\?|\b(?:and|or|not|if)\b|-?\b\d")
_CONSTANT = re.compile(r"(?<![\w'\"])(?:(?:\w+(?:\.|::))*[A-Z][A-Z0-9_]{2,}\b|-?\d)")
_OWNER = re.compile(r"(?:self\.|this->)")
_MEMBER = re.compile(r"(?:self\.|this->)\w|\w+_\Z|m_\w")
_FIELD = re.compile(r"[.\[]|->")
_CONST = re.compile(r"\bconst\b ?")
_MAX_STATEMENTS = 3
"""The maximum number of statements of a function that a line shows."""
_MAX_FUNCTIONS = 8
"""The maximum number of functions of a source whose statements are shown."""
_MIN_SCORE = 2
"""The minimum score of a shown statement among several."""
_MAX_CHARACTERS = 100
_MAX_HEAD_CHARACTERS = 40
_MAX_COMPARED_PAIRS = 4_000_000


class _Difference(NamedTuple):
    """A statement that differs, or that only one version has.

    Attributes:
        old: the old statement.
        new: the new statement.
        body: the first statement of a condition that only one version has.
        number: the number of equal differences in the function.
        left: the number of equal statements that the new version still has.
    """

    old: FunctionStatement | None
    new: FunctionStatement | None
    body: FunctionStatement | None = None
    number: int = 1
    left: int = 0

    @property
    def texts(self) -> tuple[str | None, ...]:
        """The codes of the statements."""
        return tuple(None if item is None else item.text for item in (self.old, self.new, self.body))

    @property
    def statement(self) -> FunctionStatement:
        """The new statement, or the old one that is gone."""
        statement = self.new or self.old
        assert statement is not None
        return statement


def find_shown_statements(old: Code, new: Code, lines: ReportedLines, names: SourceNames) -> Iterator[CodeChange]:
    """Yield the functions in which conditions, results, formulas or calls differ, with these statements.

    Statements that other lines report, that moved to another place of the source, or in which only variables have other
    names, are left out.

    Args:
        old: the code of the old version.
        new: the code of the new version.
        lines: the other lines about the source.
        names: the names in the new version.
    """
    sides = _Sides(old, new)
    found = []
    for name, parts in new.functions.items():
        before = old.functions.get(name)
        if before is None or not lines.has_unreported_change(before, parts, name):
            continue
        differences = _merge_equal(_compare(name, before, parts, lines, sides))
        shown = _select(differences)
        if shown:
            found.append((max(map(_score, shown)), name, shown, len(differences) - len(shown)))
    most = sorted(found, key=lambda item: -item[0])[:_MAX_FUNCTIONS]
    for item in found:
        if item in most:
            _, name, shown, hidden = item
            first = shown[0].statement
            yield CodeChange(
                phrase("in {function}: {changes}", function=format_function(name, names), changes=_join(shown, hidden)),
                first.part.first_line,
                shown[0].new is None,
            )


def describe_outside_statements(old: Code, new: Code, reported: Sequence[Change]) -> Phrase | None:
    """Return the statements outside of functions and classes that differ, or None. Of many, those that tell most.

    Args:
        old: the code of the old version.
        new: the code of the new version.
        reported: the other lines about the source.
    """
    parts = old.outside.get("", ()), new.outside.get("", ())
    sides = _Sides(old, new, has_outside=True)
    differences = _merge_equal(_compare("", *parts, ReportedLines(reported), sides))
    shown = differences if len(differences) <= _MAX_STATEMENTS else _select(differences)
    if not shown:
        return None
    return phrase("outside of functions: {changes}", changes=_join(shown, len(differences) - len(shown)))


class _Sides:
    """Two versions of a source whose functions are compared.

    Args:
        old: the code of the old version.
        new: the code of the new version.
        has_outside: whether the statements outside of functions are compared.
    """

    def __init__(self, old: Code, new: Code, *, has_outside: bool = False) -> None:
        parts = [[part for items in code.functions.values() for part in items] for code in (old, new)]
        if has_outside:
            parts = [[*own, *code.outside.get("", ())] for own, code in zip(parts, (old, new), strict=True)]
        counts = [Counter(read_text(part) for part in items) for items in parts]
        self._lost = counts[0] - counts[1], counts[1] - counts[0]
        outside = ([part for items in code.outside.values() for part in items] for code in (old, new))
        self._words = [
            {word for part in (*own, *others) for word in list_words(part.text)}
            for own, others in zip(parts, outside, strict=True)
        ]

    def _has_moved(self, part: Part, *, is_old: bool) -> bool:
        """Return whether a statement of one version is at another place in the other version."""
        return self._lost[0 if is_old else 1][read_text(part)] < 1

    def is_left_out(self, difference: _Difference, name: str, lines: ReportedLines) -> bool:
        """Return whether a line reports a difference in a function, or only places or names differ."""
        if difference.old is not None and difference.new is not None:
            parts = difference.old.part, difference.new.part
            is_named_otherwise = difference.new.kind is not StatementKind.HEAD and self._differ_in_names(
                difference.old, difference.new
            )
            return is_named_otherwise or lines.reports_pair(name, *parts)
        is_old = difference.new is None
        return lines.reports(difference.statement.part, is_old=is_old) or self._has_moved(
            difference.statement.part, is_old=is_old
        )

    def _differ_in_names(self, old: FunctionStatement, new: FunctionStatement) -> bool:
        """Return whether two statements only differ in names of variables that the other version does not have."""
        words = [list_words(_CONST.sub("", statement.text)) for statement in (old, new)]
        if len(words[0]) != len(words[1]):
            return False
        return all(
            before == after
            or (
                before.isidentifier()
                and after.isidentifier()
                and before not in self._words[1]
                and after not in self._words[0]
                and _is_variable(words[1], index)
            )
            for index, (before, after) in enumerate(zip(*words, strict=True))
        )


def _is_variable(words: Sequence[str], index: int) -> bool:
    """Return whether a word of a statement names a variable or a member of the own object, and no function."""
    before = "".join(words[max(index - 4, 0) : index])
    is_own = before.endswith(("self.", "this->")) or not before.endswith((".", "->", "::"))
    return is_own and words[index + 1 : index + 2] != ["("]


def _compare(
    name: str,
    old: Sequence[Part],
    new: Sequence[Part],
    lines: ReportedLines,
    sides: _Sides,
) -> Iterator[_Difference]:
    """Yield the statements in which two versions of a function differ.

    Args:
        name: the function; empty for the statements outside of functions.
        old: its old statements.
        new: its new statements.
        lines: the other lines about the source.
        sides: the versions of the source.
    """
    sorted_parts = [sorted(parts, key=lambda part: part.start) for parts in (old, new)]
    texts = [[read_text(part) for part in parts] for parts in sorted_parts]
    if len(old) * len(new) > _MAX_COMPARED_PAIRS:
        return
    for tag, old_start, old_end, new_start, new_end in SequenceMatcher(
        None, texts[0], texts[1], autojunk=False
    ).get_opcodes():
        if tag == "equal":
            continue
        before = [
            parse_part(part, is_head=bool(name) and part is old[0]) for part in sorted_parts[0][old_start:old_end]
        ]
        after = [parse_part(part, is_head=bool(name) and part is new[0]) for part in sorted_parts[1][new_start:new_end]]
        for difference in _with_bodies([*_pair(before, after)]):
            is_reported = difference.statement.kind is StatementKind.REPORTED
            if is_reported and difference.old is not None and difference.new is not None:
                is_reported = not computes_otherwise(difference.old, difference.new)
            if is_reported or sides.is_left_out(difference, name, lines):
                continue
            is_removed = difference.new is None and difference.body is None
            left = texts[1].count(read_text(difference.statement.part)) if is_removed else 0
            yield difference._replace(left=left)


def _merge_equal(differences: Iterable[_Difference]) -> list[_Difference]:
    """Return differences, equal ones as one with their number."""
    items = list(differences)
    counts = Counter(item.texts for item in items)
    return [item._replace(number=counts[texts]) for texts, item in {item.texts: item for item in items}.items()]


def _pair(old: Sequence[FunctionStatement], new: Sequence[FunctionStatement]) -> Iterator[_Difference]:
    """Yield differing statements in the order of the source: as pairs if one took the place of the other."""
    if len(old) == len(new) == 1 and old[0].kind == new[0].kind:
        yield _Difference(old[0], new[0])
        return
    start = 0
    for statement in old:
        index = next((index for index in range(start, len(new)) if new[index].replaces(statement)), None)
        if index is None:
            yield _Difference(statement, None)
            continue
        yield from (_Difference(None, item) for item in new[start:index])
        if statement.text != new[index].text:
            yield _Difference(statement, new[index])
        start = index + 1
    yield from (_Difference(None, item) for item in new[start:])


def _with_bodies(differences: Sequence[_Difference]) -> Iterator[_Difference]:
    """Yield differences. A condition that only one version has contains the result after it."""
    index = 0
    while index < len(differences):
        difference = differences[index]
        index += 1
        following = differences[index] if index < len(differences) else difference
        is_condition = difference.statement.kind is StatementKind.CONDITION and None in (difference.old, difference.new)
        is_same_side = (difference.old is None, difference.new is None) == (
            following.old is None,
            following.new is None,
        )
        if is_condition and is_same_side and following.statement.kind is StatementKind.RESULT:
            difference = difference._replace(body=following.statement)
            index += 1
        yield difference


def _read_arguments(head: str) -> str:
    """Return the arguments of a function with parentheses."""
    start = head.find("(", head.find(")") + 1 if "operator()" in head.replace(" ", "") else 0)
    depth = 0
    for index in range(max(start, 0), len(head)):
        depth += (head[index] in "([{") - (head[index] in ")]}")
        if depth == 0:
            return head[start : index + 1]
    return head


def _select(differences: Sequence[_Difference]) -> list[_Difference]:
    """Return the differences that a line shows: all if there are few, else those that tell most."""
    scores = [_score(difference) for difference in differences]
    if len(differences) <= _MAX_STATEMENTS and all(scores):
        return list(differences)
    best = sorted(range(len(scores)), key=lambda index: -scores[index])[:_MAX_STATEMENTS]
    return [differences[index] for index in sorted(best) if scores[index] >= _MIN_SCORE]


def _score(difference: _Difference) -> int:
    """Return how much a difference tells about what the function does; 0 for nothing."""
    statement = difference.statement
    is_pair = difference.old is not None and difference.new is not None
    values = [item.value for item in (difference.old, difference.new) if item is not None]
    has_constant = any(_CONSTANT.search(value) for value in values)
    if statement.kind is StatementKind.HEAD:
        return 4 if is_pair else 0
    if statement.kind is StatementKind.CONDITION:
        return 4 if is_pair or has_constant else 3
    if statement.kind is StatementKind.RESULT:
        return 4 if is_pair else 3 if _CONSTANT_RESULT.fullmatch(statement.text) else 2 if " " in statement.text else 1
    if statement.kind is StatementKind.ASSIGNMENT:
        return _score_assignment(statement.key, values, is_pair=is_pair, has_constant=has_constant)
    if statement.kind is StatementKind.CALL:
        return 3 if _SENDING.search(statement.text) else 2 if has_constant else 1
    if statement.kind is StatementKind.LOOP:
        return 2 if is_pair else 1
    return 2 if is_pair and has_constant else 1 if is_pair else 0


def _score_assignment(target: str, values: Sequence[str], *, is_pair: bool, has_constant: bool) -> int:
    is_field = _FIELD.search(_OWNER.sub("", target)) is not None
    is_member = _MEMBER.match(target) is not None
    if is_pair:
        return 4 if is_field or any(_FORMULA.search(value) for value in values) else 2
    if is_field:
        return 3
    return 2 if has_constant else 1 if is_member else 0


def _join(shown: Sequence[_Difference], hidden: int) -> Phrase:
    texts = [_describe_repeated(difference) for difference in shown]
    if hidden:
        texts.append(phrase("and {count} more", count=hidden))
    return joined(texts, "; ")


def _describe_repeated(difference: _Difference) -> Phrase:
    """Return the text of a difference, with its number if there are several equal ones."""
    text, count = _describe(difference), difference.number
    return text if count == 1 else phrase("{part} ({count} times)", part=text, count=count)


def _describe(difference: _Difference) -> Phrase:
    """Return the text of a difference."""
    old, new = difference.old, difference.new
    if old is not None and new is not None:
        texts = old.text, new.text
        if new.kind is StatementKind.HEAD:
            arguments = [_read_arguments(text) for text in texts]
            has_decorator = any(text.startswith("@") for text in texts)
            if arguments[0] != arguments[1] and not has_decorator:
                excerpts = differing_excerpts(arguments[0], arguments[1], _MAX_HEAD_CHARACTERS)
                return phrase("arguments {old} -> {new}", old=excerpts[0], new=excerpts[1])
        excerpts = differing_excerpts(*texts, _MAX_CHARACTERS)
        return phrase("`{old}` -> `{new}`", old=excerpts[0], new=excerpts[1])
    text = difference.statement.text
    if difference.body is not None:
        text = f"{text}: {difference.body.text}"
    items = f"`{shorten(text, _MAX_CHARACTERS)}`"
    if new is None and difference.left and difference.number == 1:
        return phrase("one of {count} {items} removed", count=difference.left + 1, items=items)
    return phrase("{items} removed", items=items) if new is None else phrase("{items} added", items=items)
