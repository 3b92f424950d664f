"""Changes to source files that fix a finding, and functions for the most common edits.

An edit replaces a range of characters of one file. Everything else, including formatting and comments, is
unchanged.
"""

from __future__ import annotations

import re

from linkwright.loading.lean_dataclasses import dataclass
from linkwright.xmltree import Element
from linkwright.xmltree.patches import escape, extend_to_whole_lines, find_element_range, find_start_tag
from linkwright.xmltree.positions import attribute_name_range, attribute_value_range


@dataclass(frozen=True, slots=True)
class Edit:
    """One replacement in a source file.

    Attributes:
        source_file: the path of the file, as its `SourceText` names it.
        start: the offset of the first character that is replaced.
        end: the offset after the last character that is replaced.
        replacement: the new text, as it is written in the file.
    """

    source_file: str
    start: int
    end: int
    replacement: str


@dataclass(frozen=True, slots=True)
class Fix:
    """Edits that are applied together.

    Attributes:
        edits: the edits, which must not overlap.
        safe: whether the fix cannot change the author's meaning; an unsafe fix is applied only on request.
    """

    edits: tuple[Edit, ...]
    safe: bool = True


def replace_value(element: Element, attribute: str, value: str, *, safe: bool = True) -> Fix | None:
    """Return a fix that changes an attribute's value, or None if the value is not literal."""
    edit = value_edit(element, attribute, value)
    return None if edit is None else Fix((edit,), safe)


def rename_attribute(element: Element, old: str, new: str, *, safe: bool = True) -> Fix | None:
    """Return a fix that renames an attribute.

    Return None if the attribute is not written in the file, or the element already has an attribute with the new name.
    """
    source = element.source
    if source is None or new in element.attributes:
        return None
    name_range = attribute_name_range(source.text, element.offset, old)
    return None if name_range is None else Fix((Edit(source.name, *name_range, new),), safe)


def add_attribute(element: Element, attribute: str, value: str, *, safe: bool = True) -> Fix | None:
    """Return a fix that adds an attribute after the existing attributes.

    Return None if the element is not written in a file, or already has the attribute.
    """
    source = element.source
    start_tag = find_start_tag(element)
    if source is None or start_tag is None or attribute in element.attributes:
        return None
    offset = start_tag.insertion_offset
    return Fix((Edit(source.name, offset, offset, f' {attribute}="{escape(value)}"'),), safe)


def rename_element(element: Element, tag: str, *, safe: bool = True) -> Fix | None:
    """Return a fix that renames an element in its start and end tags.

    Return None if the element is not written in a file.
    """
    source = element.source
    character_range = find_element_range(element)
    if source is None or character_range is None:
        return None
    edits = [Edit(source.name, element.offset + 1, element.offset + 1 + len(element.tag), tag)]
    end_tag = re.compile(rf"</({re.escape(element.tag)})\s*>$").search(source.text[slice(*character_range)])
    if end_tag:
        edits.append(Edit(source.name, character_range[0] + end_tag.start(1), character_range[0] + end_tag.end(1), tag))
    return Fix(tuple(edits), safe)


def remove_element(element: Element, *, safe: bool = True) -> Fix | None:
    """Return a fix that removes an element and its content.

    Return None if the element is not written in a file. A line that would be left empty is also removed.
    """
    source = element.source
    character_range = find_element_range(element)
    if source is None or character_range is None:
        return None
    start, end = extend_to_whole_lines(source.text, *character_range)
    return Fix((Edit(source.name, start, end, ""),), safe)


def value_edit(element: Element, attribute: str, value: str) -> Edit | None:
    """Return the edit that changes an attribute's value, or None if it is not a literal."""
    source = element.source
    if source is None or not is_literal(element, attribute):
        return None
    value_range = attribute_value_range(source.text, element.offset, attribute)
    return None if value_range is None else Edit(source.name, *value_range, escape(value))


def is_literal(element: Element, attribute: str) -> bool:
    """Return whether an attribute's value is literal in the file, not a xacro expression."""
    source = element.source
    if source is None or attribute not in element.attributes:
        return False
    value_range = attribute_value_range(source.text, element.offset, attribute)
    if value_range is None:
        return False
    raw_value = source.text[slice(*value_range)]
    return "$" not in raw_value and "&" not in raw_value and raw_value.split() == element.attributes[attribute].split()
