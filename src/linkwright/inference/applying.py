"""Addition of the inferred elements to a description, in memory."""

from __future__ import annotations

from copy import copy

from linkwright.inference.model import Inference
from linkwright.xmltree import Document, Element

SINGLE = ("inertial", "axis")
"""Elements that a link or joint holds only once; a new one replaces the old one."""


def complete_description(document: Document, inference: Inference) -> Document:
    """Return a description with all inferred elements, so that a simulator can read it.

    Args:
        document: the expanded description from which the robot of the inference was read; it is not changed.
        inference: the inference about that robot; an inference from another reading of the same file does not fit.

    Returns:
        A document whose new elements have the source place of the element to which they were added.
    """
    added: dict[int, list[Element]] = {}
    for finding in inference.findings:
        if finding.owner is not None:
            added.setdefault(id(finding.owner), []).extend(_placed(element, finding.owner) for element in finding.added)
    root = _grown(document.root, added)
    root.children = [_grown(child, added) if isinstance(child, Element) else child for child in root.children]
    assert not added, "the inference is about another reading of the description"
    result = Document(root, document.source)
    result.prolog, result.epilog = document.prolog, document.epilog
    return result


def _grown(element: Element, added: dict[int, list[Element]]) -> Element:
    """Return a copy of an element with its new children, or the element itself if there are none."""
    new = added.pop(id(element), [])
    if not new and element.tag != "robot":
        return element
    grown = copy(element)
    grown.plan = None
    replaced = {element.tag for element in new if element.tag in SINGLE}
    kept = [child for child in element.children if not (isinstance(child, Element) and child.tag in replaced)]
    grown.children = [*kept, *new]
    return grown


def _placed(element: Element, owner: Element) -> Element:
    """Return a copy of a new element with the source place of its owner.

    Findings about the element then have a place.
    """
    placed = Element(element.tag, dict(element.attributes), owner.source, owner.offset, owner.origin)
    placed.children = [_placed(child, owner) if isinstance(child, Element) else child for child in element.children]
    return placed
