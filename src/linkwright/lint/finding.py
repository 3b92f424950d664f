"""The findings of rules: diagnostics, some with a fix."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.diagnostics import Diagnostic, Note, Phrase, Severity, SourceText, Span, phrase
from linkwright.lint.fix import Fix
from linkwright.loading.lean_typing import Any
from linkwright.xmltree import Element

_MAX_NOTES = 10


class Finding(Diagnostic):
    """A diagnostic that a rule reports.

    Attributes:
        fix: a change to the source that fixes the problem, or None if only the author can fix it.
        element: the element that the finding is about. The engine adds notes on the macro calls and includes that
            produced the element.
    """

    __slots__ = ("element", "fix")

    def __init__(
        self,
        code: str,
        message: Phrase,
        span: Span | None = None,
        severity: Severity = Severity.ERROR,
        notes: tuple[Note, ...] = (),
        hint: Phrase | None = None,
        source: SourceText | None = None,
        fix: Fix | None = None,
        element: Element | None = None,
    ) -> None:
        super().__init__(code, message, span, severity, notes, hint, source)
        self.fix = fix
        self.element = element

    def _all_fields(self) -> dict[str, Any]:
        return {**self._fields(), "fix": self.fix, "element": self.element}


def with_related(first: Diagnostic, others: Sequence[Diagnostic]) -> Diagnostic:
    """Return the first of several findings with one cause, with a note for each of the others."""
    if not others:
        return first
    notes = tuple(Note(other.message, other.span) for other in others[:_MAX_NOTES])
    if len(others) > _MAX_NOTES:
        notes += (Note(phrase("and {count} more", count=len(others) - _MAX_NOTES)),)
    message = phrase("{message} (and {count} more)", message=first.message, count=len(others))
    return first.with_changes(message=message, notes=(*first.notes, *notes))


def without_element(diagnostic: Diagnostic) -> Diagnostic:
    """Return a finding without its element, which would keep the description in memory."""
    return diagnostic.with_changes(element=None) if isinstance(diagnostic, Finding) else diagnostic
