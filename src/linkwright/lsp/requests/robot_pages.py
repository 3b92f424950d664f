"""The command that shows a robot in a page.

The page follows the texts and the cursor of the editor.
"""

from __future__ import annotations

from pathlib import Path

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.includes import real_path
from linkwright.lint.targets import DESCRIPTION_SUFFIXES
from linkwright.lsp.edits import make_replacement, to_workspace_edit
from linkwright.lsp.server import LinkwrightServer, path_from_uri

SHOW_ROBOT = "linkwright.showRobot"


class PageEditor:
    """The editor that receives the reports of the robots' pages.

    It implements `linkwright.lsp.robot_views.TextEditor`.

    Args:
        server: the language server.
    """

    def __init__(self, server: LinkwrightServer) -> None:
        self._server = server

    def show_location(self, file: Path, line: int, column: int) -> None:
        """Show a position of a file, if the editor supports it. Line and column count from 1."""
        server, window = self._server, self._server.client_capabilities.window
        if window is not None and window.show_document is not None and window.show_document.support:
            position = types.Position(line - 1, column - 1)
            selection = types.Range(position, position)
            server.window_show_document(
                types.ShowDocumentParams(server.uri_of(file), take_focus=True, selection=selection)
            )

    def replace_text(self, file: Path, version: int, text: str) -> None:
        """Replace the text of a file, or warn if it has another version or the editor cannot edit."""
        server, capabilities = self._server, self._server.client_capabilities.workspace
        document, positions = server.documents().get(file), server.positions(file)
        current_version = 0 if document is None else document.version or 0
        if positions is None or current_version != version or capabilities is None or not capabilities.apply_edit:
            message = phrase("the edit in the page was not applied to '{file}'; repeat it", file=file.name)
            server.window_show_message(types.ShowMessageParams(types.MessageType.Warning, localized(message)))
            return
        edit = to_workspace_edit(server, [make_replacement(file, positions.text, text)])
        server.workspace_apply_edit(types.ApplyWorkspaceEditParams(edit))


async def show_robot(server: LinkwrightServer, uri: str, *, opens: bool) -> str:
    """Start the page of the description that a file belongs to, and return its address.

    Args:
        server: the language server.
        uri: the URI of a description, or of a file that a description includes.
        opens: whether to open the page in the user's browser.

    Raises:
        JsonRpcException: RequestFailed, the file is not a description, or its page cannot be served.
    """
    path, workspace, texts = path_from_uri(uri), server.project, server.texts()
    if path is None or workspace is None or not path.name.endswith(DESCRIPTION_SUFFIXES):
        raise _request_failed_error(localized(phrase("only the robots of URDF, xacro and SDF files can be shown")))
    await server.when_indexed()
    entry = (await server.run_in_check_thread(lambda: workspace.index.entries(real_path(path), texts)))[0]
    try:
        address = await server.robot_views.address(entry, server.documents())
    except OSError as error:
        raise _request_failed_error(str(error)) from None
    if address is None:
        raise _request_failed_error(
            localized(phrase("the page of '{file}' has ended; run linkwright view to see why", file=entry.name))
        )
    if opens:
        await _open_page(server, address)
    return address


async def _open_page(server: LinkwrightServer, address: str) -> None:
    window = server.client_capabilities.window
    shows = window is not None and window.show_document is not None and window.show_document.support
    is_shown = shows and await server.window_show_document_async(types.ShowDocumentParams(address, external=True))
    if not is_shown or not is_shown.success:
        server.window_show_message(types.ShowMessageParams(types.MessageType.Info, address))


def _request_failed_error(message: str) -> JsonRpcException:
    return JsonRpcException(message, code=int(types.LSPErrorCodes.RequestFailed))


def add_requests(server: LinkwrightServer) -> None:
    """Register the request handlers of this module."""
    server.robot_views.editor = PageEditor(server)

    @server.command(SHOW_ROBOT)
    async def show(server: LinkwrightServer, uri: str, opens: bool = True) -> str:
        return await show_robot(server, uri, opens=opens)
