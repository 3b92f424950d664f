"""A parser of XML as lenient as TinyXML2, the parser of urdfdom and the simulators.

TinyXML2 does not support namespaces, and ends a comment only at ``-->``. It skips text before the root element and
elements after the root, and stops at a closing tag without an open element. It also accepts an ``&`` that does not
begin an entity, a ``<`` in a value, attributes without a space between them, control characters, and a second XML
declaration directly after the first. Such files work for their users, so they are accepted with a warning.

expat refuses some characters that TinyXML2 accepts. Before parsing, a repair replaces them with the same number of
other characters. The arguments of a repair are a text and the offset of its first mistake. A repair returns the text
with all mistakes of its kind replaced, or the unchanged text if the first mistake is of another kind. After parsing,
`restore_characters` restores the original characters in the tree.
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

_PRIVATE_USE_START = 0xE000
"""The start of Unicode's private use area. XML allows these characters, but files rarely contain them."""
_CONTROL_CHARACTERS = frozenset({*map(chr, range(1, 0x20))} - {*"\t\n\r"})
"""The control characters that XML forbids, except NUL, because it ends the text for TinyXML2."""
_CONTROL_BLANKS = "\v\f"
"""Control characters that C and TinyXML2 treat as whitespace."""
_SUBSTITUTES = {character: chr(_PRIVATE_USE_START + ord(character)) for character in ("&", "<", *_CONTROL_CHARACTERS)}
_ORIGINALS = str.maketrans({there: character for character, there in _SUBSTITUTES.items()})
_ANY_SUBSTITUTE = lazy_pattern(f"[{''.join(_SUBSTITUTES.values())}]")
_BETWEEN_TAGS = lazy_pattern(r"<!--.*?-->|<!\[CDATA\[.*?\]\]>", re.DOTALL)
_TAG_START = lazy_pattern(r"""<[^\W\d][^\s=/>"'<]*""")
_ATTRIBUTE_PATTERN = lazy_pattern(r"""(\s*)([^\s=/>"'<]+)\s*=\s*("[^"]*"|'[^']*')""", re.ASCII)


def substitute_for(character: str) -> str:
    """Return the substitute for ``&``, ``<`` or a control character.

    `restore_characters` converts the substitute back.
    """
    return _SUBSTITUTES[character]


def has_no_substitutes(text: str) -> bool:
    """Return whether a text contains no substitutes yet, so that they can be used in the text."""
    return _ANY_SUBSTITUTE.search(text) is None


def blank_outside_tags(text: str) -> str:
    """Return a text of the same length, with spaces in place of comments and CDATA sections."""
    return _BETWEEN_TAGS.sub(lambda section: " " * len(section[0]), text)


def _replace_control_characters(text: str, offset: int) -> str:
    if text[offset : offset + 1] not in _CONTROL_CHARACTERS:
        return text
    return "".join(
        " "
        if character in _CONTROL_BLANKS
        else _SUBSTITUTES[character]
        if character in _CONTROL_CHARACTERS
        else character
        for character in text
    )


def _replace_less_than(text: str, offset: int) -> str:
    if text[offset : offset + 1] != "<":
        return text
    for value in _iterate_values(text):
        value_text = text[value.start : value.end]
        text = text[: value.start] + value_text.replace("<", _SUBSTITUTES["<"]) + text[value.end :]
    return text


def _insert_blanks(text: str, offset: int) -> str:
    """Return the text with a space inserted between adjacent attributes.

    To keep positions valid, the closing quote overwrites the last character of the value.
    """
    if text[offset - 1 : offset] not in ("'", '"'):
        return text
    for value in _find_values_without_blank_after(text):
        if value.start == value.end or text[value.end - 1] == ";":
            return text  # An empty value, or one that ends with an entity, has no character to overwrite.
        text = text[: value.end - 1] + text[value.end] + " " + text[value.end + 1 :]
    return text


REPAIRS = (_replace_control_characters, _replace_less_than, _insert_blanks)


def restore_characters(document: Document, text: str) -> None:
    """Restore the original characters in a tree that was parsed from a repaired text.

    `text` is the text before the repairs.
    """
    shortened_values: dict[int, list[_Value]] = {}
    for value in _find_values_without_blank_after(text):
        shortened_values.setdefault(value.tag, []).append(value)
    nodes: list[Node] = [*document.prolog, document.root, *document.epilog]
    while nodes:
        node = nodes.pop()
        if isinstance(node, Element):
            node.attributes = {name: value.translate(_ORIGINALS) for name, value in node.attributes.items()}
            for value in shortened_values.get(node.offset, ()):
                node.attributes[value.name] += text[value.end - 1]
            nodes.extend(node.children)
        elif isinstance(node, Comment):
            node.data = text[node.offset + 4 : text.index("-->", node.offset + 4)]
        elif isinstance(node, Text):
            node.data = node.data.translate(_ORIGINALS)


class _Value(NamedTuple):
    """The location of an attribute's value.

    `tag` is the offset of the tag. `start` and `end` are the range of the value without its quotes.
    """

    tag: int
    name: str
    start: int
    end: int


