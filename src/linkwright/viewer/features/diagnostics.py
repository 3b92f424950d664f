"""What is wrong with the description, for the pages."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.diagnostics import Diagnostic, translated
from linkwright.viewer.features.page_feature import FeatureHost, PageFeature
from linkwright.viewer.protocol.diagnostics import DiagnosticItem, DiagnosticNote, Diagnostics
from linkwright.viewer.protocol.message import ServerMessage


class DiagnosticsFeature(PageFeature):
    """Shows every page what is wrong with the description."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._shown = Diagnostics([])

    def opening(self) -> list[ServerMessage]:
        """What is wrong now."""
        return [self._shown]

    def diagnostics_changed(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Show other findings; none clears the list."""
        self._shown = Diagnostics([item_of(each) for each in diagnostics])
        self.context.pages.publish(self._shown)


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
