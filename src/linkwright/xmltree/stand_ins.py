"""Characters in place of those that TinyXML2 accepts and expat refuses, as many as there were.

Each repair gets a text and the place of its first mistake. It returns the text with all mistakes of that kind replaced,
or unchanged if the mistake is of another kind. `put_back` then restores the original characters in the tree.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_patterns import lazy_pattern
from linkwright.xmltree.nodes import Comment, Document, Element, Node, Text

_PRIVATE = 0xE000
"""Where the characters begin that Unicode leaves to programs: XML allows them, and hardly a file has them."""
_CONTROLS = frozenset({*map(chr, range(1, 0x20))} - {*"\t\n\r"})
"""Without zero, which ends the text for TinyXML2."""
_BLANKS = "\v\f"
"""Control characters that are blanks for C, and for TinyXML2."""
_STAND_INS = {character: chr(_PRIVATE + ord(character)) for character in ("&", "<", *_CONTROLS)}
_WRITTEN = str.maketrans({there: character for character, there in _STAND_INS.items()})
_ANY = lazy_pattern(f"[{''.join(_STAND_INS.values())}]")
_OUTSIDE_TAGS = lazy_pattern(r"<!--.*?-->|<!\[CDATA\[.*?\]\]>", re.DOTALL)
_TAG = lazy_pattern(r"""<[^\W\d][^\s=/>"'<]*""")
_ATTRIBUTE = lazy_pattern(r"""(\s*)([^\s=/>"'<]+)\s*=\s*("[^"]*"|'[^']*')""", re.ASCII)


def stand_in(character: str) -> str:
    """The character that `put_back` turns into ``&``, ``<`` or a control character."""
    return _STAND_INS[character]


def can_stand_in(text: str) -> bool:
    """Whether a text has none of the replacement characters."""
    return _ANY.search(text) is None


def tags_alone(text: str) -> str:
    """The text with comments and CDATA blanked."""
    return _OUTSIDE_TAGS.sub(lambda found: " " * len(found[0]), text)


def _control_characters(text: str, at: int) -> str:
    if text[at : at + 1] not in _CONTROLS:
        return text
    return "".join(
        " " if character in _BLANKS else _STAND_INS[character] if character in _CONTROLS else character
        for character in text
    )


def _less_than_in_values(text: str, at: int) -> str:
    if text[at : at + 1] != "<":
        return text
    for value in _values(text):
        written = text[value.start : value.end]
        text = text[: value.start] + written.replace("<", _STAND_INS["<"]) + text[value.end :]
    return text


def _missing_blanks(text: str, at: int) -> str:
    """Blanks between attributes, each in the place of the last character of the value before it."""
    if text[at - 1 : at] not in ("'", '"'):
        return text
    for value in _crowded(text):
        if value.start == value.end or text[value.end - 1] == ";":
            return text  # there is no character, or it is the end of an entity
        text = text[: value.end - 1] + text[value.end] + " " + text[value.end + 1 :]
    return text


REPAIRS = (_control_characters, _less_than_in_values, _missing_blanks)


def put_back(document: Document, text: str) -> None:
    """Restore in a tree the characters that were replaced in its text."""
    shortened: dict[int, list[_Value]] = {}
    for value in _crowded(text):
        shortened.setdefault(value.tag, []).append(value)
    nodes: list[Node] = [*document.prolog, document.root, *document.epilog]
    while nodes:
        node = nodes.pop()
        if isinstance(node, Element):
            node.attributes = {name: value.translate(_WRITTEN) for name, value in node.attributes.items()}
            for value in shortened.get(node.offset, ()):
                node.attributes[value.name] += text[value.end - 1]
            nodes.extend(node.children)
        elif isinstance(node, Comment):
            node.data = text[node.offset + 4 : text.index("-->", node.offset + 4)]
        elif isinstance(node, Text):
            node.data = node.data.translate(_WRITTEN)


class _Value(NamedTuple):
    """The value of an attribute: where its tag begins, its name, and its place without its quotes."""

    tag: int
    name: str
    start: int
    end: int


def _values(text: str) -> Iterator[_Value]:
    return (value for value, _ in _with_blanks_before(text))


def _crowded(text: str) -> Iterator[_Value]:
    """The values that are followed by an attribute without a blank between."""
    last: _Value | None = None
    for value, blanks in _with_blanks_before(text):
        if last is not None and last.tag == value.tag and not blanks:
            yield last
        last = value


def _with_blanks_before(text: str) -> Iterator[tuple[_Value, str]]:
    markup = tags_alone(text)
    at = 0
    while tag := _TAG.search(markup, at):
        at = tag.end()
        while found := _ATTRIBUTE.match(markup, at):
            at = found.end()
            yield _Value(tag.start(), found[2], found.start(3) + 1, found.end(3) - 1), found[1]
