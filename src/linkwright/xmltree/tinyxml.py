"""XML parsing as in TinyXML2, the lenient parser of urdfdom and the simulators.

TinyXML2 does not support namespaces, and ends a comment only at ``-->``. It skips text before the root element and
elements after the root, and stops at a closing tag without an open element. It also accepts an ``&`` that does not
begin an entity, a ``<`` in a value, attributes without a blank between them, control characters, and a second XML
declaration directly after the first. Such files work for their users, so they are accepted with a warning.

Characters that TinyXML2 accepts and expat refuses are replaced by the same number of other characters.

The arguments of a repair are a text and the offset of the text's first mistake. It returns the text with all mistakes
of its kind replaced, or the unchanged text if the mistake is of another kind. `restore_characters` then
restores the original characters in the tree.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from xml.parsers.expat import ExpatError, ParserCreate
from xml.parsers.expat.errors import XML_ERROR_TAG_MISMATCH, codes

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, Severity, SourceText, Span, phrase
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.xmltree.nodes import Comment, Document, Element, Node, Text
from linkwright.xmltree.reader import parse

_PRIVATE = 0xE000
"""Where the characters begin that Unicode leaves to programs: XML allows them, and hardly a file has them."""
_CONTROLS = frozenset({*map(chr, range(1, 0x20))} - {*"\t\n\r"})
"""Without zero, which ends the text for TinyXML2."""
_BLANKS = "\v\f"
"""Control characters that are blanks for C, and for TinyXML2."""
_STAND_INS = {character: chr(_PRIVATE + ord(character)) for character in ("&", "<", *_CONTROLS)}
_WRITTEN = str.maketrans({there: character for character, there in _STAND_INS.items()})
_ANY = lazy_pattern(f"[{''.join(_STAND_INS.values())}]")
_BETWEEN_TAGS = lazy_pattern(r"<!--.*?-->|<!\[CDATA\[.*?\]\]>", re.DOTALL)
_TAG = lazy_pattern(r"""<[^\W\d][^\s=/>"'<]*""")
_ATTRIBUTE = lazy_pattern(r"""(\s*)([^\s=/>"'<]+)\s*=\s*("[^"]*"|'[^']*')""", re.ASCII)


def stand_in(character: str) -> str:
    """Return the substitute for a character, which `restore_characters` converts back.

    The character is ``&``, ``<`` or a control character.
    """
    return _STAND_INS[character]


def can_stand_in(text: str) -> bool:
    """Return whether a text has no substitute characters, so that they are unambiguous."""
    return _ANY.search(text) is None


def blank_outside_tags(text: str) -> str:
    """Return a text of the same length in which comments and CDATA sections are blank."""
    return _BETWEEN_TAGS.sub(lambda found: " " * len(found[0]), text)


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
    """Return the text with a blank between attributes that lack one.

    Each closing quote replaces the last character of its value, so that positions stay valid.
    """
    if text[at - 1 : at] not in ("'", '"'):
        return text
    for value in _values_without_blank_after(text):
        if value.start == value.end or text[value.end - 1] == ";":
            return text  # the value is empty, or its last character ends an entity
        text = text[: value.end - 1] + text[value.end] + " " + text[value.end + 1 :]
    return text


REPAIRS = (_control_characters, _less_than_in_values, _missing_blanks)


def restore_characters(document: Document, text: str) -> None:
    """Restore the original characters in a tree that was parsed from a repaired text.

    `text` is the text before the repairs.
    """
    shortened: dict[int, list[_Value]] = {}
    for value in _values_without_blank_after(text):
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
    """The value of an attribute: offset of the tag, name, and range without the quotes."""

    tag: int
    name: str
    start: int
    end: int


def _values(text: str) -> Iterator[_Value]:
    return (value for value, _ in _with_blanks_before(text))


def _values_without_blank_after(text: str) -> Iterator[_Value]:
    """Yield the values that another attribute follows without a blank."""
    last: _Value | None = None
    for value, blanks in _with_blanks_before(text):
        if last is not None and last.tag == value.tag and not blanks:
            yield last
        last = value


