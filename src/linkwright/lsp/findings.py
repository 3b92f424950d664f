"""Findings as diagnostics of the protocol."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from lsprotocol import types

from linkwright.diagnostics import Diagnostic, Severity, Span
from linkwright.diagnostics.translation import localized
from linkwright.lsp.positions import PositionsOf
from linkwright.lsp.rule_pages import page_uri

_SEVERITIES = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    Severity.INFO: types.DiagnosticSeverity.Information,
}
_UNNECESSARY_WORDS = ("unused", "unreachable")
_FILE_START = types.Range(types.Position(0, 0), types.Position(0, 0))


def as_diagnostics(
    findings: Iterable[Diagnostic],
    positions_of: PositionsOf,
    uri_of: Callable[[Path], str],
    *,
    links_pages: bool = False,
) -> list[types.Diagnostic]:
    """Convert the findings about a file to diagnostics of the protocol.

    Args:
        findings: the findings about one file.
        positions_of: returns the positions of a file's text.
        uri_of: returns the URI that the editor uses for a file.
        links_pages: whether the editor opens the page of a rule by its URI.
    """
    diagnostics = [_to_diagnostic(finding, positions_of, uri_of) for finding in findings]
    if links_pages:
        for diagnostic in diagnostics:
            diagnostic.code_description = types.CodeDescription(page_uri(str(diagnostic.code)))
    return diagnostics


def _to_diagnostic(finding: Diagnostic, positions_of: PositionsOf, uri_of: Callable[[Path], str]) -> types.Diagnostic:
    hint = f"\n{localized(finding.hint)}" if finding.hint else ""
    notes = [f"\n{localized(note.message)}" for note in finding.notes if note.span is None]
    related = [
        types.DiagnosticRelatedInformation(
            types.Location(uri_of(Path(note.span.file)), _to_range(note.span, positions_of)), localized(note.message)
        )
        for note in finding.notes
        if note.span is not None
    ]
    return types.Diagnostic(
        _FILE_START if finding.span is None else _to_range(finding.span, positions_of),
        localized(finding.message) + hint + "".join(notes),
        _SEVERITIES[finding.severity],
        code=finding.code,
        source="linkwright",
        tags=_find_tags(finding) or None,
        related_information=related or None,
    )


def _to_range(span: Span, positions_of: PositionsOf) -> types.Range:
    text_positions = positions_of(Path(span.file))
    return _FILE_START if text_positions is None else text_positions.range_of(span)


def _find_tags(finding: Diagnostic) -> list[types.DiagnosticTag]:
    from linkwright.lint.registry import find_rule

    rule = find_rule(finding.code)
    is_unnecessary = rule is not None and any(word in rule.name for word in _UNNECESSARY_WORDS)
    return [types.DiagnosticTag.Unnecessary] if is_unnecessary else []
