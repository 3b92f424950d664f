"""Match renamed elements by their contents."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from linkwright.descriptions.comparison.numbers import normalize_numbers
from linkwright.xmltree import Element

_RENAMABLE_TAGS = frozenset(
    {
        *("world", "model", "link", "joint", "frame", "include", "transmission"),
        *("visual", "collision", "light", "sensor", "plugin"),
    }
)
"""The tags of elements that are recognized under another name."""
_MIN_SIMILARITY = 0.5
"""The minimum similarity, from 0 to 1, of a removed and an added element that count as renamed."""
_MAX_PAIRS = 2500
"""The maximum number of possible pairs. Descriptions with more pairs differ in their contents rather than in names."""


def renamed_elements(
    old: Sequence[Element], new: Sequence[Element], old_lone: Sequence[Element], new_lone: Sequence[Element]
) -> Iterator[tuple[Element, Element]]:
    """Yield the pairs of elements with different names, but the same tag and similar contents.

    A world, or a model outside of worlds, also matches if it is the only one in both descriptions.

    Args:
        old: the elements of the old description.
        new: the elements of the new description.
        old_lone: the old elements whose names do not occur in the new description.
        new_lone: the new elements whose names do not occur in the old description.
    """
    if len(old_lone) * len(new_lone) > _MAX_PAIRS:
        return
    for tag in dict.fromkeys(element.tag for element in new_lone):
        if tag not in _RENAMABLE_TAGS:
            continue
        pairs = [(first, second) for first in old_lone for second in new_lone if first.tag == second.tag == tag]
        if tag in ("world", "model") and len(old) == len(new) == 1:
            yield from pairs
            continue
        scores = [(_compute_similarity(first, second), first, second) for first, second in pairs]
        paired_indices: set[int] = set()
        for score, first, second in sorted(scores, key=lambda item: -item[0]):
            if score >= _MIN_SIMILARITY and not {id(first), id(second)} & paired_indices:
                paired_indices |= {id(first), id(second)}
                yield first, second


def _compute_similarity(old: Element, new: Element) -> float:
    """Return the fraction of the contents that is equal, from 0 to 1."""
    if old.tag == "plugin" and old.attributes.get("filename") != new.attributes.get("filename"):
        return 0.0
    if old.tag == "include" and _find_uri(old) != _find_uri(new):
        return 0.0
    first, second = Counter(_list_contents(old, "")), Counter(_list_contents(new, ""))
    total = first.total() + second.total()
    return 2 * (first & second).total() / total if total else 0.0


def _find_uri(include: Element) -> str:
    uri = include.first("uri")
    return "" if uri is None else uri.text().strip()


def _list_contents(element: Element, path: str) -> Iterator[str]:
    """Yield the texts and attributes below an element, each with its position."""
    for child in element.elements():
        place = f"{path}/{child.tag}"
        yield f"{place}={normalize_numbers(child.text())}"
        for name, value in child.attributes.items():
            yield f"{place}@{name}={normalize_numbers(value)}"
        yield from _list_contents(child, place)
    if not path:
        for name, value in element.attributes.items():
            if name != "name":
                yield f"@{name}={value}"
