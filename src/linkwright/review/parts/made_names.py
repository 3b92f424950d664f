"""Find the links and joints that a removed call of a macro made, and that the new version makes in another way."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from linkwright.review.parts.default_values import collect_new_values
from linkwright.review.parts.known_values import collect_values, evaluate_text
from linkwright.review.parts.name_substitution import CALL
from linkwright.review.parts.outline import STATEMENTS, uses_name
from linkwright.review.parts.part_pair import PartPair
from linkwright.xmltree import Element

_PARTS = ("link", "joint")


def makes_same_names(pair: PartPair, macro: str | None, call: Element) -> bool:
    """Return whether the new version of a file makes all links and joints that get their names from a removed call.

    Args:
        pair: both versions of the file.
        macro: the macro with the call; None outside of macros.
        call: the call of a macro of the old repository.
    """
    made: set[tuple[str, str]] = set()
    for called in pair.find_called_macros(call):
        values = collect_values(pair.defaults, (pair.old, *pair.robots), called) | dict(call.attributes)
        if any(element.tag.startswith(CALL) and element.tag not in STATEMENTS for element in called.element.walk()):
            return False
        made |= {name for name in _find_names(called.element, values, of_call=True) if "$" not in name[1]}
    if not made:
        return False
    outline = pair.new.macros.get(macro or "")
    root = pair.new.root if outline is None else outline.element
    return made <= set(_find_names(root, collect_new_values(pair, macro), of_call=False))


def _find_names(root: Element, values: Mapping[str, str], *, of_call: bool) -> Iterator[tuple[str, str]]:
    """Yield the tags and names of the links and joints in an element, all or those that use the name of a call."""
    for element in root.walk():
        if element.tag in _PARTS and (uses_name(element, "name") or not of_call):
            yield element.tag, evaluate_text(element.attributes.get("name", ""), values)
