"""Add inferred elements to a description in memory, and remove those that would disturb them."""

from __future__ import annotations

from copy import copy

from linkwright.inference.results import Inference
from linkwright.xmltree import Document, Element

SINGLE_TAGS = ("inertial", "axis")
"""Elements that a link or joint can have only once. A new one replaces the old one."""


def complete_description(document: Document, inference: Inference) -> Document:
    """Return a description for a simulator, with all inferred elements and without those to remove.

    Args:
        document: the expanded description from which the inference was made; it is not changed.
        inference: the inference about the robot in this document; one from another reading of the same file does not
            fit.

    Returns:
        A copy of the document. Each new element has the source position of the element to which it was added.
    """
    added: dict[int, list[Element]] = {}
    for finding in inference.findings:
        if finding.owner is not None:
            added.setdefault(id(finding.owner), []).extend(
                _place_at_owner(element, finding.owner) for element in finding.added
            )
    root = _add_children(document.root, added)
    removed = {id(element) for element in inference.removed}
    root.children = [
        _remove_children(_add_children(child, added), removed) if isinstance(child, Element) else child
        for child in root.children
    ]
    assert not added, "the inference is about another reading of the description"
    result = Document(root, document.source)
    result.prolog, result.epilog = document.prolog, document.epilog
    return result


def _add_children(element: Element, added: dict[int, list[Element]]) -> Element:
    """Return a copy of an element with its new children, or the element if there are none."""
    new_children = added.pop(id(element), [])
    if not new_children and element.tag != "robot":
        return element
    result = copy(element)
    result.plan = None
    replaced = {element.tag for element in new_children if element.tag in SINGLE_TAGS}
    kept_children = [child for child in element.children if not (isinstance(child, Element) and child.tag in replaced)]
    result.children = [*kept_children, *new_children]
    return result


def _remove_children(element: Element, removed: set[int]) -> Element:
    """Return a copy of an element without the children to remove, or the element if it has none of them."""
    kept_children = [child for child in element.children if id(child) not in removed]
    if len(kept_children) == len(element.children):
        return element
    result = copy(element)
    result.plan, result.children = None, kept_children
    return result


def _place_at_owner(element: Element, owner: Element) -> Element:
    """Return a copy of a new element at the source position of its owner.

    Findings about the element then have a source position.
    """
    positioned = Element(element.tag, dict(element.attributes), owner.source, owner.offset, owner.origin)
    positioned.children = [
        _place_at_owner(child, owner) if isinstance(child, Element) else child for child in element.children
    ]
    return positioned
