"""Tests of whether and in which parents SDF reads an element."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache

from linkwright.schema import ElementRule
from linkwright.sdf.worlds import SDF
from linkwright.xmltree import Element

_TRUE_TEXTS, _FALSE_TEXTS = ("true", "1"), ("false", "")
_NEUTRAL_SCALE = 1.0
_MAX_PARENTS = 3
_HARMLESS_PAIRS = frozenset({("collision", "material")})
"""Pairs of parent and child tags that no reader needs: a collision is never drawn, so its color has no effect."""


def find_allowed_parents(tag: str) -> tuple[str, ...]:
    """Return the tags of an element's allowed parents.

    The result is empty if SDF does not define the element, or allows it in more than three parents.
    """
    parents = _index_parents().get(tag, ())
    return tuple(sorted(parents)) if len(parents) <= _MAX_PARENTS else ()


def find_static_links(elements: Iterable[Element]) -> frozenset[int]:
    """Return the ``id()`` of each link element in static models among `elements`."""
    return frozenset(
        id(link)
        for model in elements
        if model.tag == "model" and any(element.text().strip() in _TRUE_TEXTS for element in model.elements("static"))
        for link in model.elements("link")
    )


def changes_nothing(child: Element, parent: Element, static_links: frozenset[int]) -> bool:
    """Return whether reading an element would make no difference.

    Examples are an empty element, a scale of 1, and an element that SDF does not define with the value zero or false.
    """
    if (parent.tag, child.tag) in _HARMLESS_PAIRS or (child.tag == "static" and id(parent) in static_links):
        return True
    if next(child.elements(), None) is not None:
        return False
    text = child.text().strip()
    if not text:
        return True
    numbers = _parse_numbers(text)
    if child.tag == "scale":
        return bool(numbers) and all(value == _NEUTRAL_SCALE for value in numbers)
    return child.tag not in _index_parents() and (text in _FALSE_TEXTS or (bool(numbers) and not any(numbers)))


def _parse_numbers(text: str) -> list[float]:
    try:
        return [float(token) for token in text.split()]
    except ValueError:
        return []


@cache
def _index_parents() -> dict[str, frozenset[str]]:
    """Return the tags of the allowed parents of each element, by tag."""
    parents: dict[str, set[str]] = {}
    visited_rules: set[int] = set()
    pending: list[ElementRule] = [SDF]
    while pending:
        rule = pending.pop()
        if id(rule) in visited_rules:
            continue
        visited_rules.add(id(rule))
        for tag, child in rule.child_rules.items():
            parents.setdefault(tag, set()).add(rule.tag)
            pending.append(child)
    return {tag: frozenset(parent_tags) for tag, parent_tags in parents.items()}
