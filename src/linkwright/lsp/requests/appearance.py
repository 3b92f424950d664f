"""The appearance of a text: semantic highlighting and colors."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from lsprotocol import types

from linkwright.language.colors import colors_in, format_color
from linkwright.language.highlighting import Highlight, HighlightKind, highlights_in
from linkwright.lsp.positions import TextPositions
from linkwright.lsp.server import LinkwrightServer

_LEGEND = types.SemanticTokensLegend([kind.value for kind in HighlightKind], ["definition"])
_TOKEN_TYPE_NUMBERS = {kind: number for number, kind in enumerate(HighlightKind)}


def semantic_tokens(positions: TextPositions, highlights: Iterable[Highlight]) -> list[int]:
    """Encode highlights for the protocol, except highlights that span several lines.

    Args:
        positions: the text.
        highlights: the highlights, in text order.
    """
    data: list[int] = []
    line = column = 0
    for highlight in highlights:
        range_ = positions.range(highlight.start, highlight.end)
        if range_.start.line != range_.end.line or range_.start == range_.end:
            continue
        relative = range_.start.character - (column if range_.start.line == line else 0)
        length = range_.end.character - range_.start.character
        data += [
            range_.start.line - line,
            relative,
            length,
            _TOKEN_TYPE_NUMBERS[highlight.kind],
            int(highlight.is_definition),
        ]
        line, column = range_.start.line, range_.start.character
    return data


def colors(positions: TextPositions) -> list[types.ColorInformation]:
    """Return the colors in a text."""
    return [
        types.ColorInformation(positions.range(color.start, color.end), types.Color(*color.rgba))
        for color in colors_in(positions.text)
    ]


def color_edits(positions: TextPositions, range_: types.Range, color: types.Color) -> list[types.ColorPresentation]:
    """Return the edit that replaces the color in a range, with alpha if it is needed."""
    old_text = positions.text[positions.offset(range_.start) : positions.offset(range_.end)]
    with_alpha = len(old_text.split()) == 4 or color.alpha != 1
    text = format_color((color.red, color.green, color.blue, color.alpha), with_alpha=with_alpha)
    return [types.ColorPresentation(text, types.TextEdit(range_, text))]


def add_requests(server: LinkwrightServer) -> None:
    """Register the request handlers of this module."""

    def highlights(path: Path, positions: TextPositions, range_: types.Range | None = None) -> types.SemanticTokens:
        highlights = highlights_in(positions.text, path)
        if range_ is not None:
            start, end = positions.offset(range_.start), positions.offset(range_.end)
            highlights = [highlight for highlight in highlights if start <= highlight.start and highlight.end <= end]
        return types.SemanticTokens(semantic_tokens(positions, highlights))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, _LEGEND)
    def semantic_tokens_full(
        server: LinkwrightServer, params: types.SemanticTokensParams
    ) -> types.SemanticTokens | None:
        path, positions = server.xml_text(params.text_document)
        return None if positions is None else highlights(path, positions)

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE, _LEGEND)
    def semantic_tokens_range(
        server: LinkwrightServer, params: types.SemanticTokensRangeParams
    ) -> types.SemanticTokens | None:
        path, positions = server.xml_text(params.text_document)
        return None if positions is None else highlights(path, positions, params.range)

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_COLOR)
    def document_color(server: LinkwrightServer, params: types.DocumentColorParams) -> list[types.ColorInformation]:
        _, positions = server.xml_text(params.text_document)
        return [] if positions is None else colors(positions)

    @server.feature(types.TEXT_DOCUMENT_COLOR_PRESENTATION)
    def color_presentation(
        server: LinkwrightServer, params: types.ColorPresentationParams
    ) -> list[types.ColorPresentation]:
        _, positions = server.xml_text(params.text_document)
        return [] if positions is None else color_edits(positions, params.range, params.color)
