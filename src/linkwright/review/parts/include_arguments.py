"""Find the arguments that choose the included files of a description."""

from __future__ import annotations

import re
from collections.abc import Sequence

from linkwright.review.parts.elements import PartDifference
from linkwright.review.parts.name_substitution import iterate_properties
from linkwright.review.parts.outline import INCLUDE
from linkwright.review.parts.part_pair import PartPair
from linkwright.xmltree import Element

_ARGUMENT = re.compile(r"\$\(arg\s+([^\s()]+)\s*\)")
_EXPRESSION = re.compile(r"\$\{([^{}]*)\}")
_WORD = re.compile(r"[A-Za-z_]\w*")


def find_lost_choices(pair: PartPair, difference: PartDifference) -> Sequence[str]:
    """Return the arguments that no longer choose an included file, although the new version declares them.

    Args:
        pair: both versions of the file with the include.
        difference: the difference between the includes.
    """
    element = difference.new_element
    if difference.value != "filename" or element is None or element.tag != INCLUDE:
        return []
    old, new = (
        _find_arguments(text or "", outline.root)
        for text, outline in ((difference.old, pair.old), (difference.new, pair.new))
    )
    return [name for name in sorted(old - new) if name in pair.new.arguments]


def _find_arguments(text: str, root: Element) -> set[str]:
    """Return the arguments on which a text depends, directly or through properties of the file."""
    values = {name: element.attributes.get("value", "") for name, element in iterate_properties(root)}
    pending, visited = [text], {text}
    names: set[str] = set()
    while pending:
        current = pending.pop()
        names |= set(_ARGUMENT.findall(current))
        words = {word for expression in _EXPRESSION.findall(current) for word in _WORD.findall(expression)}
        following = {values[word] for word in words if word in values} - visited
        visited |= following
        pending += following
    return names
