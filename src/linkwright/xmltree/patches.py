"""Minimal changes to an XML text: the ranges of elements in the text, and their replacement.

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
_STEP = "  "
_UNSAFE = {"&": "&amp;", "<": "&lt;", '"': "&quot;"}


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
        room: the character offset after the last attribute, where another attribute can be inserted.
        end: the character offset after the tag's ``>``.
        is_whole: whether the tag is the whole element, ``<a/>``.
    """

    start: int
    room: int
    end: int
    is_whole: bool


def apply(text: str, edits: Iterable[Replacement]) -> str:
    """Return a text with replacements applied; the replacements must not overlap."""
    parts, at = [], 0
    for edit in sorted(edits, key=lambda edit: (edit.start, edit.end)):
        parts += [text[at : edit.start], edit.text]
        at = edit.end
    return "".join([*parts, text[at:]])


def escaped(value: str) -> str:
    """Return a value escaped for use between double quotes."""
    return "".join(_UNSAFE.get(character, character) for character in value)


def newline_of(text: str) -> str:
    """Return the line ending of a text."""
    return "\r\n" if "\r\n" in text else "\n"


def indentation(text: str, offset: int) -> str | None:
    """Return the blanks between the start of a line and an offset in it.

    The result is None if the line has other characters there.
    """
    before = text[text.rfind("\n", 0, offset) + 1 : offset]
    return before if not before.strip() else None


def start_tag_of(element: Element) -> StartTag | None:
    """Return the start tag of an element in its source, or None if it is not written there.

    An element is not written in its source if a program or an entity created it.
    """
    if element.source is None:
        return None
    text = element.source.text
    name = _TAG_NAME.match(text, element.offset)
    rest = name and _START_TAG_REST.match(text, name.end())
    if not name or not rest or name[0] != f"<{element.tag}":
        return None
    is_whole = rest[0].endswith("/>")
    inside = text[name.end() : rest.end() - (2 if is_whole else 1)]
    return StartTag(element.offset, name.end() + len(inside.rstrip()), rest.end(), is_whole)


def element_range(element: Element) -> tuple[int, int] | None:
    """Return the character offsets of an element's ``<`` and after its last ``>``.

    The result is None for an element created by a program.
    """
    tag = start_tag_of(element)
    if element.source is None or tag is None:
        return None
    text, end = element.source.text, tag.end
    depth = 0 if tag.is_whole else 1
    while depth:
        found = _MARKUP.search(text, end)
        if found is None:
            return None
        end = found.end()
        if found[0] == "<":
            rest = _START_TAG_REST.match(text, end)
            if rest is None:
                return None
            end = rest.end()
            depth += not rest[0].endswith("/>")
        elif found[0].startswith("</"):
            depth -= 1
    return element.offset, end


def whole_lines(text: str, start: int, end: int) -> tuple[int, int]:
    """Return a range extended to complete lines, unless the lines have other content."""
    line_start = text.rfind("\n", 0, start) + 1
    line_end = text.find("\n", end)
    line_end = len(text) if line_end < 0 else line_end + 1
    alone = not text[line_start:start].strip() and not text[end:line_end].strip()
    return (line_start, line_end) if alone else (start, end)


def block(element: Element, indent: str = "", step: str = _STEP, newline: str = "\n") -> str:
    """Return the text of an element for insertion into a file, without a final line ending.

    Args:
        element: an element created by a program, which contains either elements or text.
        indent: the indentation of each line except the first.
        step: the additional indentation of the children.
        newline: the line ending.
    """
    opening = element.tag + "".join(f' {name}="{escaped(value)}"' for name, value in element.attributes.items())
    children = list(element.elements())
    if not children:
        text = element.text()
        return f"<{opening}>{escaped(text)}</{element.tag}>" if text else f"<{opening}/>"
    inner = indent + step
    lines = [f"<{opening}>", *(inner + block(child, inner, step, newline) for child in children)]
    return newline.join([*lines, f"{indent}</{element.tag}>"])


def inserted(
    owner: Element, new: Sequence[Element], *, after: Element | None = None, first: bool = False
) -> Replacement | None:
    """Return the replacement that inserts elements into an element with matching indentation.

    Args:
        owner: the element in a file that receives the new elements.
        new: the new elements, created by a program.
        after: the child of the owner after which they are inserted, or None for the end.
        first: whether they are inserted before all children, if `after` is None.

    Returns:
        The replacement, or None if the owner is not written in the file.
    """
    found = element_range(owner)
    tag = start_tag_of(owner)
    if found is None or tag is None or owner.source is None:
        return None
    text, (start, end) = owner.source.text, found
    newline, outer = newline_of(text), _blanks(text, start)
    child = next(owner.elements(), None)
    inner = outer + _STEP if child is None else _blanks(text, child.offset)
    in_line = child is not None and "\n" not in text[start : child.offset]
    if in_line:
        inner = outer + _STEP
    step = inner.removeprefix(outer) if inner.startswith(outer) and inner != outer else _STEP
    if tag.is_whole:
        lines = newline.join(inner + block(element, inner, step, newline) for element in new)
        return Replacement(tag.room, end, f">{newline}{lines}{newline}{outer}</{owner.tag}>")
    behind = element_range(after) if after is not None else None
    if in_line and not any(True for element in new for _ in element.elements()):
        at = behind[1] if behind else tag.end if first else text.rindex("</", start, end)
        return Replacement(at, at, "".join(block(element) for element in new))
    lines = newline.join(inner + block(element, inner, step, newline) for element in new)
    if behind is not None:
        return Replacement(behind[1], behind[1], f"{newline}{lines}")
    if first and child is not None:
        if in_line:
            return Replacement(tag.end, tag.end, f"{newline}{lines}{newline}{inner}")
        return Replacement(child.offset, child.offset, f"{lines.removeprefix(inner)}{newline}{inner}")
    closing = text.rindex("</", start, end)
    line = text.rfind("\n", 0, closing) + 1
    if line > start and not text[line:closing].strip():
        return Replacement(line, line, f"{lines}{newline}")
    return Replacement(closing, closing, f"{newline}{lines}{newline}{outer}")


def _blanks(text: str, offset: int) -> str:
    """Return the blanks at the beginning of the line that contains an offset."""
    line = text[text.rfind("\n", 0, offset) + 1 : offset]
    return line[: len(line) - len(line.lstrip())]
