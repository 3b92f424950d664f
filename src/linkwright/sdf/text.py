"""XML text as the simulators' parser takes it, which is not quite as XML says.

tinyxml2 knows no namespaces and ends a comment at ``-->`` alone; blanks and comments before the XML declaration do not
trouble it either. Such files work for their users, so they are read, with a warning.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, SourceText, phrase
from linkwright.xmltree import Comment, Document, Element, parse
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.nodes import Node

_UNDECLARED, _EMPTY = "XML205", "XML105"
_OUTSIDE_TAGS = re.compile(r"<!--(.*?)-->|<!\[CDATA\[.*?\]\]>", re.DOTALL)
_LATE_DECLARATION = re.compile(r"(?:\s|<!--.*?-->)+(<\?xml\s[^>]*\?>)", re.DOTALL)


def parse_as_gazebo(text: str | bytes, name: str) -> tuple[Document, tuple[Diagnostic, ...]]:
    """Read a text as Gazebo does, with a warning for each kind of thing that XML forbids.

    Raises:
        LinkwrightError: it is not XML (XML###).
    """
    if isinstance(text, bytes):
        text = decode(text, name)
    source = SourceText(name, text)
    warnings: list[Diagnostic] = []
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
    document, undeclared = _parsed(text, name, read_as)
    for comment in _comments(document) if dashed else ():
        comment.data = text[comment.offset + 4 : text.index("-->", comment.offset + 4)]
    return document, (*warnings, *undeclared)


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
    """Whether XML forbids the inside of a comment; None stands for what is no comment."""
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
