"""The language server with all of its features."""

from __future__ import annotations

from pathlib import Path

from lsprotocol import types

from linkwright.lsp.client_features import watch_files
from linkwright.lsp.requests import (
    actions,
    appearance,
    expansions,
    hints,
    names,
    navigation,
    renames,
    robot_pages,
    texts,
    virtual_documents,
)
from linkwright.lsp.server import LinkwrightServer, path_from_uri

_FILES_AND_FOLDERS = types.FileOperationRegistrationOptions(
    [types.FileOperationFilter(types.FileOperationPattern("**/*"), "file")]
)


def make_server() -> LinkwrightServer:
    """Return a server with all features."""
    server = LinkwrightServer()

    @server.feature(types.INITIALIZED)
    async def initialized(server: LinkwrightServer, _: types.InitializedParams) -> None:
        server.open_folders(_list_folders(server))
        await watch_files(server)

    @server.feature(types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS)
    def did_change_workspace_folders(server: LinkwrightServer, _: types.DidChangeWorkspaceFoldersParams) -> None:
        server.open_folders(_list_folders(server))

    @server.feature(types.SHUTDOWN)
    def shutdown(server: LinkwrightServer, _: None) -> None:
        server.stop()

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def did_open(server: LinkwrightServer, params: types.DidOpenTextDocumentParams) -> None:
        server.file_opened(params.text_document.uri)

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def did_change(server: LinkwrightServer, params: types.DidChangeTextDocumentParams) -> None:
        server.file_changed(params.text_document.uri)

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def did_close(server: LinkwrightServer, params: types.DidCloseTextDocumentParams) -> None:
        server.file_changed(params.text_document.uri)

    @server.feature(types.TEXT_DOCUMENT_DID_SAVE)
    def did_save(server: LinkwrightServer, params: types.DidSaveTextDocumentParams) -> None:
        server.file_saved(params.text_document.uri)

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def did_change_watched_files(server: LinkwrightServer, params: types.DidChangeWatchedFilesParams) -> None:
        for change in params.changes:
            server.file_saved(change.uri)

    @server.feature(types.WORKSPACE_DID_CREATE_FILES, _FILES_AND_FOLDERS)
    def did_create_files(server: LinkwrightServer, params: types.CreateFilesParams) -> None:
        for file in params.files:
            server.file_saved(file.uri)

    @server.feature(types.WORKSPACE_DID_RENAME_FILES, _FILES_AND_FOLDERS)
    def did_rename_files(server: LinkwrightServer, params: types.RenameFilesParams) -> None:
        for file in params.files:
            server.file_saved(file.old_uri)
            server.file_saved(file.new_uri)

    @server.feature(types.WORKSPACE_DID_DELETE_FILES, _FILES_AND_FOLDERS)
    def did_delete_files(server: LinkwrightServer, params: types.DeleteFilesParams) -> None:
        for file in params.files:
            server.file_saved(file.uri)

    for requests in (
        texts,
        names,
        renames,
        actions,
        hints,
        appearance,
        navigation,
        expansions,
        virtual_documents,
        robot_pages,
    ):
        requests.add_requests(server)
    return server


def _list_folders(server: LinkwrightServer) -> list[Path]:
    """Return the folders that the editor has opened, or its root if it reports no folders."""
    folders = [path for uri in server.workspace.folders if (path := path_from_uri(uri)) is not None]
    root = path_from_uri(server.workspace.root_uri) if server.workspace.root_uri else None
    return folders or ([root] if root else [])
