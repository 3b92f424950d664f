"""Diagnostics, their positions in source texts, and the exception that carries them.

A diagnostic is a finding about a user's input. Inside the program, positions are character offsets, which are cheap to
pass on. Lines and columns are computed only for a `Span`.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from enum import Enum

from linkwright.diagnostics.phrase import Phrase, joined, phrase
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pathlib import Path

    from typing_extensions import Self


_POINTER_START = b"version https://git-lfs.github.com/spec/"
POINTER_REASON = phrase("it is only a Git LFS pointer")
POINTER_HINT = phrase("run `git lfs pull` in its repository")


def is_pointer(data: bytes) -> bool:
    """Return whether the content or the beginning of a file is a Git LFS pointer."""
    return data.startswith(_POINTER_START)


def is_pointer_file(path: Path) -> bool:
    """Return whether a file can be read and is a Git LFS pointer."""
    try:
        with path.open("rb") as file:
            return is_pointer(file.read(len(_POINTER_START)))
    except OSError:
        return False


TEXT_NAME = "<robot_description>"
"""The name in messages of a description that was passed as text, not as a path."""


def is_text(path_or_text: object) -> bool:
    """Return whether a description was passed as text, not as a path.

    A text is recognized by a ``<`` in it.
    """
    return isinstance(path_or_text, str) and "<" in path_or_text


class Span(NamedTuple):
    """A range in a file.

    Lines and columns count from 1, columns count characters, and the end is exclusive.
    """

    file: str
    line: int
    column: int
    end_line: int
    end_column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


class SourceText:
    """A named text that converts character offsets to lines and columns.

    Args:
        name: the name of the text for the user: a path, or a name in angle brackets such as ``<stdin>``.
        text: the entire text, with the line endings of the file.
    """

    __slots__ = ("_starts", "name", "text")

    def __init__(self, name: str, text: str) -> None:
        self.name = name
        self.text = text
        self._starts: list[int] | None = None

    def __repr__(self) -> str:
        return f"SourceText({self.name!r}, {len(self.text)} characters)"

    def position(self, offset: int) -> tuple[int, int]:
        """Return the line and column, both from 1, of a character offset.

        The offset is clamped to the text.
        """
        starts = self._find_line_starts()
        offset = max(0, min(offset, len(self.text)))
        line = bisect_right(starts, offset)
        return line, offset - starts[line - 1] + 1

    def offset(self, line: int, column: int) -> int:
        """Return the character offset of a line and column, both from 1.

        The result is clamped to the text.
        """
        starts = self._find_line_starts()
        start = starts[max(0, min(line - 1, len(starts) - 1))]
        return min(start + column - 1, len(self.text))

    def span(self, start: int, end: int | None = None) -> Span:
        """Return the span between two character offsets, or of one character if `end` is None."""
        line, column = self.position(start)
        end_line, end_column = self.position(start + 1 if end is None else end)
        return Span(self.name, line, column, end_line, end_column)

    def line(self, number: int) -> str:
        """Return a line, counted from 1, without its line end.

        The result is an empty string if there is no such line.
        """
        starts = self._find_line_starts()
        if not 1 <= number <= len(starts):
            return ""
        end = starts[number] if number < len(starts) else len(self.text)
        return self.text[starts[number - 1] : end].rstrip("\r\n")

    def _find_line_starts(self) -> list[int]:
        if self._starts is None:
            starts = [0]
            find = self.text.find
            newline = find("\n")
            while newline >= 0:
                starts.append(newline + 1)
                newline = find("\n", newline + 1)
            self._starts = starts
        return self._starts


class Severity(Enum):
    """The severity of a finding.

    An error makes a command exit with status 1.
    """

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


class Note(NamedTuple):
    """A fact that belongs to a diagnostic, and its position.

    An example is the macro call that led to the diagnostic.
    """

    message: Phrase
    span: Span | None = None


class Diagnostic:
    """A finding with a stable code, a message, a location, notes and a hint.

    Diagnostics are immutable. Two diagnostics with the same content are equal.

    Attributes:
        code: letters for the package and three digits, such as ``XAC101``. A code is never reused with another meaning.
        message: one sentence without a full stop, with names as the user wrote them.
        span: the position; None if there is none, as for a missing file.
        notes: the causes of the finding: includes, macro calls, values.
        hint: advice for fixing the problem, or None.
        source: the text that contains the span, from which an excerpt is shown; None if it is not available.
    """

    __slots__ = ("code", "hint", "message", "notes", "severity", "source", "span")

    def __init__(  # written by hand, because importing dataclasses takes as long as expanding a small file
        self,
        code: str,
        message: Phrase,
        span: Span | None = None,
        severity: Severity = Severity.ERROR,
        notes: tuple[Note, ...] = (),
        hint: Phrase | None = None,
        source: SourceText | None = None,
    ) -> None:
        self.code = code
        self.message = message
        self.span = span
        self.severity = severity
        self.notes = notes
        self.hint = hint
        self.source = source

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Diagnostic) and self._fields() == other._fields()

    def __hash__(self) -> int:
        return hash((self.code, self.message, self.span))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in self._fields().items())})"

    def with_changes(self, **changes: Any) -> Self:
        """Return a copy of the diagnostic with other values for some attributes.

        Raises:
            TypeError: a name is not an attribute.
        """
        return type(self)(**{**self._all_fields(), **changes})

    def _fields(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in Diagnostic.__slots__}

    def _all_fields(self) -> dict[str, Any]:
        return self._fields()

    @property
    def located_message(self) -> Phrase:
        """The message, preceded by its position if there is one."""
        return joined((str(self.span), self.message), ": ") if self.span else self.message


class LinkwrightError(Exception):
    """Raised for an error in the user's input, never for a bug in Linkwright.

    The exception has one or more diagnostics.
    """

    def __init__(self, *diagnostics: Diagnostic) -> None:
        if not diagnostics:
            raise ValueError("a LinkwrightError needs a diagnostic")
        super().__init__(diagnostics[0].message)
        self.diagnostics: tuple[Diagnostic, ...] = diagnostics

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore_error, (type(self), self.args), self.__dict__

    def __str__(self) -> str:
        return "\n".join(
            f"{diagnostic.span}: {diagnostic.message}" if diagnostic.span else diagnostic.message
            for diagnostic in self.diagnostics
        )


def _restore_error(error_type: type[LinkwrightError], args: tuple[object, ...]) -> LinkwrightError:
    """Create an error that another process has pickled, without calling its constructor.

    `pickle` then sets the attributes.
    """
    return error_type.__new__(error_type, *args)


def join_messages(diagnostics: Iterable[Diagnostic]) -> Phrase:
    """Join the messages of several diagnostics into one line."""
    return joined((diagnostic.message for diagnostic in diagnostics), "; ")


def has_errors(diagnostics: Iterable[Diagnostic]) -> bool:
    """Return whether any of the diagnostics is an error."""
    return any(diagnostic.severity is Severity.ERROR for diagnostic in diagnostics)
