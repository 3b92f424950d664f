"""Parsing XML as the simulators' parser (TinyXML2) does, which accepts more than XML allows.

tinyxml2 knows no namespaces and ends a comment at ``-->`` alone; blanks and comments before the XML declaration, an
``&`` that begins no entity and bytes that are no UTF-8 do not trouble it either. Such files work for their users, so
they are read, with a warning.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, SourceText, phrase
from linkwright.xmltree import Comment, Document, Element, parse
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.nodes import Node, Text

_UNDECLARED, _EMPTY, _NOT_TEXT = "XML205", "XML105", "XML104"
_OUTSIDE_TAGS = re.compile(r"<!--(.*?)-->|<!\[CDATA\[.*?\]\]>", re.DOTALL)
_BARE_AMPERSAND = re.compile(r"&(?!(?:#[0-9]+|#x[0-9a-fA-F]+|[A-Za-z_][\w.-]*);)")
_STAND_IN = "\x7f"
"""The replacement of an ``&`` that begins no entity; as long, and allowed."""
_LATE_DECLARATION = re.compile(r"(?:\s|<!--.*?-->)+(<\?xml\s[^>]*\?>)", re.DOTALL)


def parse_as_gazebo(text: str | bytes, name: str) -> tuple[Document, tuple[Diagnostic, ...]]:
    """Parse a text as Gazebo does, with a warning for each kind of thing that XML forbids.

    Raises:
        LinkwrightError: it is not XML (XML###).
    """
    warnings: list[Diagnostic] = []
    if isinstance(text, bytes):
        text, warnings = _decoded(text, name)
    source = SourceText(name, text)
    read_as = text
    late = _LATE_DECLARATION.match(text)
    if late:
        message = phrase("the XML declaration '<?xml' must be the very first thing in the file")
        warnings.append(_forbidden(message, source, late.start(1), 5))
        read_as = read_as[: late.start(1)] + re.sub(r"\S", " ", late[1]) + read_as[late.end(1) :]
    dashed = [found for found in _OUTSIDE_TAGS.finditer(text) if _has_dashes(found[1])]
    if dashed:
        at = text.index("--", dashed[0].start(1))
        warnings.append(_forbidden(phrase("'--' is not allowed inside a comment"), source, at, 2))
        for found in dashed:
            read_as = read_as[: found.start(1)] + found[1].replace("-", "=") + read_as[found.end(1) :]
    bare = [each.start() for each in _BARE_AMPERSAND.finditer(_tags_alone(text))]
    if bare and _STAND_IN not in text:
        warnings.append(_forbidden(phrase("'&' does not begin an entity"), source, bare[0], 1))
        for at in bare:
            read_as = read_as[:at] + _STAND_IN + read_as[at + 1 :]
    document, undeclared = _parsed(text, name, read_as)
    if bare:
        _put_back(document.root)
    for comment in _comments(document) if dashed else ():
        comment.data = text[comment.offset + 4 : text.index("-->", comment.offset + 4)]
    return document, (*warnings, *undeclared)


def _decoded(data: bytes, name: str) -> tuple[str, list[Diagnostic]]:
    """Decode the text of a file; bytes that are invalid in its encoding are taken for Latin-1."""
    try:
        return decode(data, name), []
    except LinkwrightError as error:
        found = error.diagnostics[0]
        if found.code != _NOT_TEXT or b"\0" in data:
            raise
        hint = phrase("it is read as Latin-1; save the file as UTF-8")
        return data.decode("latin-1"), [replace(found, severity=Severity.WARNING, hint=hint)]


def _tags_alone(text: str) -> str:
    """The text with comments and CDATA blanked."""
    return _OUTSIDE_TAGS.sub(lambda found: " " * len(found[0]), text)


def _put_back(root: Element) -> None:
    """Restore each ``&`` that was replaced by another character."""
    for element in root.walk():
        for name, value in element.attributes.items():
            element.attributes[name] = value.replace(_STAND_IN, "&")
        for child in element.children:
            if isinstance(child, Text):
                child.data = child.data.replace(_STAND_IN, "&")


def _parsed(text: str, name: str, read_as: str) -> tuple[Document, tuple[Diagnostic, ...]]:
    try:
        return parse(text, name, blanks=False, read_as=read_as), ()
    except LinkwrightError as error:
        found = error.diagnostics[0]
        if found.code == _EMPTY:
            hint = phrase('a world begins with <sdf version="...">; was the file saved?')
            raise LinkwrightError(replace(found, hint=hint)) from None
        if found.code != _UNDECLARED:
            raise
        document = parse(text, name, blanks=False, read_as=read_as, any_prefix=True)
        return document, (replace(found, severity=Severity.WARNING),)


def _has_dashes(comment: str | None) -> bool:
    """Whether XML forbids the content of a comment; None stands for other parts."""
    return comment is not None and ("--" in comment or comment.endswith("-"))


def _comments(document: Document) -> Iterator[Comment]:
    nodes: list[Node] = [*document.prolog, document.root, *document.epilog]
    while nodes:
        node = nodes.pop()
        if isinstance(node, Comment):
            yield node
        elif isinstance(node, Element):
            nodes.extend(node.children)


def _forbidden(message: Phrase, source: SourceText, at: int, length: int) -> Diagnostic:
    hint = phrase("simulators read it all the same; other XML readers refuse the file")
    return Diagnostic("XML206", message, source.span(at, at + length), Severity.WARNING, hint=hint, source=source)
