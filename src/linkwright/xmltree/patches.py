"""Minimal changes to an XML text: ranges of elements, and their replacement.

Everything outside the ranges, including formatting and comments, is unchanged.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.xmltree.nodes import Element

_TAG_NAME = lazy_pattern(r"<[^\s/>]+")
_START_TAG_REST = lazy_pattern(r"""(?:[^"'>]|"[^"]*"|'[^']*')*>""")
_MARKUP = lazy_pattern(r"<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?.*?\?>|</[^>]*>|<", re.DOTALL)
_INDENT = "  "
_ENTITIES = {"&": "&amp;", "<": "&lt;", '"': "&quot;"}


@dataclass(frozen=True, slots=True)
class Replacement:
    """The replacement of characters `start` to `end` (exclusive) of a source text by `text`."""

    start: int
    end: int
    text: str


@dataclass(frozen=True, slots=True)
class StartTag:
    """A start tag in a text.

    Attributes:
        start: the character offset of the tag's ``<``.
        insertion_offset: the character offset after the last attribute, where another attribute can be inserted.
        end: the character offset after the tag's ``>``.
        is_empty_element: whether the tag is an empty-element tag, ``<a/>``.
    """

    start: int
    insertion_offset: int
    end: int
    is_empty_element: bool


def apply(text: str, edits: Iterable[Replacement]) -> str:
    """Return a text with non-overlapping replacements applied."""
    parts, position = [], 0
    for edit in sorted(edits, key=lambda edit: (edit.start, edit.end)):
        parts += [text[position : edit.start], edit.text]
        position = edit.end
    return "".join([*parts, text[position:]])


def escape(value: str) -> str:
    """Return a value escaped for use between double quotes."""
    return "".join(_ENTITIES.get(character, character) for character in value)


def line_ending(text: str) -> str:
    """Return the line ending of a text."""
    return "\r\n" if "\r\n" in text else "\n"


def indentation(text: str, offset: int) -> str | None:
    """Return the whitespace between the start of a line and an offset in it.

    The result is None if other characters precede the offset in its line.
    """
    preceding = text[text.rfind("\n", 0, offset) + 1 : offset]
    return preceding if not preceding.strip() else None


def find_start_tag(element: Element) -> StartTag | None:
    """Return an element's start tag in its source, or None if the source does not have it.

    The source does not contain elements that a program or an entity created.
    """
    if element.source is None:
        return None
    text = element.source.text
    name = _TAG_NAME.match(text, element.offset)
    rest_of_tag = name and _START_TAG_REST.match(text, name.end())
    if not name or not rest_of_tag or name[0] != f"<{element.tag}":
        return None
    is_whole = rest_of_tag[0].endswith("/>")
    attribute_text = text[name.end() : rest_of_tag.end() - (2 if is_whole else 1)]
    return StartTag(element.offset, name.end() + len(attribute_text.rstrip()), rest_of_tag.end(), is_whole)


def find_element_range(element: Element) -> tuple[int, int] | None:
    """Return the character offsets of an element's ``<`` and after its last ``>``.

    The result is None if the source does not contain the element.
    """
    tag = find_start_tag(element)
    if element.source is None or tag is None:
        return None
    text, end = element.source.text, tag.end
    depth = 0 if tag.is_empty_element else 1
    while depth:
        markup = _MARKUP.search(text, end)
        if markup is None:
            return None
        end = markup.end()
        if markup[0] == "<":
            rest_of_tag = _START_TAG_REST.match(text, end)
            if rest_of_tag is None:
                return None
            end = rest_of_tag.end()
            depth += not rest_of_tag[0].endswith("/>")
        elif markup[0].startswith("</"):
            depth -= 1
    return element.offset, end


def extend_to_whole_lines(text: str, start: int, end: int) -> tuple[int, int]:
    """Return a range extended to complete lines, unless the lines have other content."""
    line_start = text.rfind("\n", 0, start) + 1
    line_end = text.find("\n", end)
    line_end = len(text) if line_end < 0 else line_end + 1
    is_alone = not text[line_start:start].strip() and not text[end:line_end].strip()
    return (line_start, line_end) if is_alone else (start, end)


def format_block(element: Element, indent: str = "", step: str = _INDENT, newline: str = "\n") -> str:
    """Return the text of an element for insertion into a file, without a final line ending.

    Args:
        element: an element created by a program, which contains either elements or text.
        indent: the indentation of each line except the first.
        step: the additional indentation of the children.
        newline: the line ending.
    """
    opening = element.tag + "".join(f' {name}="{escape(value)}"' for name, value in element.attributes.items())
    children = list(element.elements())
    if not children:
        text = element.text()
        return f"<{opening}>{escape(text)}</{element.tag}>" if text else f"<{opening}/>"
    child_indent = indent + step
    lines = [f"<{opening}>", *(child_indent + format_block(child, child_indent, step, newline) for child in children)]
    return newline.join([*lines, f"{indent}</{element.tag}>"])


def make_insertion(
    owner: Element, new_elements: Sequence[Element], *, after: Element | None = None, first: bool = False
) -> Replacement | None:
    """Return the replacement that inserts elements into an element with matching indentation.

    Args:
        owner: the element of a file into which the new elements are inserted.
        new_elements: the elements to insert, created by a program.
        after: the child of the owner after which they are inserted; None for the end.
        first: whether to insert them before all children if `after` is None.

    Returns:
        The replacement, or None if the owner's source does not contain it.
    """
    owner_range = find_element_range(owner)
    tag = find_start_tag(owner)
    if owner_range is None or tag is None or owner.source is None:
        return None
    text, (start, end) = owner.source.text, owner_range
    newline, owner_indent = line_ending(text), _find_line_indent(text, start)
    child = next(owner.elements(), None)
    child_indent = owner_indent + _INDENT if child is None else _find_line_indent(text, child.offset)
    in_line = child is not None and "\n" not in text[start : child.offset]
    if in_line:
        child_indent = owner_indent + _INDENT
    step = (
        child_indent.removeprefix(owner_indent)
        if child_indent.startswith(owner_indent) and child_indent != owner_indent
        else _INDENT
    )
    if tag.is_empty_element:
        lines = newline.join(
            child_indent + format_block(element, child_indent, step, newline) for element in new_elements
        )
        return Replacement(tag.insertion_offset, end, f">{newline}{lines}{newline}{owner_indent}</{owner.tag}>")
    after_range = find_element_range(after) if after is not None else None
    if in_line and not any(True for element in new_elements for _ in element.elements()):
        offset = after_range[1] if after_range else tag.end if first else text.rindex("</", start, end)
        return Replacement(offset, offset, "".join(format_block(element) for element in new_elements))
    lines = newline.join(child_indent + format_block(element, child_indent, step, newline) for element in new_elements)
    if after_range is not None:
        return Replacement(after_range[1], after_range[1], f"{newline}{lines}")
    if first and child is not None:
        if in_line:
            return Replacement(tag.end, tag.end, f"{newline}{lines}{newline}{child_indent}")
        return Replacement(child.offset, child.offset, f"{lines.removeprefix(child_indent)}{newline}{child_indent}")
    closing = text.rindex("</", start, end)
    line = text.rfind("\n", 0, closing) + 1
    if line > start and not text[line:closing].strip():
        return Replacement(line, line, f"{lines}{newline}")
    return Replacement(closing, closing, f"{newline}{lines}{newline}{owner_indent}")


def _find_line_indent(text: str, offset: int) -> str:
    """Return the whitespace at the beginning of the line that contains an offset."""
    line = text[text.rfind("\n", 0, offset) + 1 : offset]
    return line[: len(line) - len(line.lstrip())]
