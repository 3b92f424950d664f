"""Parsing XML as TinyXML2 does, the parser of urdfdom and the simulators, which accepts more than XML allows.

It knows no namespaces, ends a comment at ``-->`` alone, passes over text before the root element and over elements
after it, reads nothing after a closing tag that closes nothing, and an ``&`` that begins no entity does not trouble it.
Such files work for their users, so they are read, with a warning.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from xml.parsers.expat import ExpatError, ParserCreate
from xml.parsers.expat.errors import XML_ERROR_TAG_MISMATCH, codes

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, Severity, SourceText, Span, phrase
from linkwright.xmltree.nodes import Comment, Document, Element, Node, Text
from linkwright.xmltree.reader import parse

_UNDECLARED, _AFTER_ROOT, _NOT_XML = "XML205", "XML207", "XML206"
_OUTSIDE_TAGS = re.compile(r"<!--(.*?)-->|<!\[CDATA\[.*?\]\]>", re.DOTALL)
COMMENT = "<!--[^-]*(?:-(?!->)[^-]*)*-->"
"""The pattern of one comment; with ``.*?`` one of several may also end at a later one, in exponentially many ways."""
_BEFORE_ROOT = re.compile(rf"\A(?:\s*<\?xml\s[^>]*\?>)?(?:\s|{COMMENT})*([^<\s][^<]*)(?=<(?!\?xml\s))")
"""Text before the root element; a declaration that follows it is one mistake too many for TinyXML2, too."""
_BARE_AMPERSAND = re.compile(r"&(?!(?:#[0-9]+|#x[0-9a-fA-F]+|amp|lt|gt|quot|apos);)")
_DEFINITION = "<!ENTITY"
_STAND_IN = "\x7f"
"""The replacement of an ``&`` that begins no entity; as long, and allowed."""


def parse_as_tinyxml(
    text: str, name: str, readers: Phrase, *, read_as: str | None = None
) -> tuple[Document, tuple[Diagnostic, ...]]:
    """Parse a text as TinyXML2 does, with a warning (XML205 to XML207) for each kind of thing that XML forbids.

    Args:
        text: the text.
        name: of the file, for messages.
        readers: who reads the file all the same, and who does not.
        read_as: what to read in place of the text, with everything in the same place.

    Raises:
        LinkwrightError: it is not XML for TinyXML2 either (XML###).
    """
    warnings: list[Diagnostic] = []
    source = SourceText(name, text)
    read_as = text if read_as is None else read_as
    before = _BEFORE_ROOT.match(text)
    if before:
        advice = phrase("an XML file holds nothing but comments before its root element")
        place = source.span(before.start(1), before.start(1) + len(before[1].rstrip()))
        message = phrase("text stands before the root element")
        warnings.append(forbidden(message, place, source, advice, readers))
        read_as = read_as[: before.start(1)] + blanked(before[1]) + read_as[before.end(1) :]
    dashed = [found for found in _OUTSIDE_TAGS.finditer(text) if _has_dashes(found[1])]
    if dashed:
        at = text.index("--", dashed[0].start(1))
        advice = phrase("use other characters, such as '=='")
        warnings.append(
            forbidden(phrase("'--' is not allowed inside a comment"), source.span(at, at + 2), source, advice, readers)
        )
        for found in dashed:
            read_as = read_as[: found.start(1)] + found[1].replace("-", "=") + read_as[found.end(1) :]
    bare = []
    if _STAND_IN not in text and _DEFINITION not in text:
        bare = [each.start() for each in _BARE_AMPERSAND.finditer(_tags_alone(text))]
    if bare:
        advice = phrase("write '&amp;' for the character '&'")
        warnings.append(
            forbidden(
                phrase("'&' does not begin an entity"), source.span(bare[0], bare[0] + 1), source, advice, readers
            )
        )
        for at in bare:
            read_as = read_as[:at] + _STAND_IN + read_as[at + 1 :]
    document, more = _parsed(source, read_as, readers)
    if bare:
        _put_back(document.root)
    for comment in _comments(document) if dashed else ():
        comment.data = text[comment.offset + 4 : text.index("-->", comment.offset + 4)]
    return document, (*warnings, *more)


def blanked(text: str) -> str:
    """As many blanks, in as many lines, so that places stay right."""
    return re.sub(r"\S", " ", text)


def forbidden(message: Phrase, span: Span, source: SourceText, hint: Phrase, readers: Phrase) -> Diagnostic:
    """Return a warning about something that XML forbids and TinyXML2 accepts."""
    return Diagnostic("XML206", message, span, Severity.WARNING, (Note(readers),), hint, source)


def _parsed(source: SourceText, read_as: str, readers: Phrase) -> tuple[Document, tuple[Diagnostic, ...]]:
    try:
        return parse(source.text, source.name, blanks=False, read_as=read_as), ()
    except LinkwrightError as error:
        found = error.diagnostics[0]
        if found.code == _UNDECLARED:
            document = parse(source.text, source.name, blanks=False, read_as=read_as, any_prefix=True)
            return document, (replace(found, severity=Severity.WARNING),)
        end = _end_of_root(found, read_as)
        if end is None or not _is_passed_over(read_as[end:]):
            raise
        try:
            document, more = _parsed(source, read_as[:end] + blanked(read_as[end:]), readers)
        except LinkwrightError:
            raise error from None
        if all(each.code != _AFTER_ROOT for each in more):
            more = (_passed_over(source, end, readers), *more)
        return document, more


def _passed_over(source: SourceText, end: int, readers: Phrase) -> Diagnostic:
    """The warning about what follows the root."""
    message = phrase("there is content after the end of the root element")
    hint = phrase("a file has one root element")
    return Diagnostic(_AFTER_ROOT, message, source.span(end, end + 1), Severity.WARNING, (Note(readers),), hint, source)


def _end_of_root(found: Diagnostic, text: str) -> int | None:
    """Where the content after the root may begin, by the error that it makes."""
    if found.span is None or found.source is None:
        return None
    at = found.source.offset(found.span.line, found.span.column)
    return at if found.code == _AFTER_ROOT or (found.code == _NOT_XML and text.startswith("</", at)) else None


def _is_passed_over(rest: str) -> bool:
    """Whether elements after the root are whole, up to a closing tag that closes nothing."""
    parser = ParserCreate()
    depth = 0

    def opened(*_: object) -> None:
        nonlocal depth
        depth += 1

    def closed(*_: object) -> None:
        nonlocal depth
        depth -= 1

    parser.StartElementHandler, parser.EndElementHandler = opened, closed
    try:
        parser.Parse(f"<rest>{rest}</rest>", True)
    except ExpatError as error:
        return depth == 1 and error.code == codes[XML_ERROR_TAG_MISMATCH]
    return True


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
