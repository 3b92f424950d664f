"""Parses XML as the simulators do, whose parser (TinyXML2) accepts more than XML allows.

The simulators also accept whitespace and comments before the XML declaration, and bytes that are not UTF-8.
"""

from __future__ import annotations

import re

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, SourceText, phrase
from linkwright.xmltree import Document
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.tinyxml import COMMENT, forbidden, parse_as_tinyxml

_EMPTY, _NOT_TEXT, _NOT_XML = "XML105", "XML104", "XML206"
_LATE_DECLARATION = re.compile(rf"(?:\s|{COMMENT})+(<\?xml\s[^>]*\?>)")
_READ_ALL_THE_SAME = phrase("simulators read it anyway, but other XML readers reject the file")


def parse_as_gazebo(text: str | bytes, name: str) -> tuple[Document, tuple[Diagnostic, ...]]:
    """Parse a text as Gazebo does, and report each kind of text that XML forbids.

    An error that does not change the content, such as dashes in a comment, is reported as information, because only
    simulators read these files.

    Raises:
        LinkwrightError: the text is not XML, even for Gazebo (XML###).
    """
    warnings: list[Diagnostic] = []
    if isinstance(text, bytes):
        text, warnings = _decoded(text, name)
    read_as = text
    late = _LATE_DECLARATION.match(text)
    if late:
        message = phrase("the XML declaration '<?xml' must be the very first thing in the file")
        source = SourceText(name, text)
        span = source.span(late.start(1), late.start(1) + len("<?xml"))
        warnings.append(forbidden(message, span, source, phrase("remove everything before it"), _READ_ALL_THE_SAME))
        read_as = read_as[: late.start(1)] + re.sub(r"\S", " ", late[1]) + read_as[late.end(1) :]
    try:
        document, more = parse_as_tinyxml(text, name, _READ_ALL_THE_SAME, read_as=read_as)
    except LinkwrightError as error:
        found = error.diagnostics[0]
        if found.code != _EMPTY:
            raise
        hint = phrase('a world begins with <sdf version="...">; was the file saved?')
        raise LinkwrightError(found.with_changes(hint=hint)) from None
    findings = (*warnings, *more)
    return document, tuple(
        diagnostic.with_changes(severity=Severity.INFO) if diagnostic.code == _NOT_XML else diagnostic
        for diagnostic in findings
    )


def _decoded(data: bytes, name: str) -> tuple[str, list[Diagnostic]]:
    """Return the text of a file, and findings.

    If the bytes are invalid in the encoding of the file, the text is decoded as Latin-1, with a warning.
    """
    try:
        return decode(data, name), []
    except LinkwrightError as error:
        found = error.diagnostics[0]
        if found.code != _NOT_TEXT or b"\0" in data:
            raise
        hint = phrase("it is read as Latin-1; save the file as UTF-8")
        return data.decode("latin-1"), [found.with_changes(severity=Severity.WARNING, hint=hint)]
