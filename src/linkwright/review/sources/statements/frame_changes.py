"""Find messages whose frame comes from another message or variable."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.review.breaking import message_frame_reason
from linkwright.review.changes import Change
from linkwright.review.sources.names import NameKind
from linkwright.review.sources.statements.code import Code, Part

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
_GIVEN = re.compile(rf"\bheader(?:\.|->)frame_id(?: = |\.assign\()({_OBJECT})(?=\)|\s*;?\s*\Z)")
"""A variable that gives the frame of a message."""
_MEMBER = re.compile(r"(?:self\.|this->|m_)\w+|[A-Za-z]\w*_")
_HEADER = re.compile(r"(?:(?:\.|->)|\b)header(?:\.|->)frame_id\Z")
_SEPARATOR = " | "
_TEMPLATE = "frame_id of {names}: {old} -> {new}"
"""The template of the line about another frame."""
_SENDING = r"\b(?:publish\w*|send(?!_?goal|Goal|_?request|Request)\w*)\("
_QUOTED = re.compile(r"'([^']+)'")


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


def find_frame_changes(old: Code, new: Code, reported: Sequence[str] = ()) -> Iterator[FrameChange]:
    """Yield the messages of each function that get another frame now.

    Two literal frames count unless another line tells that one is renamed to the other. Of two variables,
    one is the frame of a message that the function has in both versions, so that neither is only another name of the
    other.

    Args:
        old: the old source.
        new: the new source.
        reported: the other lines about the source.
    """
    for name, parts in new.functions.items():
        if name not in old.functions:
            continue
        before, after = _read_assignments(old.functions[name]), _read_assignments(parts)
        texts = [" ".join(join_operators(part.text) for part in items) for items in (old.functions[name], parts)]
        groups: dict[tuple[tuple[str, ...], tuple[str, ...]], list[str]] = {}
        for target in before.keys() & after.keys():
            pair = before[target].expressions, after[target].expressions
            is_other = _is_left(pair[0], texts[1]) or _is_left(pair[1], texts[0]) or _is_computed(*pair)
            is_other = is_other or _is_other_literal(*pair, reported) or _is_other_member(*pair, old, new)
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
            is_transform = any(_is_transform(target, texts[1]) for target in targets)
            is_header = all(map(_HEADER.search, new_values))
            is_harmless = is_transform or (not is_header and not _are_sent(targets, new))
            reason = None if text is None or is_harmless else message_frame_reason(text["text"])
            yield FrameChange(sentence, min(after[target].line for target in targets), reason)


def _is_transform(target: str, text: str) -> bool:
    """Return whether a message with a child frame is a transform. That of odometry has a pose and a twist."""
    fields = {
        field
        for field in ("child_frame_id", "pose", "twist")
        for joiner in (".", "->")
        if f"{target}{joiner}{field}" in text
    }
    return fields == {"child_frame_id"}


def _are_sent(targets: Sequence[str], code: Code) -> bool:
    """Return whether a source publishes one of some messages."""
    words = "|".join(re.escape(re.split(r"\.|->", target)[-1]) for target in targets)
    sent = re.compile(rf"{_SENDING}[^;]*\b(?:{words})\b")
    return any(sent.search(join_operators(part.text)) for parts in code.functions.values() for part in parts)


def _is_other_literal(old: Sequence[str], new: Sequence[str], reported: Sequence[str]) -> bool:
    """Return whether a literal frame replaces another one, and no other line names both.

    Args:
        old: the old expressions.
        new: the new expressions.
        reported: the other lines about the source.
    """
    matches = [_TEXT.fullmatch(values[0]) if len(values) == 1 else None for values in (old, new)]
    if matches[0] is None or matches[1] is None:
        return False
    names = [match["text"].strip("/") for match in matches if match is not None]
    return names[0] != names[1] and not any(all(f"'{name}'" in line for name in names) for line in reported)


def _is_other_member(old: Sequence[str], new: Sequence[str], old_code: Code, new_code: Code) -> bool:
    """Return whether a literal frame becomes that of a member which gave other frames before.

    Another member may have the literal by default.
    """
    text = _TEXT.fullmatch(old[0]) if len(old) == 1 else None
    if text is None or not all(map(_MEMBER.fullmatch, new)):
        return False
    given = {name for parts in old_code.functions.values() for part in parts for name in _find_given(part)}
    literal = re.compile(rf"[\"']{re.escape(text['text'])}[\"']")
    parts = (part for items in (*new_code.functions.values(), *new_code.outside.values()) for part in items)
    return given.issuperset(new) and not any(literal.search(part.text) for part in parts)


def _find_given(part: Part) -> list[str]:
    """Return the variables that give frames of messages in a statement."""
    return _GIVEN.findall(join_operators(part.text))


def drop_told_frames(changes: Sequence[Change]) -> list[Change]:
    """Return the lines about a source without those about frames that the lines about their messages tell."""
    told: set[str] = set()
    for change in changes:
        if change.core.template == _TEMPLATE:
            texts = (_TEXT.fullmatch(str(change.core.arguments[side])) for side in ("old", "new"))
            told |= {match["text"] for match in texts if match is not None}

    def is_told(change: Change) -> bool:
        names = set(_QUOTED.findall(str(change.core)))
        return change.core.arguments.get("kind") == NameKind.MESSAGE_FRAME.plural and bool(names) and names <= told

    return [change for change in changes if not is_told(change)]


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
