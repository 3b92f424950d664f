"""Grouping of similar findings that occur in many places."""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics.diagnostic import Diagnostic, Note
from linkwright.diagnostics.phrase import as_phrase, counted

_FEW = 3
"""So many are shown one by one."""
_PLACES = 2
"""So many places are named besides the first."""


def group_similar(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Reduce each large group of similar diagnostics to the first, plus a count of the others.

    Diagnostics are similar if they have the same code and severity, and their messages differ only in names and
    numbers.
    """
    groups: dict[object, list[Diagnostic]] = {}
    for diagnostic in diagnostics:
        groups.setdefault((diagnostic.code, diagnostic.severity, as_phrase(diagnostic.message).template), []).append(
            diagnostic
        )
    return [
        diagnostic for group in groups.values() for diagnostic in (group if len(group) <= _FEW else [_together(group)])
    ]


def _together(group: list[Diagnostic]) -> Diagnostic:
    first, *others = group
    notes = [Note(other.message, other.span) for other in others[:_PLACES]]
    rest = len(others) - _PLACES
    notes.append(
        Note(counted("and {count} more like it (--all shows it)", "and {count} more like it (--all shows them)", rest))
    )
    return first.with_changes(notes=(*first.notes, *notes))
