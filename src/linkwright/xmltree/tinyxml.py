"""Parsing XML as TinyXML2 does, the parser of urdfdom and the simulators, which accepts more than XML allows.

It knows no namespaces, ends a comment at ``-->`` alone, passes over text before the root element and over elements
after it, reads nothing after a closing tag that closes nothing, and an ``&`` that begins no entity does not trouble it.
Nor do a ``<`` in a value, attributes without a blank between, control characters, and a second XML declaration right
after the first. Such files work for their users, so they are read, with a warning.
"""

from __future__ import annotations

import re
from xml.parsers.expat import ExpatError, ParserCreate
from xml.parsers.expat.errors import XML_ERROR_TAG_MISMATCH, codes

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, Severity, SourceText, Span, phrase
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_patterns import lazy_pattern
from linkwright.xmltree.nodes import Document
from linkwright.xmltree.reader import parse
from linkwright.xmltree.stand_ins import REPAIRS, can_stand_in, put_back, stand_in, tags_alone

_UNDECLARED, _AFTER_ROOT, _NOT_XML = "XML205", "XML207", "XML206"
_OUTSIDE_TAGS = lazy_pattern(r"<!--(.*?)-->|<!\[CDATA\[.*?\]\]>", re.DOTALL)
COMMENT = "<!--[^-]*(?:-(?!->)[^-]*)*-->"
"""The pattern of one comment; with ``.*?`` one of several may also end at a later one, in exponentially many ways."""
_BEFORE_ROOT = lazy_pattern(rf"\A(?:\s*<\?xml\s[^>]*\?>)?(?:\s|{COMMENT})*([^<\s][^<]*)(?=<(?!\?xml\s))")
"""Text before the root element; a declaration that follows it is one mistake too many for TinyXML2, too."""
_SECOND_DECLARATION = lazy_pattern(r"\s*<\?xml\s[^>]*\?>\s*(?=(<\?xml\s[^>]*\?>))")
_BARE_AMPERSAND = lazy_pattern(r"&(?!(?:#[0-9]+|#x[0-9a-fA-F]+|amp|lt|gt|quot|apos);)")
_DEFINITION = "<!ENTITY"


def parse_as_tinyxml(
    text: str, name: str, readers: Phrase, *, read_as: str | None = None
) -> tuple[Document, tuple[Diagnostic, ...]]:
    """Parse a text as TinyXML2 does, with a warning (XML205 to XML207) for each kind of mistake that XML forbids.

    Args:
        text: the text.
        name: of the file, for messages.
        readers: which programs read the file all the same, and which do not.
        read_as: the text to read instead, with everything in the same place.

    Raises:
        LinkwrightError: it is not XML for TinyXML2 either (XML###).
    """
    warnings: list[Diagnostic] = []
    source = SourceText(name, text)
    read_as = text if read_as is None else read_as
    for forgive in (_text_before_root, _second_declaration, _dashes, _ampersands):
        read_as, mistake = forgive(source, read_as)
        if mistake:
            warnings.append(forbidden(mistake.message, mistake.span, source, mistake.hint, readers))
    document, more = _parsed(source, read_as, readers)
    if warnings or more:
        put_back(document, text)
    return document, (*warnings, *more)


class _Mistake(NamedTuple):
    message: Phrase
    span: Span
    hint: Phrase


def _text_before_root(source: SourceText, read_as: str) -> tuple[str, _Mistake | None]:
    before = _BEFORE_ROOT.match(source.text)
    if before is None:
        return read_as, None
    place = source.span(before.start(1), before.start(1) + len(before[1].rstrip()))
    advice = phrase("an XML file may have only comments before its root element")
    return _without(read_as, before), _Mistake(phrase("there is text before the root element"), place, advice)


def _second_declaration(source: SourceText, read_as: str) -> tuple[str, _Mistake | None]:
    second = _SECOND_DECLARATION.match(source.text)
    if second is None:
        return read_as, None
    place = source.span(second.start(1), second.start(1) + len("<?xml"))
    message = phrase("a second XML declaration follows the first")
    return _without(read_as, second), _Mistake(message, place, phrase("remove it"))


