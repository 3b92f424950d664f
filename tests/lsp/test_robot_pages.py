"""The page of a robot: it follows the unsaved texts and the cursor, and opens the source."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator

import pytest
import pytest_asyncio
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from tests.lsp.conftest import MAIN, PARTS, Editor, connect_editor
from tests.waiting import TIMEOUT_S

FILE, PARTS_FILE = "urdf/arm.urdf.xacro", "urdf/parts.xacro"
SHOWING = types.ClientCapabilities(
    window=types.WindowClientCapabilities(show_document=types.ShowDocumentClientCapabilities(support=True)),
    workspace=types.WorkspaceClientCapabilities(apply_edit=True),
)


@pytest_asyncio.fixture
async def showing_editor(package, tmp_path, monkeypatch) -> AsyncIterator[Editor]:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "log"))
    async with connect_editor(package, SHOWING) as editor:
        yield editor


async def request_address(editor: Editor, name: str, *, opens: bool = False) -> str:
    arguments = [editor.uri(name), opens]
    parameters = types.ExecuteCommandParams("linkwright.showRobot", arguments=arguments)
    return await editor.client.workspace_execute_command_async(parameters)


async def wait_for_message(socket, kind: str, **fields) -> dict:
    """Return the next message of a kind from a page's socket, with some content."""
    async with asyncio.timeout(TIMEOUT_S):
        async for received in socket:
            message = json.loads(received.data) if isinstance(received.data, str) else {}
            if message.get("type") == kind and all(message.get(key) == value for key, value in fields.items()):
                return message
    raise AssertionError(f"the page was closed without '{kind}'")


async def test_only_robots_are_shown(showing_editor):
    with pytest.raises(JsonRpcException, match="only the robots of URDF"):
        await request_address(showing_editor, "package.xml")


@pytest.mark.slow
async def test_page_follows_editor_and_opens_source_lines(showing_editor):
    import aiohttp

    editor = showing_editor
    shown: asyncio.Queue[types.ShowDocumentParams] = asyncio.Queue()

    @editor.client.feature(types.WINDOW_SHOW_DOCUMENT)
    def _(parameters: types.ShowDocumentParams) -> types.ShowDocumentResult:
        shown.put_nowait(parameters)
        return types.ShowDocumentResult(success=True)

    editor.open(FILE)
    url = await request_address(editor, PARTS_FILE, opens=True)
    assert (await shown.get()).uri == url
    assert await request_address(editor, FILE) == url, "the page of a file shows the description that includes it"
    async with aiohttp.ClientSession() as session, session.ws_connect(url.replace("/?", "/ws?")) as socket:
        scene = await wait_for_message(socket, "robot_scene")
        assert [link["name"] for link in scene["links"]] == ["base", "upper"]
        await wait_for_message(socket, "editor_attached")
        editor.change(FILE, MAIN.replace("upper", "lower"))  # not saved
        scene = await wait_for_message(socket, "robot_scene")
        assert [link["name"] for link in scene["links"]] == ["base", "lower"]

        highlight = types.DocumentHighlightParams(editor.document(FILE), types.Position(2, 10))
        await editor.client.text_document_document_highlight_async(highlight)
        assert (await wait_for_message(socket, "show_element"))["name"] == "base"

        display = scene["display"]
        await socket.send_json({"type": "element_selected", "display": display, "kind": "joint", "name": "lower_joint"})
        async with asyncio.timeout(TIMEOUT_S):
            request = await shown.get()
        assert (request.uri, request.selection.start.line) == (editor.uri(PARTS_FILE), 3)


@pytest.mark.slow
async def test_robot_edit_changes_unsaved_editor_text(showing_editor):
    import aiohttp

    editor = showing_editor
    edits: asyncio.Queue[types.WorkspaceEdit] = asyncio.Queue()

    @editor.client.feature(types.WORKSPACE_APPLY_EDIT)
    def _(parameters: types.ApplyWorkspaceEditParams) -> types.ApplyWorkspaceEditResult:
        edits.put_nowait(parameters.edit)
        return types.ApplyWorkspaceEditResult(applied=True)

    text = PARTS.replace('<axis xyz="0 0 1"/>', '<axis xyz="0 0 1"/><origin xyz="0 0 0.1"/>')
    editor.open(PARTS_FILE)
    url = await request_address(editor, FILE)
    async with aiohttp.ClientSession() as session, session.ws_connect(url.replace("/?", "/ws?")) as socket:
        display = (await wait_for_message(socket, "robot_scene"))["display"]
        editor.change(PARTS_FILE, text)  # not saved
        await wait_for_message(socket, "robot_scene")
        part = {"part": "joint", "name": "upper_joint", "index": 0, "xyz": [0, 0, 0.25], "rpy": None}

        async def edit(number: int) -> None:
            await socket.send_json(
                {"type": "preview_edit", "number": number, "display": display, "together": True, **part}
            )
            assert (await wait_for_message(socket, "edit_preview", number=number))["refusal"] is None
            await socket.send_json({"type": "apply_edit", "number": number})

        await edit(1)
        assert not (await wait_for_message(socket, "edit_written"))["is_saved"]
        async with asyncio.timeout(TIMEOUT_S):
            (change,) = (await edits.get()).document_changes
        assert (change.text_document.uri, change.text_document.version) == (editor.uri(PARTS_FILE), 2)
        assert [edit.new_text for edit in change.edits] == ["25"]
        assert (editor.folder / PARTS_FILE).read_text() == PARTS
