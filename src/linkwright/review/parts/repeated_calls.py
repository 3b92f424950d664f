"""Find calls of macros that make a part which another call makes already."""

from __future__ import annotations

from linkwright.review.parts.name_substitution import CALL
from linkwright.review.parts.outline import STATEMENTS, Item, iterate_items
from linkwright.xmltree import Element

_NAMING = ("name", "prefix", "suffix", "namespace", "ns")
"""The parameters that distinguish the links and joints of a call from those of another one."""


def find_repeated_call(old: Element, new: Element, element: Element) -> str | None:
    """Return the name of an added call if the file had another one with it under the same conditions, else None.

    Args:
        old: the root of the old file.
        new: the root of the new file.
        element: the element that only the new file has.
    """
    name = element.attributes.get("name", "")
    if not element.tag.startswith(CALL) or element.tag in STATEMENTS or not name:
        return None
    own = next((item for item in iterate_items(new) if item.element is element), None)
    if own is None:
        return None
    counts = [sum(_are_alike(item, own) for item in iterate_items(root)) for root in (old, new)]
    return name if counts[0] and counts[1] > 1 else None


def _are_alike(item: Item, other: Item) -> bool:
    """Return whether two calls of a macro give equal names under equal conditions."""
    attributes = item.element.attributes, other.element.attributes
    has_same_names = all(attributes[0].get(key) == attributes[1].get(key) for key in _NAMING)
    return item.element.tag == other.element.tag and has_same_names and item.conditions == other.conditions
