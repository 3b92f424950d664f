"""Insertion of ``<inertial>`` blocks into the source of a description.

All other text remains unchanged.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from math import isclose

from linkwright.diagnostics import SourceText, phrase
from linkwright.geometry.mass import MassProperties
from linkwright.inertia.blocks import Attributes, inertial_block, inertial_parts, start_tag
from linkwright.loading.deferred import lazy_pattern
from linkwright.urdf import Link
from linkwright.xacro.faults import Frame, frames
from linkwright.xmltree import Element, parse
from linkwright.xmltree.patches import Replacement, indentation, newline_of
from linkwright.xmltree.positions import attribute_name_range, attribute_value_range

_START_TAG = lazy_pattern(r"""<(?:[^"'>]|"[^"]*"|'[^']*')*>""")
_REST_OF_LINE = lazy_pattern(r"(?:[ \t]*<!--(?:(?!-->).)*-->)*(?=[ \t]*\r?\n)")
"""Comments behind a start tag, which belong to it."""

_EXPRESSION = lazy_pattern(r"\$[{(](?!find\b)")
"""An expression whose value may change; a package's folder does not change the shape of a mesh."""


class NotWritableError(Exception):
    """Raised when a link's ``<inertial>`` is not literal text of a file.

    The message is the reason, as a clause.
    """


def edits_for(link: Link, properties: MassProperties) -> tuple[SourceText, list[Replacement]]:
    """Return the edits of source texts that give a link these mass properties.

    An existing ``<inertial>`` keeps its formatting and comments; only values are replaced and missing parts added. A
    new ``<inertial>`` becomes the first child of the link.

    Args:
        link: the link, read from a file, possibly through xacro.
        properties: the mass properties in the link frame.

    Raises:
        NotWritableError: the link is written by a macro, or with expressions.
    """
    written = written_link(link)
    source = written.source
    assert source is not None
    inertial = written.first("inertial")
    if inertial is None:
        return source, [_new_block(source.text, written, properties)]
    if _holds(inertial, _EXPRESSION):
        raise NotWritableError(phrase("its <inertial> is written with expressions"))
    return source, list(_changed_block(source.text, inertial, properties))


def written_element(element: Element | None, tag: str) -> Element:
    """Return an element as written in its file, before any expansion.

    Args:
        element: the element of the expanded description.
        tag: the tag that the element must also have in the file.

    Raises:
        NotWritableError: the element is from a macro or an expression, or not from a file.
    """
    if element is None or element.source is None:
        raise NotWritableError(phrase("it is not written in a file"))
    frame = element.origin if isinstance(element.origin, Frame) else None
    macro = next((outer.macro for outer in frames(frame) if outer.macro is not None), None)
    if macro is not None:
        raise NotWritableError(phrase("the macro '{macro}' generates it", macro=macro))
    document = parse(element.source.text, element.source.name)
    written = next((child for child in document.root.walk() if child.offset == element.offset), None)
    if written is None or written.tag != tag:
        raise NotWritableError(phrase("it is not written as a plain <{tag}>", tag=tag))
    return written


def written_link(link: Link) -> Element:
    """Return the ``<link>`` as written in its file, if its shapes do not depend on xacro.

    Raises:
        NotWritableError: as for `written_element`, or its shapes contain expressions that new numbers would not follow.
    """
    written = written_element(link.element, "link")
    dynamic = next((child.tag for child in written.elements() if child.tag.startswith("xacro:")), None)
    if dynamic is not None:
        raise NotWritableError(phrase("<{tag}> generates a part of it", tag=dynamic))
    for shape in (*written.elements("visual"), *written.elements("collision")):
        parts = (shape.first("origin"), shape.first("geometry"))
        if any(part is not None and _holds(part, _EXPRESSION) for part in parts):
            raise NotWritableError(
                phrase("its shapes are written with expressions, and numbers in the file would not follow them")
            )
    return written


def _new_block(text: str, link: Element, properties: MassProperties) -> Replacement:
    at = _tag_end(text, link.offset)
    newline = newline_of(text)
    outer = indentation(text, link.offset)
    child = next(link.elements(), None)
    inner = indentation(text, child.offset) if child is not None else None
    if inner is None:
        inner = (outer or "") + "  "
    step = inner.removeprefix(outer or "") if inner.startswith(outer or "") else ""
    block = inertial_block(properties, inner, step or "  ", newline)
    rest = _REST_OF_LINE.match(text, at)
    if rest is not None:
        return Replacement(rest.end(), rest.end(), f"{newline}{inner}{block}")
    return Replacement(at, at, f"{newline}{inner}{block}{newline}{inner}")


def _changed_block(text: str, inertial: Element, properties: MassProperties) -> Iterator[Replacement]:
    end = _tag_end(text, inertial.offset)
    newline = newline_of(text)
    if text[end - 2] == "/":
        block = inertial_block(properties, indentation(text, inertial.offset) or "", newline=newline)
        yield Replacement(inertial.offset, end, block)
        return
    indent = (indentation(text, inertial.offset) or "") + "  "
    first = next(inertial.elements(), None)
    if first is not None:
        indent = indentation(text, first.offset) or indent
    missing = []
    for tag, attributes in inertial_parts(properties):
        child = inertial.first(tag)
        if child is None:
            missing.append(f"{newline}{indent}{start_tag(tag, attributes)}")
        else:
            yield from _changed_attributes(text, child, attributes)
    if missing:
        yield Replacement(end, end, "".join(missing))


def _changed_attributes(text: str, element: Element, attributes: Attributes) -> Iterator[Replacement]:
    added = ""
    for name, value in attributes:
        found = attribute_value_range(text, element.offset, name)
        if found is None:
            added += "" if (name, value) == ("rpy", "0 0 0") else f' {name}="{value}"'
        elif not _is_equal_value(text[slice(*found)], value):
            yield Replacement(*found, value)
    if added:
        after = element.offset + 1 + len(element.tag)
        yield Replacement(after, after, added)
    name_range = attribute_name_range(text, element.offset, "quat_xyzw")
    value_range = attribute_value_range(text, element.offset, "quat_xyzw")
    if name_range is not None and value_range is not None:  # The block's axes are those of the link.
        yield Replacement(name_range[0], value_range[1] + 1, "")


def _is_equal_value(written: str, value: str) -> bool:
    """Return whether numbers in the file equal new ones, up to rounding."""
    try:
        there = [float(word) for word in written.split()]
    except ValueError:
        return False
    wanted = [float(word) for word in value.split()]
    return len(there) == len(wanted) and all(isclose(a, b, rel_tol=1e-5) for a, b in zip(there, wanted, strict=True))


def _holds(element: Element, pattern: re.Pattern[str]) -> bool:
    """Return whether a pattern matches an attribute of an element or its descendants, or a child depends on xacro."""
    return any(
        child.tag.startswith("xacro:") or any(map(pattern.search, child.attributes.values()))
        for child in element.walk()
    )


def _tag_end(text: str, offset: int) -> int:
    found = _START_TAG.match(text, offset)
    assert found is not None, "the text was parsed"
    return found.end()
