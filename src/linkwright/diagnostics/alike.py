"""Group similar findings."""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics.diagnostic import Diagnostic, Note
from linkwright.diagnostics.phrase import as_phrase, counted

_MAX_UNGROUPED = 3
"""The maximum number of similar findings that are shown one by one."""
_MAX_LISTED_PLACES = 2
"""The number of findings of a group that are shown besides the first."""


def group_similar(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Replace each large group of similar diagnostics by its first, with notes on the others.

    Diagnostics are similar if they have the same code and severity, and their messages differ only in names and
    numbers.
    """
    groups: dict[object, list[Diagnostic]] = {}
    for diagnostic in diagnostics:
        groups.setdefault((diagnostic.code, diagnostic.severity, as_phrase(diagnostic.message).template), []).append(
            diagnostic
        )
    return [
        diagnostic
        for group in groups.values()
        for diagnostic in (group if len(group) <= _MAX_UNGROUPED else [_summarize(group)])
    ]


def _summarize(group: list[Diagnostic]) -> Diagnostic:
    first, *others = group
    notes = [Note(other.message, other.span) for other in others[:_MAX_LISTED_PLACES]]
    hidden_count = len(others) - _MAX_LISTED_PLACES
    notes.append(
        Note(
            counted(
                "and {count} more like it (--all shows it)", "and {count} more like it (--all shows them)", hidden_count
            )
        )
    )
    return first.with_changes(notes=(*first.notes, *notes))
