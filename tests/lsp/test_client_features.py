"""The folders of an editor, and the progress that the server reports.

Folders are added, removed, renamed and deleted while the server runs.
"""

from __future__ import annotations

import asyncio
import shutil

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from linkwright.diagnostics import phrase
from linkwright.lsp.client_features import WATCHED_FILES, show_progress
from tests.lsp.conftest import MAIN, MANIFEST, PARTS, connect_editor
from tests.waiting import TIMEOUT_S

MAIN_FILE, PARTS_FILE = "urdf/arm.urdf.xacro", "urdf/parts.xacro"


def changed_folders(added=(), removed=()):
    """Return the notification that folders were added and removed."""
    event = types.WorkspaceFoldersChangeEvent(
        [types.WorkspaceFolder(folder.as_uri(), folder.name) for folder in added],
        [types.WorkspaceFolder(folder.as_uri(), folder.name) for folder in removed],
    )
    return types.DidChangeWorkspaceFoldersParams(event)


async def test_added_folder_is_searched(editor):
    other = editor.folder.parent / "other"
    other.mkdir()
    (other / "package.xml").write_text(MANIFEST.replace("arm_description", "other"))
    (other / "main.urdf.xacro").write_text(MAIN.replace("parts.xacro", "$(find arm_description)/urdf/parts.xacro"))
    editor.open(PARTS_FILE)
    await editor.until(PARTS_FILE)
    editor.client.workspace_did_change_workspace_folders(changed_folders(added=[other]))
    symbols = await editor.client.workspace_symbol_async(types.WorkspaceSymbolParams("base"))
    assert {symbol.location.uri for symbol in symbols} >= {(other / "main.urdf.xacro").as_uri()}


async def test_findings_of_removed_folder_disappear(editor):
    editor.open(PARTS_FILE, PARTS.replace('name="bar"', 'name="rod"'))
    await editor.until(MAIN_FILE, "XAC401")
    editor.client.workspace_did_change_workspace_folders(changed_folders(removed=[editor.folder]))
    await editor.until(MAIN_FILE)


async def test_findings_of_deleted_folder_disappear(editor):
    editor.open(PARTS_FILE, PARTS.replace('name="bar"', 'name="rod"'))
    await editor.until(MAIN_FILE, "XAC401")
    shutil.rmtree(editor.folder / "urdf")
    deleted = types.DeleteFilesParams([types.FileDelete(editor.uri("urdf"))])
    editor.client.workspace_did_delete_files(deleted)
    await editor.until(MAIN_FILE)


async def test_renamed_folder_is_searched_again(editor):
    editor.open("package.xml")
    (editor.folder / "urdf").rename(editor.folder / "description")
    renamed = types.FileRename(editor.uri("urdf"), editor.uri("description"))
    editor.client.workspace_did_rename_files(types.RenameFilesParams([renamed]))
    for _ in range(int(TIMEOUT_S / 0.1)):
        symbols = await editor.client.workspace_symbol_async(types.WorkspaceSymbolParams("base"))
        if {symbol.location.uri for symbol in symbols} == {editor.uri("description/arm.urdf.xacro")}:
            return
        await asyncio.sleep(0.1)
    raise AssertionError(symbols)


async def test_editor_is_asked_to_watch_files(package):
    watched = types.DidChangeWatchedFilesClientCapabilities(dynamic_registration=True)
    workspace = types.WorkspaceClientCapabilities(did_change_watched_files=watched)
    registrations: asyncio.Queue[types.Registration] = asyncio.Queue()
    async with connect_editor(package, types.ClientCapabilities(workspace=workspace), registrations) as _:
        registration = await asyncio.wait_for(registrations.get(), TIMEOUT_S)
    assert registration.method == types.WORKSPACE_DID_CHANGE_WATCHED_FILES
    assert [watcher["globPattern"] for watcher in registration.register_options["watchers"]] == [*WATCHED_FILES]


class ProgressRecorder:
    """A server that records the progress it shows."""

    def __init__(self, *, can_show: bool) -> None:
        self.client_capabilities = types.ClientCapabilities(
            window=types.WindowClientCapabilities(work_done_progress=can_show)
        )
        self.shown: list[str] = []
        self.work_done_progress = self
        self.tokens: dict[str, None] = {}

    async def create_async(self, token: str) -> None:
        self.tokens[token] = None

    def begin(self, token: str, value: types.WorkDoneProgressBegin) -> None:
        assert token in self.tokens
        self.shown.append(value.title)

    def end(self, token: str, _: types.WorkDoneProgressEnd) -> None:
        assert token in self.tokens
        self.shown.append("end")


@pytest.mark.parametrize(
    ("seconds", "can_show", "shown"), [(0.0, True, []), (1.0, False, []), (1.0, True, ["searching", "end"])]
)
async def test_progress_is_shown_for_long_work(seconds, can_show, shown):
    server, work = ProgressRecorder(can_show=can_show), asyncio.ensure_future(asyncio.sleep(seconds))
    await show_progress(server, phrase("searching"), work)
    assert server.shown == shown
    assert not server.tokens


async def test_editor_can_reject_progress():
    async def refuse(_: str) -> None:
        raise JsonRpcException("no")

    server, work = ProgressRecorder(can_show=True), asyncio.ensure_future(asyncio.sleep(1))
    server.create_async = refuse
    await show_progress(server, phrase("searching"), work)
    assert server.shown == []
    work.cancel()
