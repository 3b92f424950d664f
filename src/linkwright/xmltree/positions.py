"""The positions of names and values inside a start tag.

The tree only stores the offset of each ``<``. Positions inside a tag are found by scanning the tag again, which is only
done for the few locations that a message or the viewer needs.
"""

from __future__ import annotations

import re

from linkwright.loading.deferred import lazy_pattern

_TAG_NAME = lazy_pattern(r"<[^\s/>]+")
_ATTRIBUTE = lazy_pattern(r"""\s*([^\s=/>"']+)\s*=\s*("[^"]*"|'[^']*')""")
_START_TAG = lazy_pattern(r"""<(?:[^"'>]|"[^"]*"|'[^']*')*>""")
_CHARACTER = lazy_pattern(r"&[^;&<]*;|\r\n?|.", re.DOTALL)


def attribute_value_range(text: str, offset: int, name: str) -> tuple[int, int] | None:
    """Return the character offsets of an attribute's value, without its quotes.

    Args:
        text: the whole source text.
        offset: the character offset of the start tag's ``<``.
        name: the attribute's name as written.

    Returns:
        The start and end (exclusive), or None if the tag does not have the attribute.
    """
    ranges = _find_attributes(text, offset).get(name)
    return ranges and ranges[1]


def attribute_name_range(text: str, offset: int, name: str) -> tuple[int, int] | None:
    """Return the character offsets of an attribute's name, or None if the attribute is absent.

    `offset` is the character offset of the start tag's ``<``.
    """
    attribute = _find_attributes(text, offset).get(name)
    return attribute and attribute[0]


def find_start_tag_end(text: str, offset: int) -> int:
    """Return the offset after the start tag whose ``<`` is at an offset of a well-formed text."""
    match = _START_TAG.match(text, offset)
    assert match is not None, "the text was parsed"
    return match.end()


_Ranges = dict[str, tuple[tuple[int, int], tuple[int, int]]]
_read_last: tuple[str, int, _Ranges] = ("", -1, {})
"""The last tag that was read, because callers often need several attributes of one tag."""


def _find_attributes(text: str, offset: int) -> _Ranges:
    """Return the ranges of each attribute's name and value in a start tag, by name.

    `offset` is the offset of the start tag's ``<``.
    """
    global _read_last  # noqa: PLW0603 - one tuple, so that threads see it whole
    last_text, last_offset, ranges = _read_last
    if last_text is text and last_offset == offset:
        return ranges
    ranges = {}
    match = _TAG_NAME.match(text, offset)
    while match is not None:
        match = _ATTRIBUTE.match(text, match.end())
        if match is not None:
            ranges.setdefault(match[1], (match.span(1), (match.start(2) + 1, match.end(2) - 1)))
    _read_last = (text, offset, ranges)
    return ranges


def find_raw_offset(text: str, start: int, end: int, index: int) -> int:
    """Return the offset in the source of the character at an index of a parsed value.

    The parsed value may be shorter than its source: an entity such as ``&lt;`` becomes one character, and a Windows
    line ending of two characters also becomes one.

    Args:
        text: the complete source text.
        start: the offset of the value in the source.
        end: the offset after the value in the source.
        index: the index of the character in the parsed value.
    """
    position = start
    for _ in range(index):
        character = _CHARACTER.match(text, position, end)
        if character is None:
            return end
        position = character.end()
    return position
