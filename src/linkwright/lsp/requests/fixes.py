"""Code actions: the fixes of findings."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from lsprotocol import types

from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.includes import real
from linkwright.lint.finding import Finding
from linkwright.lint.fix import Fix
from linkwright.lsp.positions import TextOf
from linkwright.lsp.server import LinkwrightServer


def actions(
    findings: Sequence[Finding],
    wanted: types.Range,
    positions: TextOf,
    uri: Callable[[Path], str],
    reported: Iterable[types.Diagnostic],
) -> list[types.CodeAction]:
    """Return the fixes of the findings about a file that touch a range, and a fix of all safe ones.

    Args:
        findings: the findings about the file that have a fix.
        wanted: the range that the editor asks about.
        positions: the texts of files.
        uri: returns the URI that the editor has for a file.
        reported: the diagnostics that the editor shows there.
    """
    found = []
    for finding in findings:
        own = positions(Path(finding.span.file)) if finding.span is not None else None
        if own is None or finding.span is None or finding.fix is None:
            continue
        place = own.range_of(finding.span)
        if place.end.line < wanted.start.line or place.start.line > wanted.end.line:
            continue
        edit = _edit([finding.fix], positions, uri)
        if edit is not None:
            title = localized(finding.hint) if finding.hint else localized(phrase("fix {code}", code=finding.code))
            about = [diagnostic for diagnostic in reported if diagnostic.code == finding.code]
            found.append(
                types.CodeAction(
                    title, types.CodeActionKind.QuickFix, about or None, is_preferred=finding.fix.safe, edit=edit
                )
            )
    safe = [finding.fix for finding in findings if finding.fix is not None and finding.fix.safe]
    edit = _edit(safe, positions, uri)
    if edit is not None:
        title = localized(phrase("fix everything that is safe to fix in this file"))
        found.append(types.CodeAction(title, types.CodeActionKind.SourceFixAll, edit=edit))
    return found


def _edit(fixes: Iterable[Fix], positions: TextOf, uri: Callable[[Path], str]) -> types.WorkspaceEdit | None:
    """Return the edits of fixes that do not overlap earlier ones; None if there is none."""
    changed: dict[str, list[tuple[int, int, types.TextEdit]]] = {}
    for fix in fixes:
        new: list[tuple[str, tuple[int, int, types.TextEdit]]] = []
        for edit in fix.edits:
            text = positions(Path(edit.source_file))
            if text is None:
                break
            place = types.TextEdit(text.range(edit.start, edit.end), edit.replacement)
            new.append((uri(Path(edit.source_file)), (edit.start, edit.end, place)))
        else:
            if all(_fits(edit, changed.get(file, ())) for file, edit in new):
                for file, edit_of_file in new:
                    changed.setdefault(file, []).append(edit_of_file)
    edits = {file: [edit for *_, edit in sorted(found, key=lambda each: each[:2])] for file, found in changed.items()}
    return types.WorkspaceEdit(edits) if edits else None


def _fits(edit: tuple[int, int, types.TextEdit], others: Iterable[tuple[int, int, types.TextEdit]]) -> bool:
    return all(edit[1] <= start or end <= edit[0] for start, end, _ in others)


def add_requests(server: LinkwrightServer) -> None:
    """Add the requests of this module to a server."""
    kinds = types.CodeActionOptions([types.CodeActionKind.QuickFix, types.CodeActionKind.SourceFixAll])

    @server.feature(types.TEXT_DOCUMENT_CODE_ACTION, kinds)
    def code_action(server: LinkwrightServer, asked: types.CodeActionParams) -> list[types.CodeAction] | None:
        path, positions = server.text(asked.text_document)
        if positions is None or server.project is None:
            return None
        found = server.project.fixable(real(path), server.texts())
        return actions(found, asked.range, server.positions, server.uri_of, asked.context.diagnostics)