def _with_blanks_before(text: str) -> Iterator[tuple[_Value, str]]:
    markup = blank_outside_tags(text)
    at = 0
    while tag := _TAG.search(markup, at):
        at = tag.end()
        while found := _ATTRIBUTE.match(markup, at):
            at = found.end()
            yield _Value(tag.start(), found[2], found.start(3) + 1, found.end(3) - 1), found[1]


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
    """Return the document of a text as TinyXML2 parses it, and the warnings.

    There is one warning for each kind of mistake that XML forbids (XML205 to XML207).

    Args:
        text: the text.
        name: the name of the file in messages.
        readers: a phrase about the programs that accept the file nevertheless, and those that do not.
        read_as: a text to parse instead, with the same positions.

    Raises:
        LinkwrightError: if TinyXML2 does not accept the text either (XML###).
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
        restore_characters(document, text)
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
    bare = [match.start() for match in _BARE_AMPERSAND.finditer(blank_outside_tags(text))]
    if not bare:
        return read_as, None
    for at in bare:
        read_as = read_as[:at] + stand_in("&") + read_as[at + 1 :]
    place = source.span(bare[0], bare[0] + 1)
    return read_as, _Mistake(
        phrase("'&' does not begin an entity"), place, phrase("write '&amp;' for the character '&'")
    )


def _without(text: str, match: re.Match[str]) -> str:
    """Return a text of the same length in which the first group of a match is blank."""
    return text[: match.start(1)] + blank_out(match[1]) + text[match.end(1) :]


def blank_out(text: str) -> str:
    """Return a text with all characters except blanks and line endings replaced by blanks.

    Positions in the rest of a file therefore stay valid.
    """
    return re.sub(r"\S", " ", text)


def forbidden(message: Phrase, span: Span, source: SourceText, hint: Phrase, readers: Phrase) -> Diagnostic:
    """Return a warning about a construct that XML forbids and TinyXML2 accepts."""
    return Diagnostic("XML206", message, span, Severity.WARNING, (Note(readers),), hint, source)


def _parsed(source: SourceText, read_as: str, readers: Phrase) -> tuple[Document, tuple[Diagnostic, ...]]:
    try:
        return parse(source.text, source.name, blanks=False, read_as=read_as), ()
    except LinkwrightError as error:
        first = error.diagnostics[0]
        if first.code == _UNDECLARED:
            document = parse(source.text, source.name, blanks=False, read_as=read_as, any_prefix=True)
            return document, (first.with_changes(severity=Severity.WARNING),)
        end = _end_of_root(first, read_as)
        if end is not None and _is_ignored_content(read_as[end:]):
            warning, read_as = _ignored_content_warning(source, end, readers), read_as[:end] + blank_out(read_as[end:])
        else:
            warning, read_as = (
                first.with_changes(severity=Severity.WARNING, notes=(Note(readers),)),
                _repair_text(source, error, read_as),
            )
        try:
            document, more = _parsed(source, read_as, readers)
        except LinkwrightError:
            raise error from None
        if warning.code == _AFTER_ROOT and any(diagnostic.code == _AFTER_ROOT for diagnostic in more):
            return document, more
        return document, (warning, *more)


def _repair_text(source: SourceText, error: LinkwrightError, text: str) -> str:
    """Return the text with all mistakes of the error's kind replaced.

    Raises:
        LinkwrightError: `error`, if no repair applies.
    """
    diagnostic = error.diagnostics[0]
    if diagnostic.code == _NOT_XML and diagnostic.span is not None and can_stand_in(source.text):
        at = source.offset(diagnostic.span.line, diagnostic.span.column)
        for repair in REPAIRS:
            repaired = repair(text, at)
            if repaired != text:
                return repaired
    raise error


def _ignored_content_warning(source: SourceText, end: int, readers: Phrase) -> Diagnostic:
    """Return the warning about content after the root."""
    message = phrase("there is content after the end of the root element")
    hint = phrase("a file has one root element")
    return Diagnostic(_AFTER_ROOT, message, source.span(end, end + 1), Severity.WARNING, (Note(readers),), hint, source)


def _end_of_root(diagnostic: Diagnostic, text: str) -> int | None:
    """Return the offset at which the content after the root may begin, or None for other errors."""
    if diagnostic.span is None or diagnostic.source is None:
        return None
    at = diagnostic.source.offset(diagnostic.span.line, diagnostic.span.column)
    return at if diagnostic.code == _AFTER_ROOT or (diagnostic.code == _NOT_XML and text.startswith("</", at)) else None


def _is_ignored_content(rest: str) -> bool:
    """Return whether TinyXML2 ignores the content after the root.

    This is so if the elements are well-formed up to an unmatched closing tag or the end.
    """
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
    """Return whether a comment has dashes that XML forbids; False for None (no comment)."""
    return comment is not None and ("--" in comment or comment.endswith("-"))
