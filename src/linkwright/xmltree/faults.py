"""Error messages for texts that are not well-formed XML."""

from __future__ import annotations

import re
from xml.parsers.expat import ExpatError
from xml.parsers.expat import errors as expat_errors

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, SourceText, foreign, nearest, phrase
from linkwright.diagnostics.lookalikes import lookalike_hint
from linkwright.loading.deferred import lazy_pattern

_EXPAT_CODES = expat_errors.codes
_NO_ELEMENT = _EXPAT_CODES[expat_errors.XML_ERROR_NO_ELEMENTS]
_INVALID_TOKEN = _EXPAT_CODES[expat_errors.XML_ERROR_INVALID_TOKEN]
_UNCLOSED_TOKEN = _EXPAT_CODES[expat_errors.XML_ERROR_UNCLOSED_TOKEN]
_MISMATCH = _EXPAT_CODES[expat_errors.XML_ERROR_TAG_MISMATCH]
_DUPLICATE = _EXPAT_CODES[expat_errors.XML_ERROR_DUPLICATE_ATTRIBUTE]
_JUNK = _EXPAT_CODES[expat_errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT]
_UNDEFINED_ENTITY = _EXPAT_CODES[expat_errors.XML_ERROR_UNDEFINED_ENTITY]
_MISPLACED_DECLARATION = _EXPAT_CODES[expat_errors.XML_ERROR_MISPLACED_XML_PI]
_SYNTAX = _EXPAT_CODES[expat_errors.XML_ERROR_SYNTAX]
_UNCLOSED_CDATA = _EXPAT_CODES[expat_errors.XML_ERROR_UNCLOSED_CDATA_SECTION]

_CLOSING_TAG = lazy_pattern(r"</\s*([^\s>]*)\s*>?")
_BARE_ATTRIBUTE = lazy_pattern(r"([^\s=/>\"'<]+)\s*$")
_UNQUOTED = lazy_pattern(r"([^\s=/>\"'<]+)\s*=\s*$")
_UNCLOSED_QUOTE = lazy_pattern(r"""([^\s=/>"'<]+)\s*=\s*(["'])[^"'<>]*\s[^\s=/>"'<]+\s*=\s*\2$""")
"""A value that ends with the name of the next attribute, as in ``name="a type="``."""
_QUOTED = lazy_pattern(r""""[^"]*"|'[^']*'""")
_OPEN_QUOTE = lazy_pattern(r"""([^\s=/>"'<]+)\s*=\s*["']([^"']*)$""")
_LONE_AMPERSAND = lazy_pattern(r"&[^\s;&<>\"']*$")
_TEMPLATE_LANGUAGES = (
    (
        lazy_pattern(r"<%.*?%>", re.DOTALL),
        "ERB",
        phrase("run `erb TEMPLATE > FILE`, and pass that file"),
    ),
    (lazy_pattern(r"\{[%#].*?[%#]\}", re.DOTALL), "Jinja", phrase("render it with Jinja, and pass the rendered file")),
)
"""For each template language, a pattern for its tags, its name, and a hint."""
_DASHES_IN_COMMENT = lazy_pattern(r"<!--(?:(?!-->).)*--$", re.DOTALL)
_NAME = lazy_pattern(r"[^\s=/>\"'&;<]+")

_ANGLE_LOOKALIKES = ("\uff1c", "\u300a")
_CURVED_QUOTES = tuple("\u201c\u201d\u2018\u2019\u201e")
_SEARCH_LENGTH = 200
"""The number of characters before an error that are searched for its cause."""

_NAMESPACES = {"xacro": "http://www.ros.org/wiki/xacro", "xi": "http://www.w3.org/2001/XInclude"}
"""The namespaces of the prefixes that descriptions use."""
_AMPERSAND_HINT = phrase("write '&amp;' for the character '&'")
_AND_HINT = phrase("write 'and' in an expression, or '&amp;' for each '&'")
_MERGE_MARKER = "<<<<<<< "
"""The text at the start of a merge conflict that git writes into a file."""
_LESS_HINT = phrase("close the quotes of the attribute before it, or write '&lt;' for the character '<'")


