"""Find single values of YAML files that have another name and the same value."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from linkwright.diagnostics import phrase
from linkwright.review.changes import Change
from linkwright.review.files.renamed_parts import get_parent
from linkwright.review.files.value_changes import ValueChange

_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
_MIN_ABBREVIATION = 3
"""The minimum number of characters of an abbreviated word, such as ``ang``."""


def join_renamed_values(changes: Iterable[ValueChange]) -> tuple[list[ValueChange], list[Change]]:
    """Return the changes without added and removed values that are renamed, and the line about these.

    A renamed value has the same parent and the same text, and the words of one of its names contain those of the other
    one. A breaking change keeps a line of its own.
    """
    remaining = list(changes)
    removed, added = (
        [change for change in remaining if change.kind == kind and change.reason is None and len(change.values) == 1]
        for kind in ("removed", "added")
    )
    pairs = [(old, new) for old in removed for new in added if _is_renamed(old, new)]
    pairs = [
        (old, new)
        for old, new in pairs
        if sum(old is other for other, _ in pairs) == sum(new is other for _, other in pairs) == 1
    ]
    told = {id(change) for pair in pairs for change in pair}
    return [change for change in remaining if id(change) not in told], _describe(pairs)


def _describe(pairs: Sequence[tuple[ValueChange, ValueChange]]) -> list[Change]:
    if not pairs:
        return []
    old, new = pairs[0]
    text = phrase("{old} renamed to {name}, with the same value", old=old.name, name=new.name)
    others = tuple(f"{before.name} -> {after.name}" for before, after in pairs[1:])
    return [Change(text, location=new.location, other_names=others)]


def _is_renamed(old: ValueChange, new: ValueChange) -> bool:
    if old.values != new.values or get_parent(old.name) != get_parent(new.name):
        return False
    parent = get_parent(old.name)
    old_words, new_words = (_list_words(change.name.removeprefix(parent)) for change in (old, new))
    shorter, longer = sorted((old_words, new_words), key=len)
    return bool(shorter) and all(any(_is_same_word(word, other) for other in longer) for word in shorter)


def _list_words(name: str) -> set[str]:
    return {word.lower() for word in _WORD.findall(name)}


def _is_same_word(first: str, second: str) -> bool:
    """Return whether two words are equal, or one abbreviates the other one."""
    shorter, longer = sorted((first, second), key=len)
    return first == second or (len(shorter) >= _MIN_ABBREVIATION and longer.startswith(shorter))
