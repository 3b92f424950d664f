"""Minimal edits that change the values of elements in a world."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from math import atan2, degrees, hypot

from linkwright.diagnostics import phrase
from linkwright.geometry.single import Pose, Quaternion, Transform, pose_quaternion
from linkwright.sdf.editing.errors import EditError
from linkwright.sdf.editing.shapes import format_length, format_lengths, make_element
from linkwright.xmltree import Element
from linkwright.xmltree.patches import (
    Replacement,
    escape,
    extend_to_whole_lines,
    find_element_range,
    find_start_tag,
    format_block,
    indentation,
    line_ending,
    make_insertion,
)
from linkwright.xmltree.positions import attribute_name_range, attribute_value_range

_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_TOLERANCE = 0.5e-9
"""The maximum difference for which a written number is kept."""
_GIMBAL_LOCK_TOLERANCE = 1e-9
_TRUE_TEXTS = frozenset({"true", "1"})


def get_source_text(element: Element) -> str:
    """Return the text of the file that contains an element."""
    assert element.source is not None, "it was read from a text"
    return element.source.text


def find_element_offsets(element: Element) -> tuple[int, int]:
    """Return the offsets of an element in its text: of its ``<``, and after its last ``>``.

    Raises:
        EditError: the element comes from an XML entity.
    """
    element_span = find_element_range(element)
    if element_span is None:
        raise EditError(phrase("<{tag}> cannot be edited because it comes from an XML entity", tag=element.tag))
    return element_span


def find_content_offsets(element: Element) -> tuple[int, int]:
    """Return the start and end offsets of an element's content.

    For ``<a/>``, the range is empty and after the tag.
    """
    start, end = find_element_offsets(element)
    tag = find_start_tag(element)
    assert tag is not None, "its range is known"
    return (tag.end, tag.end) if tag.is_empty_element else (tag.end, get_source_text(element).rindex("</", start, end))


def make_text_edits(element: Element, value: str) -> list[Replacement]:
    """Return the edits that set the text of an element, and keep surrounding whitespace."""
    text, (start, end) = get_source_text(element), find_content_offsets(element)
    tag = find_start_tag(element)
    assert tag is not None, "its content is known"
    if tag.is_empty_element:
        return [Replacement(tag.insertion_offset, tag.end, f">{escape(value)}</{element.tag}>")]
    old = text[start:end]
    if "<" not in old and old.strip():
        start, end = start + len(old) - len(old.lstrip()), start + len(old.rstrip())
    return [] if text[start:end] == escape(value) else [Replacement(start, end, escape(value))]


def make_number_edits(element: Element, numbers: Sequence[float]) -> list[Replacement]:
    """Return the edits that set the numbers of an element.

    Unchanged numbers are kept as written.
    """
    text, (start, end) = get_source_text(element), find_content_offsets(element)
    uncommented_text = _COMMENT.sub(lambda comment: " " * len(comment[0]), text[start:end])
    number_matches = list(re.finditer(r"\S+", uncommented_text))
    if len(number_matches) != len(numbers) or "<" in uncommented_text or "&" in uncommented_text:
        return make_text_edits(element, " ".join(map(format_length, numbers)))
    return [
        Replacement(start + number_match.start(), start + number_match.end(), format_length(number))
        for number_match, number in zip(number_matches, numbers, strict=True)
        if not _is_number(number_match[0], number)
    ]


def _is_number(text: str, number: float) -> bool:
    try:
        return bool(abs(float(text) - number) <= _TOLERANCE)
    except ValueError:
        return False


def make_child_edits(
    owner: Element, tag: str, value: str | Sequence[float], *, after: tuple[str, ...] = ()
) -> list[Replacement]:
    """Return the edits that set the value of a child element.

    A missing child is inserted after the last child whose tag is in `after`, or at the end.

    Args:
        owner: the parent element.
        tag: the tag of the child.
        value: the new text or numbers of the child.
        after: the tags of the children after which a missing child is inserted.
    """
    child = owner.first(tag)
    if child is not None:
        return make_text_edits(child, value) if isinstance(value, str) else make_number_edits(child, value)
    child_element = make_element(tag, value if isinstance(value, str) else format_lengths(tuple(value)))
    return [make_insertion_edit(owner, [child_element], after=after)]


def make_insertion_edit(
    owner: Element, new_elements: list[Element], *, after: tuple[str, ...] = (), first: bool = False
) -> Replacement:
    """Return the edit that inserts elements into a parent element.

    The new elements are inserted after the last child with a tag in `after`. If there is no such child, they are
    inserted at the end, or at the beginning with `first`.

    Raises:
        EditError: the owner comes from an XML entity.
    """
    preceding_children = [child for child in owner.elements() if child.tag in after]
    edit = make_insertion(
        owner, new_elements, after=preceding_children[-1] if preceding_children else None, first=first
    )
    if edit is None:
        raise EditError(phrase("<{tag}> cannot be edited because it comes from an XML entity", tag=owner.tag))
    return edit


def make_attribute_edits(element: Element, name: str, value: str) -> list[Replacement]:
    """Return the edits that set an attribute, and keep existing quote characters.

    A missing attribute is appended to the start tag.
    """
    text = get_source_text(element)
    value_range = attribute_value_range(text, element.offset, name)
    if value_range is None:
        find_element_offsets(element)
        tag = find_start_tag(element)
        assert tag is not None, "its range is known"
        return [Replacement(tag.insertion_offset, tag.insertion_offset, f' {name}="{escape(value)}"')]
    escaped_value = escape(value)
    if text[value_range[0] - 1] == "'":
        escaped_value = escaped_value.replace("&quot;", '"').replace("'", "&apos;")
    return [Replacement(*value_range, escaped_value)]


def make_reference_edits(element: Element, attribute: str | None, name: str) -> list[Replacement]:
    """Return the edits that set the name in a reference.

    The name is in an attribute, or in the text of the element if `attribute` is None.
    """
    return make_text_edits(element, name) if attribute is None else make_attribute_edits(element, attribute, name)


def make_attribute_removal_edits(element: Element, name: str) -> list[Replacement]:
    """Return the edits that remove an attribute and the whitespace before it."""
    text = get_source_text(element)
    name_range, value_range = (
        find_range(text, element.offset, name) for find_range in (attribute_name_range, attribute_value_range)
    )
    if name_range is None or value_range is None:
        return []
    blank_count = len(text[: name_range[0]]) - len(text[: name_range[0]].rstrip())
    return [Replacement(name_range[0] - blank_count, value_range[1] + 1, "")]


def make_removal_edit(element: Element) -> Replacement:
    """Return the edit that removes an element and the lines that become empty."""
    return Replacement(*extend_to_whole_lines(get_source_text(element), *find_element_offsets(element)), "")


def make_replacement_edit(element: Element, new_elements: list[Element]) -> Replacement:
    """Return the edit that replaces an element with other elements.

    The element is removed if `new_elements` is empty.
    """
    if not new_elements:
        return make_removal_edit(element)
    text, (start, end) = get_source_text(element), find_element_offsets(element)
    indent = indentation(text, start)
    separator = "" if indent is None else f"{line_ending(text)}{indent}"
    return Replacement(start, end, separator.join(format_block(element) for element in new_elements))


def make_pose_edits(element: Element, pose: Pose) -> list[Replacement]:
    """Return the edits that set a ``<pose>``, in its declared units and rotation format."""
    if element.attributes.get("rotation_format", "").strip() == "quat_xyzw":
        numbers: tuple[float, ...] = (*pose.xyz, *_choose_nearest_quaternion(element, pose_quaternion(pose)))
    elif element.attributes.get("degrees", "").strip().casefold() in _TRUE_TEXTS:
        numbers = (*pose.xyz, *map(degrees, pose.rpy))
    else:
        numbers = (*pose.xyz, *pose.rpy)
    return make_number_edits(element, numbers)


def _choose_nearest_quaternion(element: Element, quaternion: Quaternion) -> Quaternion:
    """Return a quaternion or its negation, whichever is nearer to an element's quaternion."""
    try:
        written_quaternion = [float(word) for word in element.text().split()[3:]]
    except ValueError:
        return quaternion
    if len(written_quaternion) == 4 and sum(a * b for a, b in zip(written_quaternion, quaternion, strict=True)) < 0:
        x, y, z, w = quaternion
        return -x, -y, -z, -w
    return quaternion


