"""Diagnostics: findings about a user's input, and the exception that carries them."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

from linkwright.diagnostics.phrase import Phrase, joined
from linkwright.diagnostics.source import SourceText, Span
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from typing_extensions import Self


class Severity(Enum):
    """The severity of a finding; an error makes a command exit with status 1."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


class Note(NamedTuple):
    """Another fact about a diagnostic, with its place, such as a macro call that led there."""

    message: Phrase
    span: Span | None = None


class Diagnostic:
    """One finding: a stable code, what is wrong, where, why, and how to fix it; immutable.

    Two with the same content are equal.

    Attributes:
        code: letters for the room and three digits, such as ``XAC101``; never reused for another meaning.
        message: one sentence without a full stop at its end, with names as the user wrote them.
        span: the place, or None if there is none (a missing file).
        notes: what led to it: includes, macro calls, values.
        hint: how to fix it, or None.
        source: the text that the span is in, for an excerpt; None if it was not stored.
    """

    __slots__ = ("code", "hint", "message", "notes", "severity", "source", "span")

    def __init__(  # by hand: to import dataclasses takes as long as to expand a small file
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

    def but(self, **changes: Any) -> Self:
        """The same diagnostic with other values for some attributes.

        Raises:
            TypeError: for a name that is none of its attributes.
        """
        return type(self)(**{**self._all(), **changes})

    def _fields(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in Diagnostic.__slots__}

    def _all(self) -> dict[str, Any]:
        return self._fields()

    @property
    def placed_message(self) -> Phrase:
        """The message, after its place if it has one."""
        return joined((str(self.span), self.message), ": ") if self.span else self.message


class LinkwrightError(Exception):
    """An error in the user's input, never a bug of Linkwright; it has at least one diagnostic."""

    def __init__(self, *diagnostics: Diagnostic) -> None:
        if not diagnostics:
            raise ValueError("a LinkwrightError needs a diagnostic")
        super().__init__(diagnostics[0].message)
        self.diagnostics: tuple[Diagnostic, ...] = diagnostics

    def __str__(self) -> str:
        return "\n".join(
            f"{diagnostic.span}: {diagnostic.message}" if diagnostic.span else diagnostic.message
            for diagnostic in self.diagnostics
        )


def in_one_line(diagnostics: Iterable[Diagnostic]) -> Phrase:
    """Join the messages of several diagnostics."""
    return joined((diagnostic.message for diagnostic in diagnostics), "; ")


def has_errors(diagnostics: Iterable[Diagnostic]) -> bool:
    """Return whether any of them is an error."""
    return any(diagnostic.severity is Severity.ERROR for diagnostic in diagnostics)
