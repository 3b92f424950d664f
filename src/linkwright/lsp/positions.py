"""Positions of the protocol: lines from 0 and, by default, UTF-16 code units in them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from lsprotocol import types

from linkwright.diagnostics import SourceText, Span

UTF_16 = types.PositionEncodingKind.Utf16
_UNITS = {
    types.PositionEncodingKind.Utf8: ("utf-8", 1),
    types.PositionEncodingKind.Utf16: ("utf-16-le", 2),
    types.PositionEncodingKind.Utf32: ("utf-32-le", 4),
}


class TextPositions:
    """The conversion between character offsets of a text and positions of the protocol.

    Args:
        text: the text of a file.
        encoding: the encoding whose code units a position counts.
    """

    def __init__(self, text: str, encoding: types.PositionEncodingKind | str = UTF_16) -> None:
        self.text = text
        self._source = SourceText("", text)
        self._codec, self._bytes = _UNITS[types.PositionEncodingKind(encoding)]

    def offset(self, position: types.Position) -> int:
        """Return the character offset of a position, at most the end of its line."""
        line = self._source.line(position.line + 1)
        start = self._source.offset(position.line + 1, 1)
        if line.isascii():
            return start + min(position.character, len(line))
        units = line.encode(self._codec)[: position.character * self._bytes]
        return start + len(units.decode(self._codec, "ignore"))

    def position(self, offset: int) -> types.Position:
        """Return the position of a character offset."""
        line, column = self._source.position(offset)
        return self._position_at(line, column)

    def range(self, start: int, end: int) -> types.Range:
        """Return the range between two character offsets, with an exclusive end."""
        return types.Range(self.position(start), self.position(end))

    def range_of(self, span: Span) -> types.Range:
        """Return the range of a span, whose lines and columns count from 1."""
        return types.Range(self._position_at(span.line, span.column), self._position_at(span.end_line, span.end_column))

    def whole(self) -> types.Range:
        """Return the range of the whole text."""
        return self.range(0, len(self.text))

    def _position_at(self, line: int, column: int) -> types.Position:
        prefix = self._source.line(line)[: column - 1]
        units = len(prefix) if prefix.isascii() else len(prefix.encode(self._codec)) // self._bytes
        return types.Position(line - 1, units)


PositionsOf = Callable[[Path], TextPositions | None]
"""A function that returns the positions of a file's text, or None if the file cannot be read."""
