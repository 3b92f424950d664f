"""Find messages whose frame comes from another message or variable."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.review.breaking import message_frame_reason
from linkwright.review.sources.code import Code, Part

_JOINER = re.compile(r"\s*(\.|->|::)\s*|\s+(?=[(\[\])])|(?<=[(\[])\s+")
_OBJECT = r"[A-Za-z_][\w.]*(?:->[\w.]+)*"
_ASSIGNMENT = re.compile(
    rf"(?<![\w.>])(?P<target>{_OBJECT}?)(?:\.|->)header(?:(?P<field>(?:\.|->)frame_id) = (?P<value>[^;=]+?)|"
    rf" = \*?(?P<header>{_OBJECT}))\s*;?\s*\Z"
)
_TEXT = re.compile(r"[\"'](?P<text>[^\"'\\]*)[\"']")
_MAX_VALUE_LENGTH = 80
_BRANCH = re.compile(r"\A[\s\d]+")
"""The mark of the branch of a statement in Python."""
_HEADER = re.compile(r"(?:(?:\.|->)|\b)header(?:\.|->)frame_id\Z")
_SEPARATOR = " | "


class FrameChange(NamedTuple):
    """The changed expressions for the frames of messages.

    Attributes:
        sentence: the messages and the expressions.
        line: the line of the first changed assignment in the new version.
        reason: why the change is breaking; None for other changes.
    """

    sentence: Phrase
    line: int
    reason: Phrase | None = None


class _Assigned(NamedTuple):
    expressions: tuple[str, ...]
    line: int


def find_frame_changes(old: Code, new: Code) -> Iterator[FrameChange]:
    """Yield the messages of each function that get another frame now.

    Two literal frames count only if both versions have both, because others are compared as names. Of two variables,
    one is the frame of a message that the function has in both versions, so that neither is only another name of the
    other.
    """
    literals = [_list_literals(code) for code in (old, new)]
    for name, parts in new.functions.items():
        if name not in old.functions:
            continue
        before, after = _read_assignments(old.functions[name]), _read_assignments(parts)
        texts = [" ".join(join_operators(part.text) for part in items) for items in (old.functions[name], parts)]
        groups: dict[tuple[tuple[str, ...], tuple[str, ...]], list[str]] = {}
        for target in before.keys() & after.keys():
            pair = before[target].expressions, after[target].expressions
            is_other = _is_left(pair[0], texts[1]) or _is_left(pair[1], texts[0]) or _is_computed(*pair)
            is_other = is_other or _is_known_literal(*pair, *literals)
            if pair[0] != pair[1] and is_other:
                groups.setdefault(pair, []).append(target)
        for (old_values, new_values), targets in sorted(groups.items()):
            sentence = phrase(
                "frame_id of {names}: {old} -> {new}",
                names=quoted_names(sorted(targets)),
                old=_SEPARATOR.join(old_values),
                new=_SEPARATOR.join(new_values),
            )
            text = _TEXT.fullmatch(old_values[0]) if len(old_values) == 1 else None
            is_transform = any(
                f"{target}{joiner}child_frame_id" in texts[1] for target in targets for joiner in (".", "->")
            )
            reason = None if text is None or is_transform else message_frame_reason(text["text"])
            yield FrameChange(sentence, min(after[target].line for target in targets), reason)


def _list_literals(code: Code) -> set[str]:
    """Return the literal frames that a source assigns to messages."""
    expressions = (
        expression
        for parts in code.functions.values()
        for assigned in _read_assignments(parts).values()
        for expression in assigned.expressions
    )
    return {match["text"] for expression in expressions if (match := _TEXT.fullmatch(expression)) is not None}


def _is_known_literal(old: Sequence[str], new: Sequence[str], before: set[str], after: set[str]) -> bool:
    """Return whether a literal frame replaces another one, and both versions have both.

    Args:
        old: the old expressions.
        new: the new expressions.
        before: the literal frames in the old source.
        after: the literal frames in the new source.
    """
    matches = [_TEXT.fullmatch(values[0]) if len(values) == 1 else None for values in (old, new)]
    if matches[0] is None or matches[1] is None:
        return False
    names = matches[0]["text"].strip("/"), matches[1]["text"].strip("/")
    return names[0] != names[1] and matches[0]["text"] in after and matches[1]["text"] in before


def join_operators(text: str) -> str:
    """Return a statement without spaces around member operators and in brackets, and without the mark of a branch."""
    return _JOINER.sub(r"\1", _BRANCH.sub("", text))


def _read_assignments(parts: Sequence[Part]) -> dict[str, _Assigned]:
    """Return the expressions that a function assigns to the frames of messages, by message."""
    found: dict[str, _Assigned] = {}
    for part in parts:
        match = _ASSIGNMENT.search(join_operators(part.text))
        value = "" if match is None else match["value"] or f"{match['header']}.frame_id"
        if match is not None and len(value) <= _MAX_VALUE_LENGTH:
            known = found.get(match["target"], _Assigned((), part.first_line))
            expressions = tuple(sorted({*known.expressions, value}))
            found[match["target"]] = known._replace(expressions=expressions)
    return found


def _is_left(expressions: Sequence[str], text: str) -> bool:
    """Return whether all expressions are frames of messages that a function still has in another version."""
    roots = [re.split(r"\.|->", _HEADER.sub("", item)) for item in expressions if _HEADER.search(item)]
    words = set(re.findall(r"\w+", text))
    return len(roots) == len(expressions) and all(words.issuperset(root) for root in roots)


def _is_computed(old: Sequence[str], new: Sequence[str]) -> bool:
    """Return whether one version calls or adds something, or replaces a literal frame by a header."""
    literals = [all(map(_TEXT.fullmatch, values)) for values in (old, new)]
    if any(literals):
        return not all(literals) and all(map(_HEADER.search, new if literals[0] else old))
    return any(re.search(r"[+(]", value) for value in (*old, *new))
