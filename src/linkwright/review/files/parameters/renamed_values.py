"""Find single values of YAML files that have another name and the same value."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Sequence

from linkwright.diagnostics import phrase
from linkwright.review.changes import Change
from linkwright.review.files.parameters.renamed_parts import get_parent
from linkwright.review.files.parameters.value_changes import ValueChange
from linkwright.review.texts.name_words import split_name

_MAX_EQUAL = 30
"""The maximum number of equal removed or added values below a parent. More are ambiguous, and not paired."""
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
    pairs = list(_find_pairs(removed, added))
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


def _find_pairs(
    removed: Iterable[ValueChange], added: Iterable[ValueChange]
) -> Iterator[tuple[ValueChange, ValueChange]]:
    """Yield the removed and added values that are equal, and whose names may be those of one value."""
    groups: dict[Hashable, tuple[list[ValueChange], list[ValueChange]]] = {}
    for side, changes in enumerate((removed, added)):
        for change in changes:
            groups.setdefault((get_parent(change.name), change.values), ([], []))[side].append(change)
    for olds, news in groups.values():
        if max(len(olds), len(news)) <= _MAX_EQUAL:
            yield from ((old, new) for old in olds for new in news if _have_similar_names(old, new))


def _have_similar_names(old: ValueChange, new: ValueChange) -> bool:
    """Return whether the words of the name of one value contain those of the other one, which has the same parent."""
    parent = get_parent(old.name)
    words = (set(split_name(change.name.removeprefix(parent))) for change in (old, new))
    shorter, longer = sorted(words, key=len)
    return bool(shorter) and all(any(_is_same_word(word, other) for other in longer) for word in shorter)


def _is_same_word(first: str, second: str) -> bool:
    """Return whether two words are equal, or one abbreviates the other one."""
    shorter, longer = sorted((first, second), key=len)
    return first == second or (len(shorter) >= _MIN_ABBREVIATION and longer.startswith(shorter))