def syntax_error(
    source: SourceText, error: ExpatError, offset: int, open_elements: list[tuple[str, int]]
) -> LinkwrightError:
    """Return the error for a syntax error that expat found.

    Args:
        source: the text being parsed.
        error: expat's error.
        offset: the character offset at which expat stopped.
        open_elements: the name and offset of each element that is not yet closed, outermost first.
    """
    return LinkwrightError(_FaultFinder(source, offset, open_elements).describe(error))


def undeclared_prefix_error(source: SourceText, offset: int, name: str) -> LinkwrightError:
    """Return the error for a name whose namespace prefix is not declared."""
    prefix, _, local_name = name.partition(":")
    similar = [] if prefix in _NAMESPACES else nearest(prefix, _NAMESPACES, 1)
    return LinkwrightError(
        Diagnostic(
            "XML205",
            phrase("the prefix '{prefix}' of '{name}' is not declared", prefix=prefix, name=name),
            span=source.span(offset, offset + len(name)),
            hint=phrase("did you mean '{name}'?", name=f"{similar[0]}:{local_name}")
            if similar
            else phrase(
                'declare it on the root element: xmlns:{prefix}="{addresses}"',
                prefix=prefix,
                addresses=_NAMESPACES.get(prefix, "..."),
            ),
            source=source,
        )
    )


def forbidden_entity_error(source: SourceText, offset: int, message: Phrase) -> LinkwrightError:
    """Return the error for an entity that would read another file or grow without bound."""
    return LinkwrightError(
        Diagnostic(
            "XML209",
            message,
            span=source.span(offset),
            hint=phrase("write the text itself in place of the entity"),
            source=source,
        )
    )


_FIRST_ELEMENTS = (
    ("package.xml", '<package format="3">'),
    (".srdf", '<robot name="...">'),
    (".urdf", '<robot name="...">'),
    (".xacro", '<robot name="...">'),
    (".sdf", '<sdf version="...">'),
    (".world", '<sdf version="...">'),
    (".launch", "<launch>"),
    ("launch.xml", "<launch>"),
    (".config", "<model>"),
)
"""The first elements of files, by the ends of their names."""


def _make_first_element_hint(name: str) -> Phrase:
    for end, element in _FIRST_ELEMENTS:
        if name.endswith(end):
            return phrase("such a file begins with {element}; was the file saved?", element=element)
    return phrase("was the file saved?")