def _iterate_values(text: str) -> Iterator[_Value]:
    return (value for value, _ in _iterate_values_and_blanks(text))


def _find_values_without_blank_after(text: str) -> Iterator[_Value]:
    """Yield each value that is followed by another attribute without whitespace between them."""
    previous_value: _Value | None = None
    for value, blanks in _iterate_values_and_blanks(text):
        if previous_value is not None and previous_value.tag == value.tag and not blanks:
            yield previous_value
        previous_value = value


def _iterate_values_and_blanks(text: str) -> Iterator[tuple[_Value, str]]:
    markup = blank_outside_tags(text)
    position = 0
    while tag := _TAG_START.search(markup, position):
        position = tag.end()
        while attribute_match := _ATTRIBUTE_PATTERN.match(markup, position):
            position = attribute_match.end()
            yield (
                _Value(tag.start(), attribute_match[2], attribute_match.start(3) + 1, attribute_match.end(3) - 1),
                attribute_match[1],
            )


_UNDECLARED_PREFIX_CODE, _AFTER_ROOT_CODE, _NOT_XML_CODE = "XML205", "XML207", "XML206"
_OUTSIDE_TAGS = lazy_pattern(r"<!--(.*?)-->|<!\[CDATA\[.*?\]\]>", re.DOTALL)
COMMENT = "<!--[^-]*(?:-(?!->)[^-]*)*-->"
"""A pattern for one comment. ``.*?`` could extend over several comments, and backtrack in exponential time."""
_BEFORE_ROOT = lazy_pattern(rf"\A(?:\s*<\?xml\s[^>]*\?>)?(?:\s|{COMMENT})*([^<\s][^<]*)(?=<(?!\?xml\s))")
"""A pattern for text before the root element, but not before a declaration, because TinyXML2 rejects that too."""
_SECOND_DECLARATION = lazy_pattern(r"\s*<\?xml\s[^>]*\?>\s*(?=(<\?xml\s[^>]*\?>))")
_BARE_AMPERSAND = lazy_pattern(r"&(?!(?:#[0-9]+|#x[0-9a-fA-F]+|amp|lt|gt|quot|apos);)")
_ENTITY_DEFINITION = "<!ENTITY"


def parse_as_tinyxml(
    text: str, name: str, readers: Phrase, *, read_as: str | None = None
) -> tuple[Document, tuple[Diagnostic, ...]]:
    """Parse a text as TinyXML2 does, and return the document and the warnings.

    There is one warning for each kind of mistake that XML forbids (XML205 to XML207).

    Args:
        text: the text to parse.
        name: the name of the file in messages.
        readers: a note for the warnings on the programs that accept or reject such a file.
        read_as: a text of the same length to parse instead; None for `text`.

    Raises:
        LinkwrightError: TinyXML2 does not accept the text either (XML###).
    """
    warnings: list[Diagnostic] = []
    source = SourceText(name, text)
    read_as = text if read_as is None else read_as
    for tolerate in (_tolerate_text_before_root, _tolerate_second_declaration, _tolerate_dashes, _tolerate_ampersands):
        read_as, mistake = tolerate(source, read_as)
        if mistake:
            warnings.append(make_forbidden_warning(mistake.message, mistake.span, source, mistake.hint, readers))
    document, parser_warnings = _parse_leniently(source, read_as, readers)
    if warnings or parser_warnings:
        restore_characters(document, text)
    return document, (*warnings, *parser_warnings)


class _Mistake(NamedTuple):
    message: Phrase
    span: Span
    hint: Phrase


def _tolerate_text_before_root(source: SourceText, read_as: str) -> tuple[str, _Mistake | None]:
    text_match = _BEFORE_ROOT.match(source.text)
    if text_match is None:
        return read_as, None
    span = source.span(text_match.start(1), text_match.start(1) + len(text_match[1].rstrip()))
    hint = phrase("an XML file may have only comments before its root element")
    return _blank_out_group(read_as, text_match), _Mistake(phrase("there is text before the root element"), span, hint)


def _tolerate_second_declaration(source: SourceText, read_as: str) -> tuple[str, _Mistake | None]:
    declaration = _SECOND_DECLARATION.match(source.text)
    if declaration is None:
        return read_as, None
    span = source.span(declaration.start(1), declaration.start(1) + len("<?xml"))
    message = phrase("a second XML declaration follows the first")
    return _blank_out_group(read_as, declaration), _Mistake(message, span, phrase("remove it"))


def _tolerate_dashes(source: SourceText, read_as: str) -> tuple[str, _Mistake | None]:
    text = source.text
    comments_with_dashes = [match for match in _OUTSIDE_TAGS.finditer(text) if _has_dashes(match[1])]
    if not comments_with_dashes:
        return read_as, None
    for match in comments_with_dashes:
        read_as = read_as[: match.start(1)] + match[1].replace("-", "=") + read_as[match.end(1) :]
    dash_offset = text.index("--", comments_with_dashes[0].start(1))
    message = phrase("'--' is not allowed inside a comment")
    return read_as, _Mistake(
        message, source.span(dash_offset, dash_offset + 2), phrase("use other characters, such as '=='")
    )


