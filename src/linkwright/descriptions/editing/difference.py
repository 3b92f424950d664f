"""The comparison of two expansions of one description."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice, zip_longest

from linkwright.diagnostics import phrase, term
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.xmltree import Element


@dataclass(frozen=True, slots=True)
class Target:
    """The attribute of an expanded document that is edited.

    Attributes:
        path: the path from the root to the joint, visual or collision: the index of the child at each level.
        tag: the tag of the child with the attribute, ``origin`` or ``axis``.
        attribute: the name of the attribute.
    """

    path: tuple[int, ...]
    tag: str
    attribute: str

    def owner(self, root: Element) -> Element | None:
        """Return the joint, visual or collision in a document, or None if it no longer exists."""
        element: Element | None = root
        for index in self.path:
            element = next(islice(element.elements(), index, None), None) if element is not None else None
        return element

    def element(self, root: Element) -> Element | None:
        """Return the element with the attribute in a document, or None if it does not exist."""
        owner = self.owner(root)
        return None if owner is None else owner.first(self.tag)


def find_path(root: Element, element: Element) -> tuple[int, ...] | None:
    """Return the path of an element in a document, or None if the document does not contain it."""
    pending: list[tuple[Element, tuple[int, ...]]] = [(root, ())]
    while pending:
        current, path = pending.pop()
        if current is element:
            return path
        pending.extend((child, (*path, index)) for index, child in enumerate(current.elements()))
    return None


def other_differences(old_root: Element, new_root: Element, target: Target) -> Iterator[tuple[Element, ...]]:
    """Yield the differences, except a difference in the edited attribute.

    Args:
        old_root: the root of the first document.
        new_root: the root of the second document.
        target: the attribute that may differ; the attribute and its element may be new.

    Yields:
        The elements of the first document on the path from its root (exclusive) to an element that differs; empty if
        the root differs.
    """
    pending: list[tuple[Element, Element, tuple[Element, ...], tuple[int, ...]]] = [(old_root, new_root, (), ())]
    while pending:
        old, new, trail, path = pending.pop()
        old_children, new_children = list(old.elements()), list(new.elements())
        if path == target.path:
            pair = _take_first(old_children, target.tag), _take_first(new_children, target.tag)
            if _is_changed(*pair, target.attribute):
                yield trail
        if old.tag != new.tag or old.attributes != new.attributes or _get_text(old) != _get_text(new):
            yield trail
            continue
        for index, (old_child, new_child) in enumerate(zip_longest(old_children, new_children)):
            if old_child is None or new_child is None:
                yield trail
                break
            pending.append(
                (
                    old_child,
                    new_child,
                    (*trail, old_child),
                    (*path, _find_sibling_index(old, old_child, index, path == target.path)),
                )
            )


def describe_path(trail: tuple[Element, ...]) -> str:
    """Return a text that names the element of a path, such as ``joint 'wheel_joint'``."""
    named_elements = [
        element for element in trail if element.attributes.get("name") or element.attributes.get("reference")
    ]
    if not trail:
        return term("robot")
    outermost = trail[0]
    name = outermost.attributes.get("name") or outermost.attributes.get("reference") or ""
    inner_tag = next((element.tag for element in trail[1:2] if outermost.tag == "link"), None)
    kind = term(outermost.tag)
    name_text = phrase("{kind} '{name}'", kind=kind, name=name) if named_elements and name else kind
    return name_text if inner_tag is None else phrase("{owner} ({part})", owner=name_text, part=term(inner_tag))


def _find_sibling_index(old: Element, child: Element, index: int, is_owner: bool) -> int:
    """Return the index of a child among its siblings.

    In the owner, `index` does not include the removed element, so the index is found by a search for the child.
    """
    return next(position for position, element in enumerate(old.elements()) if element is child) if is_owner else index


def _take_first(elements: list[Element], tag: str) -> Element | None:
    """Remove and return the first element with a tag, or return None if there is none."""
    first_match = next((element for element in elements if element.tag == tag), None)
    if first_match is not None:
        elements.remove(first_match)
    return first_match


def _is_changed(old: Element | None, new: Element | None, attribute: str) -> bool:
    if new is None:
        return old is not None
    new_attributes = {name: value for name, value in new.attributes.items() if name != attribute}
    old_attributes = {} if old is None else {name: value for name, value in old.attributes.items() if name != attribute}
    return new_attributes != old_attributes or any(new.elements()) != any(old.elements() if old is not None else ())


def _get_text(element: Element) -> str:
    return " ".join(element.text().split())
