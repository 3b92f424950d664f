"""Insert ``<inertial>`` blocks into a description's source, without other changes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from math import isclose

from linkwright.diagnostics import SourceText, phrase
from linkwright.geometry.mass import MassProperties
from linkwright.inertia.blocks import Attributes, empty_tag, inertial_block, inertial_parts
from linkwright.loading.deferred import lazy_pattern
from linkwright.urdf import Link
from linkwright.xacro.faults import Frame, frames
from linkwright.xmltree import Element, parse
from linkwright.xmltree.patches import Replacement, indentation, line_ending
from linkwright.xmltree.positions import attribute_name_range, attribute_value_range, find_start_tag_end

_TRAILING_COMMENTS = lazy_pattern(r"(?:[ \t]*<!--(?:(?!-->).)*-->)*(?=[ \t]*\r?\n)")
"""Comments that follow a start tag on its line, and belong to the tag."""

EXPRESSION = lazy_pattern(r"\$[{(](?!find\b)")
"""An expression whose value may change. A package's folder does not change the shape of a mesh."""


class NotWritableError(Exception):
    """Raised when an element cannot be changed because it is not literal text of a file.

    The message is the reason, as a clause.
    """


def create_edits(link: Link, properties: MassProperties) -> tuple[SourceText, list[Replacement]]:
    """Return a source text and the edits that give a link these mass properties.

    An existing ``<inertial>`` keeps its formatting and comments; only values are replaced and missing parts added. A
    new ``<inertial>`` becomes the first child of the link.

    Args:
        link: the link, read from a file, possibly through xacro.
        properties: the mass properties in the link frame.

    Raises:
        NotWritableError: if a macro generates the link, or if the link is written with expressions.
    """
    link_element = find_written_link(link)
    source = link_element.source
    assert source is not None
    inertial = link_element.first("inertial")
    if inertial is None:
        return source, [_insert_block(source.text, link_element, properties)]
    if _contains_match(inertial, EXPRESSION):
        raise NotWritableError(phrase("its <inertial> is written with expressions"))
    return source, list(_update_block(source.text, inertial, properties))


def find_written_element(element: Element | None, tag: str) -> Element:
    """Return an element as written in its file, before any expansion.

    Args:
        element: the element of the expanded description.
        tag: the tag that the element must also have in the file.

    Raises:
        NotWritableError: if a macro generates the element, or if it is not written literally in a file.
    """
    if element is None or element.source is None:
        raise NotWritableError(phrase("it is not written in a file"))
    frame = element.origin if isinstance(element.origin, Frame) else None
    macro = next((outer.macro for outer in frames(frame) if outer.macro is not None), None)
    if macro is not None:
        raise NotWritableError(phrase("the macro '{macro}' generates it", macro=macro))
    document = parse(element.source.text, element.source.name)
    element_in_file = next((child for child in document.root.walk() if child.offset == element.offset), None)
    if element_in_file is None or element_in_file.tag != tag:
        raise NotWritableError(phrase("it is not written as a plain <{tag}>", tag=tag))
    return element_in_file


def find_written_link(link: Link) -> Element:
    """Return a ``<link>`` as written in its file, if its shapes do not depend on xacro.

    Raises:
        NotWritableError: see `find_written_element`; also if expressions define the shapes.
    """
    link_element = find_written_element(link.element, "link")
    xacro_tag = next((child.tag for child in link_element.elements() if child.tag.startswith("xacro:")), None)
    if xacro_tag is not None:
        raise NotWritableError(phrase("<{tag}> generates a part of it", tag=xacro_tag))
    for shape in (*link_element.elements("visual"), *link_element.elements("collision")):
        shape_children = (shape.first("origin"), shape.first("geometry"))
        if any(item is not None and _contains_match(item, EXPRESSION) for item in shape_children):
            raise NotWritableError(
                phrase("its shapes are written with expressions, and numbers in the file would not follow them")
            )
    return link_element


def _insert_block(text: str, link: Element, properties: MassProperties) -> Replacement:
    offset = find_start_tag_end(text, link.offset)
    newline = line_ending(text)
    link_indent = indentation(text, link.offset)
    child = next(link.elements(), None)
    child_indent = indentation(text, child.offset) if child is not None else None
    if child_indent is None:
        child_indent = (link_indent or "") + "  "
    step = child_indent.removeprefix(link_indent or "") if child_indent.startswith(link_indent or "") else ""
    block = inertial_block(properties, child_indent, step or "  ", newline)
    comments = _TRAILING_COMMENTS.match(text, offset)
    if comments is not None:
        return Replacement(comments.end(), comments.end(), f"{newline}{child_indent}{block}")
    return Replacement(offset, offset, f"{newline}{child_indent}{block}{newline}{child_indent}")


def _update_block(text: str, inertial: Element, properties: MassProperties) -> Iterator[Replacement]:
    end = find_start_tag_end(text, inertial.offset)
    newline = line_ending(text)
    if text[end - 2] == "/":
        block = inertial_block(properties, indentation(text, inertial.offset) or "", newline=newline)
        yield Replacement(inertial.offset, end, block)
        return
    indent = (indentation(text, inertial.offset) or "") + "  "
    first_child = next(inertial.elements(), None)
    if first_child is not None:
        indent = indentation(text, first_child.offset) or indent
    missing_tags = []
    for tag, attributes in inertial_parts(properties):
        child = inertial.first(tag)
        if child is None:
            missing_tags.append(f"{newline}{indent}{empty_tag(tag, attributes)}")
        else:
            yield from _update_attributes(text, child, attributes)
    if missing_tags:
        yield Replacement(end, end, "".join(missing_tags))


def _update_attributes(text: str, element: Element, attributes: Attributes) -> Iterator[Replacement]:
    new_attributes = ""
    for name, value in attributes:
        attribute_range = attribute_value_range(text, element.offset, name)
        if attribute_range is None:
            new_attributes += "" if (name, value) == ("rpy", "0 0 0") else f' {name}="{value}"'
        elif not _is_equal_value(text[slice(*attribute_range)], value):
            yield Replacement(*attribute_range, value)
    if new_attributes:
        tag_name_end = element.offset + 1 + len(element.tag)
        yield Replacement(tag_name_end, tag_name_end, new_attributes)
    name_range = attribute_name_range(text, element.offset, "quat_xyzw")
    value_range = attribute_value_range(text, element.offset, "quat_xyzw")
    if name_range is not None and value_range is not None:  # The block has the link's axes, so it needs no rotation.
        yield Replacement(name_range[0], value_range[1] + 1, "")


def _is_equal_value(old_value: str, value: str) -> bool:
    """Return whether the numbers in an attribute equal new ones, up to rounding."""
    try:
        old_numbers = [float(word) for word in old_value.split()]
    except ValueError:
        return False
    new_numbers = [float(word) for word in value.split()]
    return len(old_numbers) == len(new_numbers) and all(
        isclose(a, b, rel_tol=1e-5) for a, b in zip(old_numbers, new_numbers, strict=True)
    )


def _contains_match(element: Element, pattern: re.Pattern[str]) -> bool:
    """Return whether an element depends on xacro or has an attribute that matches a pattern.

    Descendants of the element are included.
    """
    return any(
        child.tag.startswith("xacro:") or any(map(pattern.search, child.attributes.values()))
        for child in element.walk()
    )