class _FaultFinder:
    def __init__(self, source: SourceText, offset: int, open_elements: list[tuple[str, int]]) -> None:
        self._source = source
        self._text = source.text
        self._offset = min(offset, len(source.text))
        self._open = open_elements

    def describe(self, error: ExpatError) -> Diagnostic:
        code = error.code
        if not self._text.strip():
            message = phrase("'{name}' is empty", name=self._source.name)
            hint = _make_first_element_hint(self._source.name)
            return Diagnostic("XML105", message, span=self._source.span(0, 0), hint=hint, source=self._source)
        if template := self._template():
            return template
        if code == _MISMATCH:
            return self._mismatched_tag()
        if self._offset >= len(self._text.rstrip()) and code in (_NO_ELEMENT, _UNCLOSED_TOKEN) and self._open:
            return self._unclosed_fault()
        if code == _UNCLOSED_TOKEN:
            return self._unclosed_token()
        if code == _INVALID_TOKEN:
            return self._invalid_token()
        if code == _DUPLICATE:
            return self._duplicate_attribute()
        if code == _UNDEFINED_ENTITY:
            return self._undefined_entity()
        if code == _JUNK:
            return self._diagnostic(
                "XML207",
                phrase("there is content after the end of the root element"),
                hint=phrase("keep one root element: an XML file has exactly one"),
            )
        if code == _MISPLACED_DECLARATION:
            message = phrase("the XML declaration '<?xml' must be at the very start of the file")
            return self._diagnostic("XML206", message, 5, hint=phrase("remove everything before it"))
        if code == _NO_ELEMENT:
            return self._diagnostic(
                "XML206",
                phrase("there is no root element"),
                hint=phrase("add a root element, such as <robot name=...>"),
            )
        if code == _UNCLOSED_CDATA:
            start = self._text.rfind("<![CDATA[", 0, self._offset)
            return self._diagnostic(
                "XML203",
                phrase("this CDATA section is never closed"),
                9,
                offset=start,
                hint=phrase("close it with ']]>'"),
            )
        if code == _SYNTAX and self._open == []:
            return self._not_xml()
        return self._diagnostic("XML206", _translate_expat_message(error))

    def _template(self) -> Diagnostic | None:
        """Return the error for a template whose placeholders are not valid XML, or None."""
        for pattern, language, hint in _TEMPLATE_LANGUAGES:
            tag = pattern.search(self._text)
            if tag is not None and tag.start() <= self._offset:
                message = phrase("this is a {language} template, not XML", language=language)
                return self._diagnostic("XML206", message, len(tag[0].split("\n")[0]), offset=tag.start(), hint=hint)
        return None

    def _diagnostic(
        self, code: str, message: Phrase, length: int = 1, *, offset: int | None = None, hint: Phrase | None = None
    ) -> Diagnostic:
        start = self._offset if offset is None else offset
        span = self._source.span(start, start + length)
        return Diagnostic(code, message, span=span, hint=hint, source=self._source)

    def _mismatched_tag(self) -> Diagnostic:
        start = self._text.rfind("</", 0, self._offset + 2)
        closing = _CLOSING_TAG.match(self._text, max(start, 0))
        name = closing[1] if closing else ""
        span = self._source.span(start, closing.end() if closing else start + 2)
        if not self._open:
            return Diagnostic(
                "XML201",
                phrase("'</{name}>' does not close an element, because none is open", name=name),
                span=span,
                source=self._source,
            )
        inner, opened_at = self._open[-1]
        note = Note(
            phrase("'<{inner}>' is opened here", inner=inner), self._source.span(opened_at, opened_at + 1 + len(inner))
        )
        closes_ancestor = any(name == tag for tag, _ in self._open[:-1])
        hint = (
            phrase("write '</{inner}>' before it", inner=inner)
            if closes_ancestor
            else phrase("write '</{inner}>', or remove it", inner=inner)
        )
        outer, outer_at = self._open[-2] if len(self._open) > 1 else ("", 0)
        line = self._source.position(opened_at)[0]
        if outer == inner and line == self._source.position(outer_at)[0]:
            hint = phrase(
                "write '</{inner}>' in place of the second '<{inner}>' in line {line}", inner=inner, line=line
            )
        if name.casefold() == inner.casefold():
            hint = phrase("write both alike: '<{name}>' and '</{name}>'", name=name.casefold())
        preceding_text = self._text[opened_at:start]
        opening = next((character for character in _ANGLE_LOOKALIKES if f"{character}{name}" in preceding_text), None)
        if opening is not None:
            hint = lookalike_hint(opening) or hint
        return Diagnostic(
            "XML201",
            phrase("'</{name}>' does not close '<{inner}>'", name=name, inner=inner),
            span=span,
            notes=(note,),
            hint=hint,
            source=self._source,
        )

    def _unclosed_fault(self) -> Diagnostic:
        name, offset = self._open[-1]
        span = self._source.span(offset, offset + 1 + len(name))
        hint = phrase("write '</{name}>' where it ends", name=name)
        return Diagnostic(
            "XML202", phrase("'<{name}>' is never closed", name=name), span=span, hint=hint, source=self._source
        )

    def _unclosed_token(self) -> Diagnostic:
        if self._text.startswith("<!--", self._offset):
            return self._diagnostic(
                "XML203", phrase("this comment is never closed"), 4, hint=phrase("close it with '-->'")
            )
        if self._text.startswith("<![CDATA[", self._offset):
            return self._diagnostic(
                "XML203", phrase("this CDATA section is never closed"), 9, hint=phrase("close it with ']]>'")
            )
        name = _NAME.match(self._text, self._offset + 1)
        length = 1 + (len(name[0]) if name else 0)
        hint = phrase("look for a missing '>' or a missing quote")
        return self._diagnostic("XML203", phrase("this tag has no closing '>'"), length, hint=hint)

    def _not_xml(self) -> Diagnostic:
        hint = phrase("an XML file may have only comments before its root element")
        start = len(self._text) - len(self._text.lstrip())
        return self._diagnostic("XML206", phrase("this is not XML"), offset=start, hint=hint)

    # --- invalid tokens: recognized common mistakes -------------------------------------------------------------------

    def _invalid_token(self) -> Diagnostic:
        for find_mistake in (
            self._unfinished_merge,
            self._forbidden_character,
            self._missing_markup,
            self._lone_ampersand,
            self._dashes_in_comment,
            self._lone_less_than,
            self._unquoted_value,
            self._broken_by_entities,
            self._less_than_in_tag,
            self._unclosed_quote,
            self._missing_space,
            self._attribute_without_value,
        ):
            diagnostic = find_mistake()
            if diagnostic is not None:
                return diagnostic
        character = self._character
        if not character:
            return self._diagnostic("XML206", phrase("the file ends unexpectedly"))
        message = phrase("unexpected character {character}", character=repr(character))
        return self._diagnostic("XML206", message, hint=lookalike_hint(character))

    @property
    def _character(self) -> str:
        """The character at which expat stopped, or an empty string at the end of the text."""
        return self._text[self._offset : self._offset + 1]

    @property
    def _preceding_text(self) -> str:
        """The text directly before the character at which expat stopped."""
        return self._text[max(0, self._offset - _SEARCH_LENGTH) : self._offset]

    def _unfinished_merge(self) -> Diagnostic | None:
        line = self._text.rfind("\n", 0, self._offset) + 1
        if not self._text.startswith(_MERGE_MARKER, line):
            return None
        return self._diagnostic(
            "XML206",
            phrase("there is an unresolved merge conflict here"),
            len(_MERGE_MARKER.rstrip()),
            offset=line,
            hint=phrase("keep one of the two, and remove the lines with '<<<<<<<', '=======' and '>>>>>>>'"),
        )

    def _forbidden_character(self) -> Diagnostic | None:
        character = self._character
        if not character or character.isprintable() or character in "\t\r\n":
            return None
        return self._diagnostic("XML206", phrase("the character U+{ord:04X} is not allowed in XML", ord=ord(character)))

    def _missing_markup(self) -> Diagnostic | None:
        return None if self._character == "<" or "<" in self._text[: self._offset] else self._not_xml()

    def _lone_ampersand(self) -> Diagnostic | None:
        match = _LONE_AMPERSAND.search(self._preceding_text)
        if match is None:
            return None
        start = self._offset - len(match[0])
        hint = _AND_HINT if self._text[start : start + 2] == "&&" else _AMPERSAND_HINT
        return self._diagnostic("XML206", phrase("'&' does not begin an entity"), offset=start, hint=hint)

    def _dashes_in_comment(self) -> Diagnostic | None:
        if not _DASHES_IN_COMMENT.search(self._preceding_text):
            return None
        message = phrase("'--' is not allowed inside a comment")
        hint = phrase("use other characters, such as '=='")
        return self._diagnostic("XML206", message, 2, offset=self._offset - 2, hint=hint)

    def _lone_less_than(self) -> Diagnostic | None:
        if not self._preceding_text.endswith("<"):
            return None
        message = phrase("'<' does not begin a tag")
        return self._diagnostic("XML206", message, offset=self._offset - 1, hint=phrase("write '&lt;'"))

    def _unquoted_value(self) -> Diagnostic | None:
        unquoted = _UNQUOTED.search(self._preceding_text)
        if unquoted is None:
            return None
        name = unquoted[1]
        value = _NAME.match(self._text, self._offset)
        hint = (
            phrase('write {name}="...", with straight quotes', name=name)
            if self._character in _CURVED_QUOTES
            else phrase('write {name}="..."', name=name)
        )
        message = phrase("the value of '{name}' is not in quotes", name=name)
        return self._diagnostic("XML206", message, len(value[0]) if value else 1, hint=hint)

    def _broken_by_entities(self) -> Diagnostic | None:
        if self._character != "<" or "<!ENTITY" not in self._text or not self._preceding_text.rstrip().endswith(">"):
            return None
        hint = phrase("check the entities that the document declares")
        return self._diagnostic("XML206", phrase("this is not well-formed after its entities are expanded"), hint=hint)

    def _less_than_in_tag(self) -> Diagnostic | None:
        if self._character != "<":
            return None
        if open_quote := self._open_quote():
            return open_quote
        return self._diagnostic("XML206", phrase("'<' is not allowed inside a tag"), hint=_LESS_HINT)

    def _open_quote(self) -> Diagnostic | None:
        """Return the error for unclosed quotes around a value of the previous tag, or None."""
        tag_start = self._text.rfind("<", 0, self._offset)
        tag = _QUOTED.sub(lambda value: " " * len(value[0]), self._text[max(tag_start, 0) : self._offset])
        match = _OPEN_QUOTE.search(tag)
        if tag_start < 0 or match is None or ">" not in match[2]:
            return None
        message = phrase("the quotes around the value of '{attribute}' are not closed", attribute=match[1])
        hint = lookalike_hint(match[2]) or phrase("write a quote at the end of the value")
        return self._diagnostic("XML206", message, len(match[1]), offset=tag_start + match.start(), hint=hint)

    def _unclosed_quote(self) -> Diagnostic | None:
        match = _UNCLOSED_QUOTE.search(self._preceding_text)
        if match is None:
            return None
        message = phrase("the quotes around the value of '{attribute}' are not closed", attribute=match[1])
        start, hint = self._offset - len(match[0]), phrase("write a quote at the end of the value")
        return self._diagnostic("XML206", message, len(match[1]), offset=start, hint=hint)

    def _missing_space(self) -> Diagnostic | None:
        if not self._preceding_text.endswith(('"', "'")) or not _NAME.match(self._character):
            return None
        hint = phrase("write a space here, or look for a missing quote before it")
        return self._diagnostic("XML206", phrase("a space is missing between two attributes"), hint=hint)

    def _attribute_without_value(self) -> Diagnostic | None:
        bare_attribute = _BARE_ATTRIBUTE.search(self._preceding_text)
        if bare_attribute is None:
            return None
        message = phrase("the attribute '{bare}' has no value", bare=bare_attribute[1])
        hint = lookalike_hint(self._character) or phrase('write {name}="..."', name=bare_attribute[1])
        return self._diagnostic(
            "XML206", message, len(bare_attribute[1]), offset=self._offset - len(bare_attribute[0]), hint=hint
        )

    # --- entities and attributes --------------------------------------------------------------------------------------

    def _undefined_entity(self) -> Diagnostic:
        name = _NAME.match(self._text, self._offset + 1)
        entity = f"&{name[0]};" if name else "&"
        message = phrase("the entity '{entity}' is not defined", entity=entity)
        return self._diagnostic("XML208", message, len(entity), hint=_AMPERSAND_HINT)

    def _duplicate_attribute(self) -> Diagnostic:
        name = _NAME.match(self._text, self._offset)
        attribute = name[0] if name else ""
        message = phrase("the attribute '{name}' occurs twice in this element", name=attribute)
        return self._diagnostic("XML204", message, max(1, len(attribute)), hint=phrase("keep one of the two"))


def _translate_expat_message(error: ExpatError) -> Phrase:
    return phrase("this is not well-formed XML: {reason}", reason=foreign(str(error).partition(":")[0]))