def _dashes(source: SourceText, read_as: str) -> tuple[str, _Mistake | None]:
    text = source.text
    dashed = [found for found in _OUTSIDE_TAGS.finditer(text) if _has_dashes(found[1])]
    if not dashed:
        return read_as, None
    for found in dashed:
        read_as = read_as[: found.start(1)] + found[1].replace("-", "=") + read_as[found.end(1) :]
    at = text.index("--", dashed[0].start(1))
    message = phrase("'--' is not allowed inside a comment")
    return read_as, _Mistake(message, source.span(at, at + 2), phrase("use other characters, such as '=='"))


def _ampersands(source: SourceText, read_as: str) -> tuple[str, _Mistake | None]:
    text = source.text
    if not can_stand_in(text) or _DEFINITION in text:
        return read_as, None
    bare = [match.start() for match in _BARE_AMPERSAND.finditer(tags_alone(text))]
    if not bare:
        return read_as, None
    for at in bare:
        read_as = read_as[:at] + stand_in("&") + read_as[at + 1 :]
    place = source.span(bare[0], bare[0] + 1)
    return read_as, _Mistake(
        phrase("'&' does not begin an entity"), place, phrase("write '&amp;' for the character '&'")
    )


def _without(text: str, match: re.Match[str]) -> str:
    """The text with the first group of a match blanked."""
    return text[: match.start(1)] + blanked(match[1]) + text[match.end(1) :]


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
        first = error.diagnostics[0]
        if first.code == _UNDECLARED:
            document = parse(source.text, source.name, blanks=False, read_as=read_as, any_prefix=True)
            return document, (first.but(severity=Severity.WARNING),)
        end = _end_of_root(first, read_as)
        if end is not None and _is_passed_over(read_as[end:]):
            warning, read_as = _passed_over(source, end, readers), read_as[:end] + blanked(read_as[end:])
        else:
            warning, read_as = (
                first.but(severity=Severity.WARNING, notes=(Note(readers),)),
                _repaired(source, error, read_as),
            )
        try:
            document, more = _parsed(source, read_as, readers)
        except LinkwrightError:
            raise error from None
        if warning.code == _AFTER_ROOT and any(diagnostic.code == _AFTER_ROOT for diagnostic in more):
            return document, more
        return document, (warning, *more)


def _repaired(source: SourceText, error: LinkwrightError, text: str) -> str:
    """The text with all mistakes of the error's kind replaced; the error, where TinyXML2 has one there, too."""
    diagnostic = error.diagnostics[0]
    if diagnostic.code == _NOT_XML and diagnostic.span is not None and can_stand_in(source.text):
        at = source.offset(diagnostic.span.line, diagnostic.span.column)
        for repair in REPAIRS:
            repaired = repair(text, at)
            if repaired != text:
                return repaired
    raise error


def _passed_over(source: SourceText, end: int, readers: Phrase) -> Diagnostic:
    """The warning about content after the root."""
    message = phrase("there is content after the end of the root element")
    hint = phrase("a file has one root element")
    return Diagnostic(_AFTER_ROOT, message, source.span(end, end + 1), Severity.WARNING, (Note(readers),), hint, source)


def _end_of_root(diagnostic: Diagnostic, text: str) -> int | None:
    """Where the content after the root may begin, by the error that it causes."""
    if diagnostic.span is None or diagnostic.source is None:
        return None
    at = diagnostic.source.offset(diagnostic.span.line, diagnostic.span.column)
    return at if diagnostic.code == _AFTER_ROOT or (diagnostic.code == _NOT_XML and text.startswith("</", at)) else None


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


def _has_dashes(comment: str | None) -> bool:
    """Whether XML forbids the content of a comment; pass None for other nodes."""
    return comment is not None and ("--" in comment or comment.endswith("-"))
