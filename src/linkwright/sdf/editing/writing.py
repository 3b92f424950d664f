"""Minimal edits that change the values of elements in a world."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from math import atan2, degrees, hypot

from linkwright.diagnostics import phrase
from linkwright.geometry.single import Pose, Quaternion, Transform, pose_quaternion
from linkwright.sdf.editing.errors import EditError
from linkwright.sdf.editing.shapes import length, lengths, new_element
from linkwright.xmltree import Element
from linkwright.xmltree.patches import (
    Replacement,
    block,
    element_range,
    escaped,
    find_start_tag,
    indentation,
    insertion,
    line_ending,
    whole_lines,
)
from linkwright.xmltree.positions import attribute_name_range, attribute_value_range

_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_NO_DIFFERENCE = 0.5e-9
_GIMBAL_LOCK = 1e-9
_TRUE = frozenset({"true", "1"})


def text_of(element: Element) -> str:
    """Return the whole text of the file that contains an element."""
    assert element.source is not None, "it was read from a text"
    return element.source.text


def range_of(element: Element) -> tuple[int, int]:
    """Return the start and end of an element in its text: its ``<``, and the position after its ``>``.

    Raises:
        EditError: the element comes from an XML entity.
    """
    found = element_range(element)
    if found is None:
        raise EditError(phrase("<{tag}> comes from an entity, and cannot be edited", tag=element.tag))
    return found


def content_of(element: Element) -> tuple[int, int]:
    """Return the start and end of an element's content; for ``<a/>`` an empty range after the tag."""
    start, end = range_of(element)
    tag = find_start_tag(element)
    assert tag is not None, "its range is known"
    return (tag.end, tag.end) if tag.is_whole else (tag.end, text_of(element).rindex("</", start, end))


def set_text(element: Element, value: str) -> list[Replacement]:
    """Return the edits that set the text of an element; surrounding whitespace is kept."""
    text, (start, end) = text_of(element), content_of(element)
    tag = find_start_tag(element)
    assert tag is not None, "its content is known"
    if tag.is_whole:
        return [Replacement(tag.room, tag.end, f">{escaped(value)}</{element.tag}>")]
    old = text[start:end]
    if "<" not in old and old.strip():
        start, end = start + len(old) - len(old.lstrip()), start + len(old.rstrip())
    return [] if text[start:end] == escaped(value) else [Replacement(start, end, escaped(value))]


def set_numbers(element: Element, numbers: Sequence[float]) -> list[Replacement]:
    """Return the edits that set the numbers of an element; unchanged numbers are kept as written."""
    text, (start, end) = text_of(element), content_of(element)
    plain = _COMMENT.sub(lambda found: " " * len(found[0]), text[start:end])
    words = list(re.finditer(r"\S+", plain))
    if len(words) != len(numbers) or "<" in plain or "&" in plain:
        return set_text(element, " ".join(map(length, numbers)))
    return [
        Replacement(start + word.start(), start + word.end(), length(number))
        for word, number in zip(words, numbers, strict=True)
        if not _has_value(word[0], number)
    ]


def _has_value(word: str, number: float) -> bool:
    try:
        return bool(abs(float(word) - number) <= _NO_DIFFERENCE)
    except ValueError:
        return False


def set_child(
    owner: Element, tag: str, value: str | Sequence[float], *, after: tuple[str, ...] = ()
) -> list[Replacement]:
    """Return the edits that set the value of a child element.

    A missing child is inserted after the last child whose tag is in `after`, or at the end.

    Args:
        owner: the element.
        tag: the tag of the child.
        value: a text or numbers.
        after: the tags of the children after which a missing child is inserted.
    """
    child = owner.first(tag)
    if child is not None:
        return set_text(child, value) if isinstance(value, str) else set_numbers(child, value)
    new = new_element(tag, value if isinstance(value, str) else lengths(tuple(value)))
    return [inserted_in(owner, [new], after=after)]


def inserted_in(owner: Element, new: list[Element], *, after: tuple[str, ...] = (), first: bool = False) -> Replacement:
    """Return the edit that inserts elements into another one.

    The new elements are inserted after the last child with a tag in `after`. If there is no such child, they are
    inserted at the end, or at the beginning with `first`.

    Raises:
        EditError: the owner comes from an XML entity.
    """
    before = [child for child in owner.elements() if child.tag in after]
    edit = insertion(owner, new, after=before[-1] if before else None, first=first)
    if edit is None:
        raise EditError(phrase("<{tag}> comes from an entity, and cannot be edited", tag=owner.tag))
    return edit


