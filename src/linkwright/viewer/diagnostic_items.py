"""Diagnostics for the page."""

from __future__ import annotations

from linkwright.diagnostics import Diagnostic, translated
from linkwright.viewer.protocol import DiagnosticItem, DiagnosticNote


def item_of(diagnostic: Diagnostic) -> DiagnosticItem:
    """A diagnostic as the page shows it, in the language of the terminal, with the line of source it points to."""
    (diagnostic,) = translated([diagnostic])
    span, source = diagnostic.span, diagnostic.source
    excerpt = source.line(span.line) if span and source and source.name == span.file else ""
    return DiagnosticItem(
        code=diagnostic.code,
        severity=diagnostic.severity.value,
        message=diagnostic.message,
        file=span.file if span else None,
        line=span.line if span else None,
        column=span.column if span else None,
        end_line=span.end_line if span else None,
        end_column=span.end_column if span else None,
        excerpt=excerpt,
        notes=[
            DiagnosticNote(
                message=note.message,
                file=note.span.file if note.span else None,
                line=note.span.line if note.span else None,
                column=note.span.column if note.span else None,
            )
            for note in diagnostic.notes
        ],
        hints=[diagnostic.hint] if diagnostic.hint else [],
    )
