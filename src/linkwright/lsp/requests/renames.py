"""References and renaming."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from linkwright.diagnostics import LinkwrightError, joined, phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.file_renaming import rename_file
from linkwright.language.includes import real_path
from linkwright.language.mentions import Mention
from linkwright.language.occurrences import Occurrence
from linkwright.language.proof import Edit
from linkwright.language.renamable_names import RenamableName, renamable_name_at, rename_name
from linkwright.language.renaming import find_references, occurrence_at
from linkwright.language.uses import find_uses
from linkwright.lsp.edits import to_workspace_edit
from linkwright.lsp.requests.names import target_locations
from linkwright.lsp.server import LinkwrightServer, path_from_uri


def _uncertain_mentions_message(server: LinkwrightServer, mentions: Iterable[Mention]) -> str:
    """Return the text of a message that lists the mentions, each with its file and line."""
    locations = []
    for mention in dict.fromkeys(mentions):
        positions = server.positions(mention.file)
        line = 0 if positions is None else positions.position(mention.start).line + 1
        locations.append(f"{mention.file.name}:{line} ({mention.name})")
    return localized(
        phrase("these texts are not renamed, because their meaning is uncertain: {places}", places=joined(locations))
    )


def make_file_edits(server: LinkwrightServer, files: Iterable[types.FileRename]) -> tuple[list[Edit], list[Mention]]:
    """Return the edits that keep references to renamed files valid, and uncertain mentions."""
    edits: list[Edit] = []
    unchanged: list[Mention] = []
    for file in files:
        old, new = path_from_uri(file.old_uri), path_from_uri(file.new_uri)
        if server.project is not None and old is not None and new is not None and old.is_file():
            renaming = rename_file(server.project, server.texts(), real_path(old), real_path(new))
            edits += renaming.edits
            unchanged += renaming.unchanged
    return edits, unchanged


def add_requests(server: LinkwrightServer) -> None:
    """Register the request handlers of this module."""

    def texts_and_name(
        server: LinkwrightServer, document: types.TextDocumentIdentifier, position: types.Position
    ) -> tuple[Mapping[Path, str], Occurrence | None]:
        path, positions = server.xml_text(document)
        if positions is None or server.project is None:
            return {}, None
        return server.texts(), occurrence_at(positions.text, real_path(path), positions.offset(position))

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    async def references_request(
        server: LinkwrightServer, params: types.ReferenceParams
    ) -> list[types.Location] | None:
        context = await server.indexed_format_context(params.text_document)
        if context is not None:
            offset = context.positions.offset(params.position)
            uses = await server.run_in_check_thread(lambda: find_uses(context.document, context.format, offset))
            use_locations = [*target_locations(uses, server.positions, server.uri_of)]
            if use_locations:
                return use_locations[0 if params.context.include_declaration else 1 :]
        texts, name = texts_and_name(server, params.text_document, params.position)
        if name is None or server.project is None:
            return None
        await server.when_indexed()
        locations = []
        for other in find_references(server.project, texts, name):
            positions = server.positions(other.file)
            if positions is not None and (params.context.include_declaration or not other.is_definition):
                locations.append(types.Location(server.uri_of(other.file), positions.range(other.start, other.end)))
        return locations

    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    async def prepare_rename_request(
        server: LinkwrightServer, params: types.PrepareRenameParams
    ) -> types.PrepareRenamePlaceholder | None:
        renamable = await find_renamable_name(server, params.text_document, params.position)
        positions = None if renamable is None else server.positions(renamable.file)
        if renamable is None or positions is None:
            return None
        return types.PrepareRenamePlaceholder(positions.range(renamable.start, renamable.end), renamable.name)

    async def find_renamable_name(
        server: LinkwrightServer, document: types.TextDocumentIdentifier, position: types.Position
    ) -> RenamableName | None:
        path, positions = server.xml_text(document)
        workspace = server.project
        if positions is None or workspace is None:
            return None
        await server.when_indexed()
        texts, offset = server.texts(), positions.offset(position)
        return await server.run_in_check_thread(lambda: renamable_name_at(workspace, texts, real_path(path), offset))

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    async def rename_request(server: LinkwrightServer, params: types.RenameParams) -> types.WorkspaceEdit | None:
        texts = server.texts()
        renamable = await find_renamable_name(server, params.text_document, params.position)
        workspace = server.project
        if renamable is None or workspace is None:
            return None
        try:
            renaming = await server.run_in_check_thread(
                lambda: rename_name(workspace, texts, renamable, params.new_name)
            )
        except LinkwrightError as error:
            message = "\n".join(localized(diagnostic.message) for diagnostic in error.diagnostics)
            raise JsonRpcException(message, code=int(types.LSPErrorCodes.RequestFailed)) from None
        if server.texts() != texts:  # The offsets of the edits refer to the former texts.
            message = localized(phrase("a file has changed in the meantime; rename again"))
            raise JsonRpcException(message, code=int(types.LSPErrorCodes.ContentModified))
        notes = [localized(note) for note in renaming.notes]
        if renaming.unchanged:
            notes.append(_uncertain_mentions_message(server, renaming.unchanged))
        if notes:
            server.window_show_message(types.ShowMessageParams(types.MessageType.Info, "\n".join(notes)))
        return to_workspace_edit(server, renaming.edits)

    files = types.FileOperationFilter(types.FileOperationPattern("**/*"), "file")

    @server.feature(types.WORKSPACE_WILL_RENAME_FILES, types.FileOperationRegistrationOptions([files]))
    async def will_rename_files(
        server: LinkwrightServer, params: types.RenameFilesParams
    ) -> types.WorkspaceEdit | None:
        await server.when_indexed()
        texts = server.texts()
        edits, unchanged = await server.run_in_check_thread(lambda: make_file_edits(server, params.files))
        if server.texts() != texts:  # The editor renames the file without edits.
            return None
        if unchanged:
            server.window_show_message(
                types.ShowMessageParams(types.MessageType.Info, _uncertain_mentions_message(server, unchanged))
            )
        return to_workspace_edit(server, edits) if edits else None
