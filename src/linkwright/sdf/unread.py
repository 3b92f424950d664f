"""Messages about elements in places where SDF does not define them."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache

from linkwright.schema import ElementRule
from linkwright.sdf.worlds import SDF
from linkwright.xmltree import Element

_TRUE, _FALSE = ("true", "1"), ("false", "")
_NO_SCALE = 1.0
_MOST_HOMES = 3
_HARMLESS = frozenset({("collision", "material")})
"""Parents and child elements that no reader needs: the colour of an element that is never drawn."""


def allowed_parents(tag: str) -> tuple[str, ...]:
    """Return the tags of the parents in which SDF allows an element.

    The result is empty if the element is unknown or has many parents.
    """
    found = _parents_by_tag().get(tag, ())
    return tuple(sorted(found)) if len(found) <= _MOST_HOMES else ()


def links_of_static_models(elements: Iterable[Element]) -> frozenset[int]:
    """Return the ``id()`` of each link element in static models."""
    return frozenset(
        id(link)
        for model in elements
        if model.tag == "model" and any(element.text().strip() in _TRUE for element in model.elements("static"))
        for link in model.elements("link")
    )


def changes_nothing(child: Element, parent: Element, static_links: frozenset[int]) -> bool:
    """Return whether reading an element would make no difference.

    This is the case if the element is empty, repeats the default, or is unknown and has the value zero or false.
    """
    if (parent.tag, child.tag) in _HARMLESS or (child.tag == "static" and id(parent) in static_links):
        return True
    if next(child.elements(), None) is not None:
        return False
    text = child.text().strip()
    if not text:
        return True
    values = _numbers(text)
    if child.tag == "scale":
        return bool(values) and all(value == _NO_SCALE for value in values)
    return child.tag not in _parents_by_tag() and (text in _FALSE or (bool(values) and not any(values)))


def _numbers(text: str) -> list[float]:
    try:
        return [float(item) for item in text.split()]
    except ValueError:
        return []


@cache
def _parents_by_tag() -> dict[str, frozenset[str]]:
    """Return the tags of the allowed parents of each element, by tag."""
    homes: dict[str, set[str]] = {}
    seen: set[int] = set()
    waiting: list[ElementRule] = [SDF]
    while waiting:
        rule = waiting.pop()
        if id(rule) in seen:
            continue
        seen.add(id(rule))
        for tag, child in rule.child_rules.items():
            homes.setdefault(tag, set()).add(rule.tag)
            waiting.append(child)
    return {tag: frozenset(found) for tag, found in homes.items()}
