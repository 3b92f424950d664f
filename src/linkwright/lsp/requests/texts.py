"""Requests about one text: formatting, symbols, folding, selection and linked tags."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from lsprotocol import types

from linkwright.diagnostics import LinkwrightError
from linkwright.language.format import Symbol
from linkwright.language.outline import Outline, OutlineElement
from linkwright.lint.configuration import find_settings
from linkwright.lsp.positions import TextPositions
from linkwright.lsp.server import LinkwrightServer
from linkwright.xmltree.formatting import changes, format_text

_SYMBOL_KINDS = {
    "robot": types.SymbolKind.Module,
    "world": types.SymbolKind.Module,
    "model": types.SymbolKind.Class,
    "link": types.SymbolKind.Object,
    "joint": types.SymbolKind.Interface,
    "xacro:macro": types.SymbolKind.Function,
    "xacro:property": types.SymbolKind.Variable,
    "xacro:arg": types.SymbolKind.Variable,
    "xacro:include": types.SymbolKind.File,
    "include": types.SymbolKind.File,
    "material": types.SymbolKind.Constant,
    "plugin": types.SymbolKind.Package,
    "sensor": types.SymbolKind.Event,
    "node": types.SymbolKind.Class,
    "arg": types.SymbolKind.Variable,
}


def format_edits(
    positions: TextPositions, path: Path, lines: tuple[int, int] | None = None
) -> list[types.TextEdit] | None:
    """Return the edits that format a text like `linkwright format`, or None if it is not XML.

    Args:
        positions: the text.
        path: its file, whose settings apply.
        lines: the first line to format, from 0, and the line after the last, or None for all lines.
    """
    text = positions.text
    try:
        formatted = format_text(text, str(path), find_settings(path)[0].style)
    except LinkwrightError:
        return None
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    return [
        types.TextEdit(positions.range(starts[edit.first], starts[edit.last]), "".join(edit.lines))
        for edit in changes(text, formatted, lines)
    ]


def list_symbols(positions: TextPositions) -> list[types.DocumentSymbol]:
    """Return the named elements of a text as nested symbols."""
    return [*_convert_elements(Outline.of(positions.text).elements, positions)]


def _convert_elements(elements: Iterable[OutlineElement], positions: TextPositions) -> Iterable[types.DocumentSymbol]:
    for element in elements:
        children = [*_convert_elements(element.children, positions)]
        if not element.is_named and element.tag.name not in _SYMBOL_KINDS:
            yield from children
            continue
        yield types.DocumentSymbol(
            element.label,
            _SYMBOL_KINDS.get(element.tag.name, types.SymbolKind.Field),
            positions.range(element.tag.start, element.end),
            positions.range(element.tag.start, element.tag.end),
            children=children,
        )


def _convert_symbol(symbol: Symbol, positions: TextPositions) -> types.DocumentSymbol:
    range_ = positions.range(symbol.start, symbol.end)
    children = [_convert_symbol(child, positions) for child in symbol.children]
    kind = types.SymbolKind[symbol.kind.value]
    return types.DocumentSymbol(symbol.name, kind, range_, range_, detail=symbol.detail or None, children=children)


def find_folds(positions: TextPositions) -> list[types.FoldingRange]:
    """Return the folding ranges of elements and comments that span several lines."""
    outline = Outline.of(positions.text)

    def line(offset: int) -> int:
        return positions.position(offset).line

    elements = ((element.tag, element.closing) for element in outline.all() if element.closing is not None)
    ranges = [(line(tag.start), line(closing.start) - 1) for tag, closing in elements]
    comments = [(line(comment.start), line(comment.end)) for comment in outline.comments]
    comment_kind = types.FoldingRangeKind.Comment
    return [
        *(types.FoldingRange(start, end) for start, end in ranges if end > start),
        *(types.FoldingRange(start, end, kind=comment_kind) for start, end in comments if end > start),
    ]


def find_selections(positions: TextPositions, cursors: Iterable[types.Position]) -> list[types.SelectionRange]:
    """Return the nested selection ranges around each position.

    These are the attribute value, attribute, tag, content and element, and those of the enclosing elements.
    """
    outline = Outline.of(positions.text)
    selection_ranges = []
    for position in cursors:
        offset = positions.offset(position)
        ranges: list[tuple[int, int]] = [(0, len(positions.text))]
        for element in outline.elements_around(offset):
            ranges.append((element.tag.start, element.end))
            if element.closing is not None:
                ranges.append((element.tag.end, element.closing.start))
            ranges.append((element.tag.start, element.tag.end))
            ranges += [(attribute.start, attribute.end) for attribute in element.tag.attributes()]
            ranges += [(attribute.value_start, attribute.value_end) for attribute in element.tag.attributes()]
        selection: types.SelectionRange | None = None
        outer = ranges[0]
        for start, end in ranges:
            if outer[0] <= start <= offset <= end <= outer[1]:
                selection, outer = types.SelectionRange(positions.range(start, end), selection), (start, end)
        selection_ranges.append(selection or types.SelectionRange(positions.whole()))
    return selection_ranges


def find_linked_tags(positions: TextPositions, position: types.Position) -> types.LinkedEditingRanges | None:
    """Return the ranges of the start and end tag names at a position, or None."""
    offset = positions.offset(position)
    for element in reversed(Outline.of(positions.text).elements_around(offset)):
        if element.closing is None:
            continue
        length = len(element.tag.name)
        starts = (element.tag.name_start, element.closing.name_start)
        if any(start <= offset <= start + length for start in starts):
            return types.LinkedEditingRanges([positions.range(start, start + length) for start in starts])
    return None


def add_requests(server: LinkwrightServer) -> None:
    """Register the request handlers of this module."""

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    def format_document(
        server: LinkwrightServer, params: types.DocumentFormattingParams
    ) -> list[types.TextEdit] | None:
        path, positions = server.xml_text(params.text_document)
        return None if positions is None else format_edits(positions, path)

    @server.feature(types.TEXT_DOCUMENT_RANGE_FORMATTING)
    def format_range(
        server: LinkwrightServer, params: types.DocumentRangeFormattingParams
    ) -> list[types.TextEdit] | None:
        path, positions = server.xml_text(params.text_document)
        lines = (params.range.start.line, params.range.end.line + (params.range.end.character > 0))
        return None if positions is None else format_edits(positions, path, lines)

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    def document_symbol(
        server: LinkwrightServer, params: types.DocumentSymbolParams
    ) -> list[types.DocumentSymbol] | None:
        context = server.format_context(params.text_document)
        if context is not None and context.format.symbols is not None:
            return [_convert_symbol(symbol, context.positions) for symbol in context.format.symbols(context.document)]
        _, positions = server.xml_text(params.text_document)
        return None if positions is None else list_symbols(positions)

    @server.feature(types.TEXT_DOCUMENT_FOLDING_RANGE)
    def folding_range(server: LinkwrightServer, params: types.FoldingRangeParams) -> list[types.FoldingRange] | None:
        _, positions = server.xml_text(params.text_document)
        return None if positions is None else find_folds(positions)

    @server.feature(types.TEXT_DOCUMENT_SELECTION_RANGE)
    def selection_range(
        server: LinkwrightServer, params: types.SelectionRangeParams
    ) -> list[types.SelectionRange] | None:
        _, positions = server.xml_text(params.text_document)
        return None if positions is None else find_selections(positions, params.positions)

    @server.feature(types.TEXT_DOCUMENT_LINKED_EDITING_RANGE)
    def linked_editing_range(
        server: LinkwrightServer, params: types.LinkedEditingRangeParams
    ) -> types.LinkedEditingRanges | None:
        _, positions = server.xml_text(params.text_document)
        return None if positions is None else find_linked_tags(positions, params.position)
