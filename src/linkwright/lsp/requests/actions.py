"""Code actions: quick fixes, and refactorings that are proved when the user selects one."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from zlib import crc32

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.extraction import find_selected_value
from linkwright.language.includes import real_path
from linkwright.language.refactoring import Action, Offer, Refactoring, find_offers, refactor
from linkwright.lsp.edits import new_file_edit, to_workspace_edit
from linkwright.lsp.positions import TextPositions
from linkwright.lsp.requests.fixes import quick_fixes, suppression_actions
from linkwright.lsp.server import LinkwrightServer, path_from_uri

_ACTION_KINDS = (
    types.CodeActionKind.QuickFix,
    types.CodeActionKind.SourceFixAll,
    types.CodeActionKind.RefactorExtract,
    types.CodeActionKind.RefactorInline,
    types.CodeActionKind.RefactorRewrite,
)


def _kind_name(kind: types.CodeActionKind | str) -> str:
    return kind.value if isinstance(kind, types.CodeActionKind) else kind


def is_requested(kind: str, only: Sequence[types.CodeActionKind | str] | None) -> bool:
    """Return whether the editor requests a kind of action or one of its parents.

    Args:
        kind: the kind, such as ``refactor.extract``.
        only: the kinds that the editor requests, or None for all.
    """
    return only is None or any(
        f"{kind}.".startswith(f"{requested}." if requested else "") for requested in map(_kind_name, only)
    )


def _may_be_requested(kinds: Iterable[types.CodeActionKind], only: Sequence[types.CodeActionKind | str] | None) -> bool:
    """Return whether the editor requests some kinds, their parents or their subkinds."""
    names = [_kind_name(requested) for requested in only or ()]
    return any(
        is_requested(kind.value, only) or any(name.startswith(f"{kind.value}.") for name in names) for kind in kinds
    )


def _resolves_edits(server: LinkwrightServer) -> bool:
    capabilities = server.client_capabilities.text_document
    actions = None if capabilities is None else capabilities.code_action
    resolve = None if actions is None else actions.resolve_support
    return resolve is not None and "edit" in resolve.properties and bool(actions and actions.data_support)


def _can_create_files(server: LinkwrightServer) -> bool:
    capabilities = server.client_capabilities.workspace
    edits = None if capabilities is None else capabilities.workspace_edit
    return edits is not None and types.ResourceOperationKind.Create in (edits.resource_operations or ())


def _to_workspace_edit(server: LinkwrightServer, refactoring: Refactoring) -> types.WorkspaceEdit:
    if refactoring.new_file is not None:
        return new_file_edit(server.uri_of(refactoring.new_file.file), refactoring.new_file.text)
    return to_workspace_edit(server, refactoring.edits)


async def _prove_refactoring(
    server: LinkwrightServer, action: Action, path: Path, start: int, end: int, texts: Mapping[Path, str]
) -> types.WorkspaceEdit:
    """Return the proved edit of a refactoring.

    Raises:
        LinkwrightError: LANG105, the edits cannot be proved.
        JsonRpcException: ContentModified, a text has changed meanwhile.
    """
    workspace = server.project
    assert workspace is not None
    await server.when_indexed()
    result = await server.run_in_check_thread(lambda: refactor(workspace, texts, action, real_path(path), start, end))
    if server.texts() != texts:
        raise _content_modified_error()
    return _to_workspace_edit(server, result)


def _content_modified_error() -> JsonRpcException:
    message = localized(phrase("a file has changed in the meantime"))
    return JsonRpcException(message, code=int(types.LSPErrorCodes.ContentModified))


async def _offer_refactorings(
    server: LinkwrightServer, offers: Iterable[Offer], path: Path, positions: TextPositions, selection: tuple[int, int]
) -> list[types.CodeAction]:
    """Return the code actions of refactorings, with edits unless the editor resolves these."""
    actions = []
    for offer in offers:
        title, kind = localized(offer.title), offer.action.value
        if _resolves_edits(server):
            resolve_data = {
                "action": offer.action.value,
                "uri": server.uri_of(path),
                "start": selection[0],
                "end": selection[1],
                "checksum": crc32(positions.text.encode()),
            }
            actions.append(types.CodeAction(title, kind, data=resolve_data))
            continue
        try:
            edit = await _prove_refactoring(server, offer.action, path, *selection, server.texts())
        except LinkwrightError:  # An unproved refactoring is not offered.
            continue
        actions.append(types.CodeAction(title, kind, edit=edit))
    return actions


async def _with_edit(server: LinkwrightServer, action: types.CodeAction) -> types.CodeAction:
    """Return an action with its proved edit."""
    data = action.data if isinstance(action.data, dict) else {}
    path, texts = path_from_uri(str(data.get("uri", ""))), server.texts()
    positions = None if path is None else server.positions(path)
    start, end = data.get("start"), data.get("end")
    if path is None or positions is None or not isinstance(start, int) or not isinstance(end, int):
        return action
    if data.get("checksum") != crc32(positions.text.encode()):
        raise _content_modified_error()
    try:
        refactoring = Action(data.get("action"))
    except ValueError:
        return action
    try:
        action.edit = await _prove_refactoring(server, refactoring, path, start, end, texts)
    except LinkwrightError as error:
        message = "\n".join(localized(diagnostic.message) for diagnostic in error.diagnostics)
        raise JsonRpcException(message, code=int(types.LSPErrorCodes.RequestFailed)) from None
    return action


def add_requests(server: LinkwrightServer) -> None:
    """Register the request handlers of this module."""

    @server.feature(types.TEXT_DOCUMENT_CODE_ACTION, types.CodeActionOptions([*_ACTION_KINDS], resolve_provider=True))
    async def code_action(server: LinkwrightServer, params: types.CodeActionParams) -> list[types.CodeAction] | None:
        path = path_from_uri(params.text_document.uri)
        positions = None if path is None else server.positions(path)
        workspace, only = server.project, params.context.only
        if path is None or positions is None or workspace is None:
            return None
        texts = server.texts()
        actions: list[types.CodeAction] = []
        if _may_be_requested(_ACTION_KINDS[:2], only):
            actions += quick_fixes(server, workspace.fixable_findings(real_path(path), texts), params, positions)
            actions += suppression_actions(server, workspace.findings(real_path(path), texts), params, path, positions)
        if _may_be_requested(_ACTION_KINDS[2:], only):
            start, end = positions.offset(params.range.start), positions.offset(params.range.end)
            names = await server.defined_names(path)
            server.check_unchanged(path, positions)
            if end == start + 1 and find_selected_value(positions.text, start, end) is None:
                end = start  # ALE and Helix send the character under their block cursor.
            offers = [
                offer
                for offer in find_offers(positions.text, path, start, end, names)
                if is_requested(offer.action.value, only)
                and (offer.action is not Action.CONVERT_TO_XACRO or _can_create_files(server))
            ]
            actions += await _offer_refactorings(server, offers, path, positions, (start, end))
        return [action for action in actions if is_requested(_kind_name(action.kind or ""), only)]

    @server.feature(types.CODE_ACTION_RESOLVE)
    async def code_action_resolve(server: LinkwrightServer, action: types.CodeAction) -> types.CodeAction:
        return await _with_edit(server, action)
