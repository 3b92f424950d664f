"""Source texts and places in them.

Positions inside the program are character offsets, which cost nothing to carry. Lines and columns are computed only for
a `Span`.
"""

from __future__ import annotations

from bisect import bisect_right

from linkwright.diagnostics.phrase import phrase
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path


_BEGINS = b"version https://git-lfs.github.com/spec/"
IS_POINTER = phrase("it is only a pointer of Git LFS")
FETCH = phrase("run `git lfs pull` in its repository")


def is_pointer(data: bytes) -> bool:
    """Return whether the bytes of a file, or the first of them, are such a pointer."""
    return data.startswith(_BEGINS)


def is_pointer_file(path: Path) -> bool:
    """Return whether a file is one; False where it cannot be read."""
    try:
        with path.open("rb") as file:
            return is_pointer(file.read(len(_BEGINS)))
    except OSError:
        return False


TEXT_NAME = "<robot_description>"
"""The name, in messages, of a description that is given as a text."""


def is_text(path_or_text: object) -> bool:
    """Return whether a description is given as a text, which is known by its ``<``, and not as a path."""
    return isinstance(path_or_text, str) and "<" in path_or_text


class Span(NamedTuple):
    """A place in a file: lines and columns count from 1, columns count characters, the end is exclusive."""

    file: str
    line: int
    column: int
    end_line: int
    end_column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


class SourceText:
    """A text with a name, which turns character offsets into lines and columns.

    Args:
        name: what a reader knows the text by: a path, or a name in angle brackets such as ``<stdin>``.
        text: the whole text, with line ends as they are in the file.
    """

    __slots__ = ("_starts", "name", "text")

    def __init__(self, name: str, text: str) -> None:
        self.name = name
        self.text = text
        self._starts: list[int] | None = None

    def __repr__(self) -> str:
        return f"SourceText({self.name!r}, {len(self.text)} characters)"

    def position(self, offset: int) -> tuple[int, int]:
        """Line and column, both from 1, of a character offset (clamped into the text)."""
        starts = self._line_starts()
        offset = max(0, min(offset, len(self.text)))
        line = bisect_right(starts, offset)
        return line, offset - starts[line - 1] + 1

    def offset(self, line: int, column: int) -> int:
        """Character offset of a line and column, both from 1 (clamped into the text)."""
        starts = self._line_starts()
        start = starts[max(0, min(line - 1, len(starts) - 1))]
        return min(start + column - 1, len(self.text))

    def span(self, start: int, end: int | None = None) -> Span:
        """The span from one character offset to another; without an end, one character."""
        line, column = self.position(start)
        end_line, end_column = self.position(start + 1 if end is None else end)
        return Span(self.name, line, column, end_line, end_column)

    def line(self, number: int) -> str:
        """The text of one line, counted from 1, without its line end; empty when there is no such line."""
        starts = self._line_starts()
        if not 1 <= number <= len(starts):
            return ""
        end = starts[number] if number < len(starts) else len(self.text)
        return self.text[starts[number - 1] : end].rstrip("\r\n")

    def _line_starts(self) -> list[int]:
        if self._starts is None:
            starts = [0]
            find = self.text.find
            at = find("\n")
            while at >= 0:
                starts.append(at + 1)
                at = find("\n", at + 1)
            self._starts = starts
        return self._starts
