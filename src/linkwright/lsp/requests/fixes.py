"""Quick fixes: fixes of findings, all safe fixes, and comments that suppress findings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from lsprotocol import types

from linkwright.diagnostics import Diagnostic, Span, phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.includes import real_path
from linkwright.language.proof import Edit
from linkwright.language.suppressions import make_suppression
from linkwright.lint.finding import Finding
from linkwright.lint.fix import Fix
from linkwright.lsp.edits import to_workspace_edit
from linkwright.lsp.positions import TextPositions
from linkwright.lsp.server import LinkwrightServer


def quick_fixes(
    server: LinkwrightServer, findings: Sequence[Finding], params: types.CodeActionParams, positions: TextPositions
) -> Iterator[types.CodeAction]:
    """Yield a fix for each finding in a range, and one action for all safe fixes.

    Args:
        server: the language server.
        findings: the findings about the file that have a fix.
        params: the request, with the range and the diagnostics that the editor shows there.
        positions: the text of the file.
    """
    for finding in findings:
        edits = _select_edits([finding.fix] if finding.fix is not None else [])
        if finding.fix is None or not edits or not _is_on_lines(finding.span, params.range, positions):
            continue
        title = localized(finding.hint) if finding.hint else localized(phrase("fix {code}", code=finding.code))
        yield types.CodeAction(
            title,
            types.CodeActionKind.QuickFix,
            _find_shown_diagnostics(params, finding) or None,
            is_preferred=finding.fix.safe,
            edit=to_workspace_edit(server, edits),
        )
    edits = _select_edits([finding.fix for finding in findings if finding.fix is not None and finding.fix.safe])
    if edits:
        title = localized(phrase("apply all safe fixes in this file"))
        yield types.CodeAction(title, types.CodeActionKind.SourceFixAll, edit=to_workspace_edit(server, edits))


def suppression_actions(
    server: LinkwrightServer,
    findings: Iterable[Diagnostic],
    params: types.CodeActionParams,
    path: Path,
    positions: TextPositions,
) -> Iterator[types.CodeAction]:
    """Yield the comments that suppress the findings in a range, with a placeholder reason.

    Args:
        server: the language server.
        findings: the findings about the file.
        params: the request, with the range and the diagnostics that the editor shows there.
        path: the file.
        positions: the text of the file.
    """
    edits: dict[Edit, tuple[str, list[types.Diagnostic]]] = {}
    for finding in findings:
        if finding.span is not None and _is_on_lines(finding.span, params.range, positions):
            offset = positions.offset(positions.range_of(finding.span).start)
            edit = make_suppression(positions.text, real_path(path), finding.code, offset)
            if edit is not None:
                edits.setdefault(edit, (finding.code, []))[1].extend(_find_shown_diagnostics(params, finding))
    for edit, (code, message) in edits.items():
        title = localized(phrase("ignore {code} here, with a reason", code=code))
        yield types.CodeAction(
            title, types.CodeActionKind.QuickFix, message or None, edit=to_workspace_edit(server, [edit])
        )


def _is_on_lines(span: Span | None, range_: types.Range, positions: TextPositions) -> bool:
    """Return whether a finding is on the lines of a range."""
    if span is None:
        return False
    finding_range = positions.range_of(span)
    return finding_range.end.line >= range_.start.line and finding_range.start.line <= range_.end.line


def _find_shown_diagnostics(params: types.CodeActionParams, finding: Diagnostic) -> list[types.Diagnostic]:
    return [diagnostic for diagnostic in params.context.diagnostics if diagnostic.code == finding.code]


def _select_edits(fixes: Iterable[Fix]) -> list[Edit]:
    """Return the edits of the fixes, except fixes that overlap earlier ones."""
    edits: list[Edit] = []
    for fix in fixes:
        new = [
            Edit(real_path(replacement.source_file), replacement.start, replacement.end, replacement.replacement)
            for replacement in fix.edits
        ]
        if all(_fits(edit, edits) for edit in new):
            edits += new
    return edits


def _fits(edit: Edit, others: Iterable[Edit]) -> bool:
    return all(edit.file != other.file or edit.end < other.start or other.end < edit.start for other in others)