def pose_from_transform(transform: Transform) -> Pose:
    """Return a transform as a pose with roll, pitch and yaw.

    The result is exact even at a pitch of 90 degrees.
    """
    x, y, z, w = transform[3:]
    cos_yaw_term, sin_yaw_term = 1 - 2 * (y * y + z * z), 2 * (x * y + z * w)
    pitch = atan2(-2 * (x * z - y * w), hypot(cos_yaw_term, sin_yaw_term))
    if hypot(cos_yaw_term, sin_yaw_term) < _GIMBAL_LOCK_TOLERANCE:
        rpy = 0.0, pitch, atan2(-2 * (x * y - z * w), 1 - 2 * (x * x + z * z))
    else:
        rpy = atan2(2 * (y * z + x * w), 1 - 2 * (x * x + y * y)), pitch, atan2(sin_yaw_term, cos_yaw_term)
    return Pose(transform[:3], rpy)


def make_pose_element(pose: Pose) -> Element:
    """Return a new ``<pose>`` element."""
    return make_element("pose", format_lengths((*pose.xyz, *pose.rpy)))


def references(world: Element) -> Iterator[tuple[Element, str | None]]:
    """Yield each element of a world that refers to another by name, with its attribute.

    The attribute contains the name. It is None if the name is the text of the element.
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