def _tolerate_ampersands(source: SourceText, read_as: str) -> tuple[str, _Mistake | None]:
    text = source.text
    if not has_no_substitutes(text) or _ENTITY_DEFINITION in text:
        return read_as, None
    ampersand_offsets = [match.start() for match in _BARE_AMPERSAND.finditer(blank_outside_tags(text))]
    if not ampersand_offsets:
        return read_as, None
    for offset in ampersand_offsets:
        read_as = read_as[:offset] + substitute_for("&") + read_as[offset + 1 :]
    span = source.span(ampersand_offsets[0], ampersand_offsets[0] + 1)
    return read_as, _Mistake(
        phrase("'&' does not begin an entity"), span, phrase("write '&amp;' for the character '&'")
    )


def _blank_out_group(text: str, match: re.Match[str]) -> str:
    """Return the text with the first group of a match replaced by spaces."""
    return text[: match.start(1)] + blank_out(match[1]) + text[match.end(1) :]


def blank_out(text: str) -> str:
    """Return a text with all characters except whitespace replaced by spaces.

    Positions in the rest of a file stay valid.
    """
    return re.sub(r"\S", " ", text)


def make_forbidden_warning(
    message: Phrase, span: Span, source: SourceText, hint: Phrase, readers: Phrase
) -> Diagnostic:
    """Return a warning about a construct that XML forbids and TinyXML2 accepts."""
    return Diagnostic("XML206", message, span, Severity.WARNING, (Note(readers),), hint, source)


def _parse_leniently(source: SourceText, read_as: str, readers: Phrase) -> tuple[Document, tuple[Diagnostic, ...]]:
    try:
        return parse(source.text, source.name, blanks=False, read_as=read_as), ()
    except LinkwrightError as error:
        first = error.diagnostics[0]
        if first.code == _UNDECLARED_PREFIX_CODE:
            document = parse(source.text, source.name, blanks=False, read_as=read_as, any_prefix=True)
            return document, (first.with_changes(severity=Severity.WARNING),)
        end = _find_end_of_root(first, read_as)
        if end is not None and _is_ignored_content(read_as[end:]):
            warning, read_as = (
                _make_ignored_content_warning(source, end, readers),
                read_as[:end] + blank_out(read_as[end:]),
            )
        else:
            warning, read_as = (
                first.with_changes(severity=Severity.WARNING, notes=(Note(readers),)),
                _repair_text(source, error, read_as),
            )
        try:
            document, later_warnings = _parse_leniently(source, read_as, readers)
        except LinkwrightError:
            raise error from None
        if warning.code == _AFTER_ROOT_CODE and any(
            diagnostic.code == _AFTER_ROOT_CODE for diagnostic in later_warnings
        ):
            return document, later_warnings
        return document, (warning, *later_warnings)


def _repair_text(source: SourceText, error: LinkwrightError, text: str) -> str:
    """Return the text with all errors of one kind replaced.

    Raises:
        LinkwrightError: `error`, if no repair applies.
    """
    diagnostic = error.diagnostics[0]
    if diagnostic.code == _NOT_XML_CODE and diagnostic.span is not None and has_no_substitutes(source.text):
        offset = source.offset(diagnostic.span.line, diagnostic.span.column)
        for repair in REPAIRS:
            repaired = repair(text, offset)
            if repaired != text:
                return repaired
    raise error


def _make_ignored_content_warning(source: SourceText, end: int, readers: Phrase) -> Diagnostic:
    """Return the warning about content after the root."""
    message = phrase("there is content after the end of the root element")
    hint = phrase("keep one root element: an XML file has exactly one")
    return Diagnostic(
        _AFTER_ROOT_CODE, message, source.span(end, end + 1), Severity.WARNING, (Note(readers),), hint, source
    )


def _find_end_of_root(diagnostic: Diagnostic, text: str) -> int | None:
    """Return the offset at which content after the root may begin, or None for other errors."""
    if diagnostic.span is None or diagnostic.source is None:
        return None
    offset = diagnostic.source.offset(diagnostic.span.line, diagnostic.span.column)
    return (
        offset
        if diagnostic.code == _AFTER_ROOT_CODE or (diagnostic.code == _NOT_XML_CODE and text.startswith("</", offset))
        else None
    )


def _is_ignored_content(content: str) -> bool:
    """Return whether TinyXML2 ignores the content after the root.

    The content is ignored if the elements are well-formed up to the end or to a closing tag without a start tag.
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
        parser.Parse(f"<rest>{content}</rest>", True)
    except ExpatError as error:
        return depth == 1 and error.code == codes[XML_ERROR_TAG_MISMATCH]
    return True


def _has_dashes(comment: str | None) -> bool:
    """Return whether there is a comment with dashes that XML forbids."""
    return comment is not None and ("--" in comment or comment.endswith("-"))