def set_attribute(element: Element, name: str, value: str) -> list[Replacement]:
    """Return the edits that set an attribute; its kind of quotes is kept.

    A missing attribute is inserted after the others.
    """
    text = text_of(element)
    found = attribute_value_range(text, element.offset, name)
    if found is None:
        range_of(element)
        tag = find_start_tag(element)
        assert tag is not None, "its range is known"
        return [Replacement(tag.room, tag.room, f' {name}="{escaped(value)}"')]
    written = escaped(value)
    if text[found[0] - 1] == "'":
        written = written.replace("&quot;", '"').replace("'", "&apos;")
    return [Replacement(*found, written)]


def set_reference(element: Element, attribute: str | None, name: str) -> list[Replacement]:
    """Return the edits that set the name to which an element refers.

    The name is in an attribute, or in the text of the element if `attribute` is None.
    """
    return set_text(element, name) if attribute is None else set_attribute(element, attribute, name)


def remove_attribute(element: Element, name: str) -> list[Replacement]:
    """Return the edits that remove an attribute and the whitespace before it."""
    text = text_of(element)
    named, found = (each(text, element.offset, name) for each in (attribute_name_range, attribute_value_range))
    if named is None or found is None:
        return []
    blanks = len(text[: named[0]]) - len(text[: named[0]].rstrip())
    return [Replacement(named[0] - blanks, found[1] + 1, "")]


def removed(element: Element) -> Replacement:
    """Return the edit that removes an element, with its lines if they contain nothing else."""
    return Replacement(*whole_lines(text_of(element), *range_of(element)), "")


def replace_element(element: Element, new: list[Element]) -> Replacement:
    """Return the edit that replaces an element by other elements, or removes it if there are none."""
    if not new:
        return removed(element)
    text, (start, end) = text_of(element), range_of(element)
    indent = indentation(text, start)
    between = "" if indent is None else f"{line_ending(text)}{indent}"
    return Replacement(start, end, between.join(block(element) for element in new))


def set_pose(element: Element, pose: Pose) -> list[Replacement]:
    """Return the edits that set a ``<pose>``, in the units and rotation format that it declares."""
    if element.attributes.get("rotation_format", "").strip() == "quat_xyzw":
        numbers: tuple[float, ...] = (*pose.xyz, *_nearest(element, pose_quaternion(pose)))
    elif element.attributes.get("degrees", "").strip().casefold() in _TRUE:
        numbers = (*pose.xyz, *map(degrees, pose.rpy))
    else:
        numbers = (*pose.xyz, *pose.rpy)
    return set_numbers(element, numbers)


def _nearest(element: Element, quaternion: Quaternion) -> Quaternion:
    """Return the quaternion or its negation, whichever is nearer to the quaternion in an element."""
    try:
        written = [float(word) for word in element.text().split()[3:]]
    except ValueError:
        return quaternion
    if len(written) == 4 and sum(a * b for a, b in zip(written, quaternion, strict=True)) < 0:
        x, y, z, w = quaternion
        return -x, -y, -z, -w
    return quaternion


def pose_from(transform: Transform) -> Pose:
    """Return a transform as a pose with angles, which are exact even at a pitch of 90 degrees."""
    x, y, z, w = transform[3:]
    along, across = 1 - 2 * (y * y + z * z), 2 * (x * y + z * w)
    pitch = atan2(-2 * (x * z - y * w), hypot(along, across))
    if hypot(along, across) < _GIMBAL_LOCK:
        rpy = 0.0, pitch, atan2(-2 * (x * y - z * w), 1 - 2 * (x * x + z * z))
    else:
        rpy = atan2(2 * (y * z + x * w), 1 - 2 * (x * x + y * y)), pitch, atan2(across, along)
    return Pose(transform[:3], rpy)


def pose_element(pose: Pose) -> Element:
    """Return a new ``<pose>`` element."""
    return new_element("pose", lengths((*pose.xyz, *pose.rpy)))


def references(world: Element) -> Iterator[tuple[Element, str | None]]:
    """Yield the elements of a world that refer to other elements by name.

    The attribute with the name follows each element; None if the name is the text of the element.
    """
    for child in world.elements():
        for element in (child, *child.elements("sensor")):
            pose = element.first("pose")
            if pose is not None:
                yield from ((pose, name) for name in ("relative_to", "frame") if name in pose.attributes)
        if child.tag == "frame" and "attached_to" in child.attributes:
            yield child, "attached_to"
        if child.tag == "joint":
            yield from ((element, None) for tag in ("parent", "child") for element in child.elements(tag))
            for axis in (*child.elements("axis"), *child.elements("axis2")):
                xyz = axis.first("xyz")
                if xyz is not None and "expressed_in" in xyz.attributes:
                    yield xyz, "expressed_in"
