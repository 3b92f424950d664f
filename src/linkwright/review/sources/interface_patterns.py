"""Decide which interfaces of ros2_control a source really lost or newly claims, if their names are computed."""

from __future__ import annotations

import re
from collections.abc import Sequence

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.sources.hardware_interfaces import NAME_PART, NUMBER_PART, UNKNOWN_PART
from linkwright.review.sources.names import NameKind, SourceName, SourceNames

INTERFACE_KINDS = (NameKind.COMMAND_INTERFACE, NameKind.STATE_INTERFACE, NameKind.CLAIMED_INTERFACE)
_MARKS = {
    NAME_PART: rf"(?:{NAME_PART}|[^<>])*",  # a prefix may be empty
    NUMBER_PART: rf"(?:{NUMBER_PART}|\d+)",
    UNKNOWN_PART: r".+",
}
"""The pattern of each mark in the name of an interface."""
_MARK = re.compile("|".join(map(re.escape, _MARKS)))
_CONFIGURATION = re.compile(r"\b(?:command|state)_interface_configuration\b")


def select_interfaces(items: Sequence[SourceName], other_names: SourceNames) -> list[SourceName]:
    """Return the interfaces that only one version of a source has, without those that the other one may have.

    A computed name in the other version may give them. A computed name alone does not count if it has no text of its
    own, or if the other version names no interface of the kind, because then another source or ros2_control may do it.
    Two computed names may be the same if one of them may be the other.

    Args:
        items: the interfaces of a kind.
        other_names: the names of the other version.
    """
    if not items:
        return []
    known = list(other_names.of_kind(items[0].kind))
    return [
        item
        for item in items
        if not any(_may_be_equal(item.name, other.name) for other in known)
        and (_MARK.search(item.name) is None or (bool(known) and _has_text(item.name)))
    ]


def find_claim_reason(items: Sequence[SourceName], old_text: str, names: SourceNames) -> Phrase | None:
    """Return the reason why interfaces that a controller newly claims are breaking; None if none of them is.

    A new controller and an interface behind a condition break no robot.

    Args:
        items: the added interfaces.
        old_text: the text of the old source.
        names: the names of the new source.
    """
    if not items or items[0].kind is not NameKind.CLAIMED_INTERFACE or not _CONFIGURATION.search(old_text):
        return None
    required = [item.name for item in items if not _is_conditional(item, names)]
    if not required:
        return None
    text = joined_first(required, MAX_NAMES)
    return phrase("on robots whose hardware does not have '{name}', the controller does not start", name=text)


def _may_be_equal(name: str, other: str) -> bool:
    """Return whether two names, of which each may be computed, may be the same."""
    return any(re.fullmatch(_make_pattern(first), second) for first, second in ((name, other), (other, name)))


def _is_conditional(item: SourceName, names: SourceNames) -> bool:
    return any(branch.first <= item.span.line <= branch.last for branch in names.conditional_lines)


def _has_text(name: str) -> bool:
    """Return whether the last part of a name has a text or a number of its own."""
    last = name.rpartition("/")[2]
    return NUMBER_PART in last or re.search(r"\w", _MARK.sub("", last)) is not None


def _make_pattern(name: str) -> str:
    """Return a regular expression for the names that a computed name may be."""
    texts, marks = _MARK.split(name), _MARK.findall(name)
    return re.escape(texts[0]) + "".join(
        _MARKS[mark] + re.escape(text) for mark, text in zip(marks, texts[1:], strict=True)
    )
