"""Inline a property: replace all its uses by its value."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from linkwright.diagnostics import display_path, phrase
from linkwright.language.definitions import NameKind
from linkwright.language.expressions import SourceExpression, decode_entities, expressions_in, substitute_name
from linkwright.language.occurrences import Occurrence
from linkwright.language.proof import Edit, ExpansionProof, UnprovedError
from linkwright.language.renaming import find_references, occurrence_at
from linkwright.language.source_elements import SourceElement, find_innermost_element, source_elements
from linkwright.language.workspace import Workspace
from linkwright.loading.deferred import lazy_pattern
from linkwright.xacro.expressions.scope import parse_literal
from linkwright.xmltree.patches import extend_to_whole_lines
from linkwright.xmltree.tokens import Kind, tokens

_LITERAL = lazy_pattern(r"[^$'\"&<\\]*")
_PROPERTY = "xacro:property"
_PROPERTY_ATTRIBUTES = frozenset({"name", "value", "scope", "lazy_eval"})
"""The attributes that an inlinable definition may have.

A ``default`` is not allowed, because its effect depends on other definitions.
"""


class _Piece(NamedTuple):
    """The attribute value or character data that contains a use.

    Attributes:
        start: the character offset of the text in the file.
        text: the text as written.
        quote: the quote around the text, or empty for character data.
    """

    start: int
    text: str
    quote: str


def find_property_at(text: str, file: Path, offset: int) -> Occurrence | None:
    """Return the use or definition of a property at an offset, or None."""
    name = occurrence_at(text, file, offset)
    return name if name is not None and name.kind is NameKind.PROPERTY else None


def inline_property(workspace: Workspace, texts: Mapping[Path, str], name: Occurrence) -> tuple[Edit, ...]:
    """Return the proved edits that replace all uses of a property with its value.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        name: a use or the definition of the property.

    Raises:
        UnprovedError: the property does not have exactly one definition, a use cannot be replaced, or the expansions
            would differ.
    """
    uses = find_references(workspace, texts, name)
    definitions = [use for use in uses if use.is_definition]
    if len(definitions) != 1:
        raise UnprovedError(
            phrase("'{name}' has {count} definitions instead of one", name=name.name, count=len(definitions))
        )
    definition = definitions[0]
    source = workspace.text(definition.file, texts) or ""
    element = find_innermost_element(source_elements(source), definition.start)
    value = None if element is None else _find_literal_value(element)
    if element is None or value is None:
        raise UnprovedError(phrase("'{name}' is not defined by a value alone", name=name.name))
    lines = extend_to_whole_lines(source, element.start, element.end)
    removal = Edit(definition.file, *lines, "")
    proof = ExpansionProof(workspace, texts, definition.file)
    error: UnprovedError | None = None
    for is_raw in (True, False):
        edits = [removal, *_generate_replacements(workspace, texts, uses, value, is_raw=is_raw)]
        try:
            proof.check_equal(edits)
        except UnprovedError as reason:
            error = reason
        else:
            return tuple(sorted(edits))
    assert error is not None
    raise error


def _find_literal_value(element: SourceElement) -> str | None:
    """Return the value in a property's definition, or None if the definition has more parts."""
    attributes = {attribute.name: attribute.value for attribute in element.tag.attributes()}
    if element.name != _PROPERTY or element.children or element.end < 0 or not {*attributes} <= _PROPERTY_ATTRIBUTES:
        return None
    return attributes.get("value")


def _generate_replacements(
    workspace: Workspace, texts: Mapping[Path, str], uses: Sequence[Occurrence], value: str, *, is_raw: bool
) -> Iterator[Edit]:
    """Yield the edits of the uses of a property.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        uses: the occurrences of the name.
        value: the value of the property as written.
        is_raw: whether the value as written replaces an expression that consists of the name alone.
    """
    for file in dict.fromkeys(use.file for use in uses):
        text = workspace.text(file, texts) or ""
        places = [use for use in uses if use.file == file and not use.is_definition]
        pieces = [*_find_pieces(text)] if places else []
        replaced_ranges: set[tuple[int, int]] = set()
        for use in places:
            piece = next(
                (
                    candidate
                    for candidate in pieces
                    if candidate.start <= use.start < candidate.start + len(candidate.text)
                ),
                None,
            )
            expression = None if piece is None else _find_expression_around(piece, use)
            if piece is None or expression is None or text[: use.start].endswith("."):
                line = text.count("\n", 0, use.start) + 1
                message = phrase(
                    "'{name}' is used outside an expression in {file}:{line}",
                    name=use.name,
                    file=display_path(file),
                    line=line,
                )
                raise UnprovedError(message)
            span = piece.start + expression.start, piece.start + expression.end
            if span not in replaced_ranges:
                replaced_ranges.add(span)
                names = [candidate for candidate in places if span[0] <= candidate.start < span[1]]
                yield Edit(file, *span, _make_replacement(expression, piece, names, value, is_raw=is_raw))


def _find_pieces(text: str) -> Iterator[_Piece]:
    """Yield the values and character data of a text that contain expressions."""
    for token in tokens(text):
        if token.kind is Kind.START:
            for attribute in token.attributes():
                if attribute.value and "$" in attribute.value:
                    yield _Piece(attribute.value_start, attribute.value, attribute.quote)
        elif token.kind is Kind.TEXT and "$" in token.text:
            yield _Piece(token.start, token.text, "")


def _find_expression_around(piece: _Piece, use: Occurrence) -> SourceExpression | None:
    offset = use.start - piece.start
    return next(
        (expression for expression in expressions_in(piece.text) if expression.start < offset < expression.end), None
    )


def _make_replacement(
    expression: SourceExpression, piece: _Piece, names: Sequence[Occurrence], value: str, *, is_raw: bool
) -> str:
    """Return the text that replaces an expression with the property."""
    quotes = {"'": "&apos;", '"': "&quot;"}
    source, low = expression.source, piece.start + expression.inner_range[0]
    if source.strip() == names[0].name and (is_raw or _to_expression(value, piece.quote) is None):
        return value.replace(piece.quote, quotes[piece.quote]) if piece.quote else value
    new = _to_expression(value, piece.quote)
    if new is None:
        raise UnprovedError(phrase("an expression cannot contain the value '{value}'", value=value))
    if piece.quote:
        new = new.replace(piece.quote, quotes[piece.quote])
    for use in sorted(names, key=lambda name: name.start, reverse=True):
        replaced = substitute_name(source, use.start - low, use.end - low, new)
        if replaced is None:
            raise UnprovedError(phrase("an expression cannot contain the value '{value}'", value=value))
        source = replaced
    return f"${{{source}}}"


def _to_expression(value: str, quote: str) -> str | None:
    """Return the value of a property as an expression, or None if it cannot be written as one.

    Args:
        value: the value as written.
        quote: the quote around the text that receives the expression.
    """
    parts = [*expressions_in(value)]
    if len(parts) == 1 and (parts[0].start, parts[0].end) == (0, len(value)):
        return parts[0].source.strip()
    if not _LITERAL.fullmatch(value):
        return None
    python = parse_literal(decode_entities(value))
    if isinstance(python, bool):
        return str(python)
    if isinstance(python, (int, float)):
        return value.strip() if _is_number(value) else repr(python)
    inner = "'" if quote != "'" else '"'
    return f"{inner}{value}{inner}"


def _is_number(text: str) -> bool:
    """Return whether a text is a valid number in Python, unlike ``007``."""
    try:
        return isinstance(ast.literal_eval(text.strip()), (int, float))
    except (SyntaxError, ValueError):
        return False
