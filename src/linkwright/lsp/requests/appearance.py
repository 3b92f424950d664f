"""The appearance of a text: semantic highlighting and colours."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from lsprotocol import types

from linkwright.language.colors import colors_in, written_color
from linkwright.language.highlighting import Highlight, HighlightKind, highlights_in
from linkwright.lsp.positions import TextPositions
from linkwright.lsp.server import LinkwrightServer

_LEGEND = types.SemanticTokensLegend([kind.value for kind in HighlightKind], ["definition"])
_INDEX = {kind: number for number, kind in enumerate(HighlightKind)}


def semantic_tokens(positions: TextPositions, highlights: Iterable[Highlight]) -> list[int]:
    """Encode the highlights within one line for the protocol.

    Args:
        positions: the text.
        highlights: the highlights, in text order.
    """
    data: list[int] = []
    line = column = 0
    for highlight in highlights:
        place = positions.range(highlight.start, highlight.end)
        if place.start.line != place.end.line or place.start == place.end:
            continue
        relative = place.start.character - (column if place.start.line == line else 0)
        length = place.end.character - place.start.character
        data += [place.start.line - line, relative, length, _INDEX[highlight.kind], int(highlight.is_definition)]
        line, column = place.start.line, place.start.character
    return data


def colors(positions: TextPositions) -> list[types.ColorInformation]:
    """Return the colours in a text."""
    return [
        types.ColorInformation(positions.range(color.start, color.end), types.Color(*color.rgba))
        for color in colors_in(positions.text)
    ]


def color_edits(positions: TextPositions, place: types.Range, color: types.Color) -> list[types.ColorPresentation]:
    """Return the edit that replaces the colour in a range, with alpha if it is needed."""
    written = positions.text[positions.offset(place.start) : positions.offset(place.end)]
    with_alpha = len(written.split()) == 4 or color.alpha != 1
    text = written_color((color.red, color.green, color.blue, color.alpha), with_alpha=with_alpha)
    return [types.ColorPresentation(text, types.TextEdit(place, text))]


def add_requests(server: LinkwrightServer) -> None:
    """Register the request handlers of this module."""

    def highlights(path: Path, positions: TextPositions, place: types.Range | None = None) -> types.SemanticTokens:
        found = highlights_in(positions.text, path)
        if place is not None:
            start, end = positions.offset(place.start), positions.offset(place.end)
            found = [highlight for highlight in found if start <= highlight.start and highlight.end <= end]
        return types.SemanticTokens(semantic_tokens(positions, found))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, _LEGEND)
    def semantic_tokens_full(
        server: LinkwrightServer, asked: types.SemanticTokensParams
    ) -> types.SemanticTokens | None:
        path, positions = server.text(asked.text_document)
        return None if positions is None else highlights(path, positions)

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE, _LEGEND)
    def semantic_tokens_range(
        server: LinkwrightServer, asked: types.SemanticTokensRangeParams
    ) -> types.SemanticTokens | None:
        path, positions = server.text(asked.text_document)
        return None if positions is None else highlights(path, positions, asked.range)

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_COLOR)
    def document_color(server: LinkwrightServer, asked: types.DocumentColorParams) -> list[types.ColorInformation]:
        _, positions = server.text(asked.text_document)
        return [] if positions is None else colors(positions)

    @server.feature(types.TEXT_DOCUMENT_COLOR_PRESENTATION)
    def color_presentation(
        server: LinkwrightServer, asked: types.ColorPresentationParams
    ) -> list[types.ColorPresentation]:
        _, positions = server.text(asked.text_document)
        return [] if positions is None else color_edits(positions, asked.range, asked.color)
