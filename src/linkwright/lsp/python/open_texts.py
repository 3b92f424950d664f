"""The Python files that are open in an editor, with the findings of each server."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from lsprotocol import types

from linkwright.lsp.positions import TextPositions

Finding = dict[str, Any]
"""A diagnostic of the protocol."""


class OpenText:
    """A Python file that is open in an editor.

    Servers publish their findings at different times, but an editor shows only those that were published last. So the
    findings of each server are kept, and they move with the text until the server has checked it again.

    Args:
        uri: the URI of the file.
        text: the content when the editor opens the file.
        version: the version of the text.
        encoding: the encoding whose code units positions count.

    Attributes:
        uri: the URI of the file.
        version: the version of the text, as the editor counts.
    """

    def __init__(self, uri: str, text: str, version: int, encoding: str) -> None:
        self.uri = uri
        self.version = version
        self._encoding = encoding
        self._positions = TextPositions(text, encoding)
        self._findings: dict[str, list[Finding]] = {}

    @property
    def text(self) -> str:
        """The text, including unsaved changes."""
        return self._positions.text

    def change(self, version: int, changes: Iterable[Mapping[str, Any]]) -> None:
        """Apply changes from the editor, and move the findings with the text.

        Args:
            version: the version of the new text.
            changes: the content changes of the protocol, each for the text after the previous one.
        """
        findings = [finding for own in self._findings.values() for finding in own]
        places = [to_offsets(self._positions, finding["range"]) for finding in findings]
        for change in changes:
            old_text, changed_range = self.text, change.get("range")
            if changed_range is None:
                text = change["text"]
            else:
                start, end = to_offsets(self._positions, changed_range)
                text = old_text[:start] + change["text"] + old_text[end:]
            self._positions = TextPositions(text, self._encoding)
            moved = _Replacement(old_text, text).move
            places = [moved(*offset_pair) for offset_pair in places]
        self.version = version
        for finding, (start, end) in zip(findings, places, strict=True):
            finding["range"] = to_range(self._positions, start, end)

    def set_findings(self, server: str, findings: Sequence[Finding]) -> None:
        """Replace the findings of a server about the current text."""
        self._findings[server] = [dict(finding) for finding in findings]

    def findings(self) -> list[Finding]:
        """Return the findings of all servers."""
        return [finding for findings in self._findings.values() for finding in findings]

    def findings_of(self, server: str) -> list[Finding]:
        """Return the findings of one server."""
        return self._findings.get(server, [])

    def word_before(self, position: Mapping[str, int]) -> str:
        """Return the part of a name before a position."""
        offset = self._positions.offset(_to_position(position))
        start = offset
        while start > 0 and (self.text[start - 1].isalnum() or self.text[start - 1] == "_"):
            start -= 1
        return self.text[start:offset]

    def text_in(self, range_: Mapping[str, Any]) -> str:
        """Return the text of a range."""
        start, end = to_offsets(self._positions, range_)
        return self.text[start:end]


class _Replacement:
    """The smallest range of a text that was replaced, and the length of the replacement."""

    def __init__(self, old_text: str, new_text: str) -> None:
        shortest = min(len(old_text), len(new_text))
        start = next((index for index in range(shortest) if old_text[index] != new_text[index]), shortest)
        max_suffix_length = shortest - start
        suffix_length = next(
            (index for index in range(max_suffix_length) if old_text[-1 - index] != new_text[-1 - index]),
            max_suffix_length,
        )
        self._start, self._end = start, len(old_text) - suffix_length
        self._growth = len(new_text) - len(old_text)

    def move(self, start: int, end: int) -> tuple[int, int]:
        """Return the range in the new text that corresponds to a range of the old text.

        Text that is inserted at one of its ends remains outside the range.
        """
        first = start if start < self._start else self._after(start)
        last = end if end <= self._start else self._after(end)
        return first, max(first, last)

    def _after(self, offset: int) -> int:
        return offset + self._growth if offset >= self._end else self._start


def to_offsets(positions: TextPositions, range_: Mapping[str, Any]) -> tuple[int, int]:
    """Return the character offsets of a range of the protocol."""
    return positions.offset(_to_position(range_["start"])), positions.offset(_to_position(range_["end"]))


def to_range(positions: TextPositions, start: int, end: int) -> dict[str, Any]:
    """Return the range of the protocol between two character offsets."""
    places = {"start": positions.position(start), "end": positions.position(end)}
    return {name: {"line": position.line, "character": position.character} for name, position in places.items()}


def _to_position(position: Mapping[str, int]) -> types.Position:
    return types.Position(position["line"], position["character"])
