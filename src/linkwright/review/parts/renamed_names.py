"""Find renamed arguments of descriptions and parameters of macros by their uses."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from difflib import SequenceMatcher
from typing import NamedTuple

from linkwright.xmltree import Element

_MIN_SHARED_FRACTION = 0.5
"""The minimum share of equal uses of a renamed value."""
_MIN_SIMILARITY = 0.6
"""The minimum similarity of two names whose values are only passed on by the same name."""
_EXPRESSION = re.compile(r"\$\{[^}]*\}|\$\(arg [^)]*\)")
_MARK = "*"


class _Use(NamedTuple):
    """A text or attribute that uses a name.

    Attributes:
        tag: the tag of the element.
        key: the name of the attribute, or the mark if the attribute passes the value on by the same name.
        text: the text, with the mark in place of the name.
        other_attributes: the other attributes of the element, unless the value is passed on.
    """

    tag: str
    key: str
    text: str
    other_attributes: frozenset[tuple[str, str]] = frozenset()


def find_renamed_names(
    removed: Mapping[str, str | None], added: Mapping[str, str | None], old: Element, new: Element
) -> Iterator[tuple[str, str]]:
    """Yield the old and new names of values with equal defaults and equal uses.

    Args:
        removed: the defaults of the removed names; None for those without a default.
        added: the defaults of the added names.
        old: the element that uses the removed names.
        new: the element that uses the added names.
    """
    new_uses = {name: set(_find_uses(new, name)) for name in added}
    for name, default in removed.items():
        uses = set(_find_uses(old, name))
        shares = {
            other: _compute_shared_fraction(uses, new_uses[other])
            for other in new_uses
            if added[other] == default and _may_be_renamed(name, other, uses & new_uses[other])
        }
        best = max(shares, key=lambda other: shares[other], default=None)
        if best is not None and shares[best] >= _MIN_SHARED_FRACTION:
            del new_uses[best]
            yield name, best


def _may_be_renamed(old: str, new: str, shared: set[_Use]) -> bool:
    """Return whether equal uses mean the same value: all values that a call passes on by their names look alike."""
    is_only_passed_on = all(use.key == _MARK for use in shared)
    return not is_only_passed_on or SequenceMatcher(None, old, new, autojunk=False).ratio() >= _MIN_SIMILARITY


def _compute_shared_fraction(old: set[_Use], new: set[_Use]) -> float:
    return len(old & new) / len(old | new) if old and new else 0.0


def _find_uses(root: Element, name: str) -> Iterator[_Use]:
    """Yield the texts and attributes that use a name, with a mark in place of the name.

    The other attributes of the element are included, unless an attribute passes the value on by the same name.
    """
    word = re.compile(rf"(?<![\w.]){re.escape(name)}(?!\w)")
    for element in root.walk():
        for key, text in (*element.attributes.items(), ("", element.text())):
            marked = _EXPRESSION.sub(lambda match: word.sub(_MARK, match[0]), text)
            if marked == text:
                continue
            if key == name and _EXPRESSION.fullmatch(marked):
                yield _Use(element.tag, _MARK, marked)
                continue
            other_attributes = frozenset(item for item in element.attributes.items() if item[0] != key)
            yield _Use(element.tag, key, marked, other_attributes)
