"""Parse XML as in the simulators.

Their parser, TinyXML2, accepts more than XML allows.

For example, it accepts whitespace and comments before the XML declaration, and bytes that are not UTF-8.
"""

from __future__ import annotations

import re

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, SourceText, phrase
from linkwright.xmltree import Document
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.tinyxml import COMMENT, make_forbidden_warning, parse_as_tinyxml

_EMPTY_CODE, _NOT_TEXT_CODE, _NOT_XML_CODE = "XML105", "XML104", "XML206"
_LATE_DECLARATION = re.compile(rf"(?:\s|{COMMENT})+(<\?xml\s[^>]*\?>)")
_TOLERATED_BY_SIMULATORS = phrase("simulators accept this, but other XML readers reject the file")


def parse_as_gazebo(text: str | bytes, name: str) -> tuple[Document, tuple[Diagnostic, ...]]:
    """Parse a text as Gazebo does, and report each kind of XML error that Gazebo tolerates.

    An error that does not change the content, such as two dashes in a comment, is reported as information, because only
    simulators read these files.

    Raises:
        LinkwrightError: the text is not XML, even for Gazebo (XML###).
    """
    warnings: list[Diagnostic] = []
    if isinstance(text, bytes):
        text, warnings = _decode_tolerantly(text, name)
    corrected_text = text
    late_declaration = _LATE_DECLARATION.match(text)
    if late_declaration:
        message = phrase("the XML declaration '<?xml' must be at the very start of the file")
        source = SourceText(name, text)
        span = source.span(late_declaration.start(1), late_declaration.start(1) + len("<?xml"))
        warnings.append(
            make_forbidden_warning(
                message, span, source, phrase("remove everything before it"), _TOLERATED_BY_SIMULATORS
            )
        )
        corrected_text = (
            corrected_text[: late_declaration.start(1)]
            + re.sub(r"\S", " ", late_declaration[1])
            + corrected_text[late_declaration.end(1) :]
        )
    try:
        document, parser_warnings = parse_as_tinyxml(text, name, _TOLERATED_BY_SIMULATORS, read_as=corrected_text)
    except LinkwrightError as error:
        diagnostic = error.diagnostics[0]
        if diagnostic.code != _EMPTY_CODE:
            raise
        hint = phrase('a world begins with <sdf version="...">; was the file saved?')
        raise LinkwrightError(diagnostic.with_changes(hint=hint)) from None
    findings = (*warnings, *parser_warnings)
    return document, tuple(
        diagnostic.with_changes(severity=Severity.INFO) if diagnostic.code == _NOT_XML_CODE else diagnostic
        for diagnostic in findings
    )


def _decode_tolerantly(data: bytes, name: str) -> tuple[str, list[Diagnostic]]:
    """Decode the bytes of a file, and return the text and the findings.

    If the bytes are invalid in the file's encoding, they are decoded as Latin-1 with a warning.
    """
    try:
        return decode(data, name), []
    except LinkwrightError as error:
        diagnostic = error.diagnostics[0]
        if diagnostic.code != _NOT_TEXT_CODE or b"\0" in data:
            raise
        hint = phrase("save the file as UTF-8; it is read as Latin-1 until then")
        return data.decode("latin-1"), [diagnostic.with_changes(severity=Severity.WARNING, hint=hint)]
