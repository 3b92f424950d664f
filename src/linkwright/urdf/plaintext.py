"""XML text as urdfdom's parser reads it, which differs from the XML standard.

tinyxml2 preserves tabs and line breaks inside attribute values, whereas XML converts them to spaces. urdfdom does not
accept tabs and line breaks between numbers. tinyxml2 also accepts whitespace before the XML declaration, and the
mistakes that `linkwright.xmltree.tinyxml` lists.
"""

from __future__ import annotations

import re

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.loading.deferred import lazy_pattern
from linkwright.xmltree import Document, Element, parse
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.positions import attribute_value_range

_READ_ANYWAY = phrase("urdfdom reads it anyway, but xacro and other XML readers reject the file")
_LATE_DECLARATION = lazy_pattern(r"\s+<\?xml\s[^>]*\?>")
# Each pattern matches a blank that a number or the end of the value follows; in other values, blanks do not matter. A
# pattern starts with a fixed character, which makes the search ten times as fast as one pattern for all three.
_INSIDE_VALUE = {blank: lazy_pattern(rf"""{blank}[-+0-9eE. ]*["']""") for blank in "\n\t\r"}


def parse_as_urdfdom(text: str | bytes, name: str) -> tuple[Document, tuple[Diagnostic, ...]]:
    """Parse a URDF text, preserving the whitespace in its attribute values.

    Returns:
        The document, and a warning for each kind of construct that XML forbids and urdfdom accepts.

    Raises:
        LinkwrightError: if urdfdom does not accept the text either (XML###).
    """
    if isinstance(text, bytes):
        text = decode(text, name)
    late_declaration = _LATE_DECLARATION.match(text)
    if late_declaration:
        from linkwright.xmltree.tinyxml import blank_out

        text = blank_out(late_declaration[0]) + text[late_declaration.end() :]
    warnings: tuple[Diagnostic, ...] = ()
    try:
        document = parse(text, name, blanks=False)
    except LinkwrightError as error:
        from linkwright.xmltree.tinyxml import parse_as_tinyxml

        try:
            document, warnings = parse_as_tinyxml(text, name, _READ_ANYWAY)
        except LinkwrightError:
            raise error from None
    if any(blank in text and pattern.search(text) for blank, pattern in _INSIDE_VALUE.items()):
        _restore_blanks(document.root, text)
    return document, warnings


def _restore_blanks(root: Element, text: str) -> None:
    for element in root.walk():
        for attribute in element.attributes:
            value_range = attribute_value_range(text, element.offset, attribute)
            if value_range is None:
                continue
            raw_value = text[slice(*value_range)]
            if "&" not in raw_value and any(blank in raw_value for blank in "\t\r\n"):
                element.attributes[attribute] = re.sub(r"\r\n?", "\n", raw_value)
