"""References and renaming, through the protocol."""

from __future__ import annotations

import asyncio

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from tests.lsp.conftest import MAIN

FILE = "urdf/arm.urdf.xacro"


def position_in(text: str) -> types.Position:
    """Return the position in the middle of a text in the main file."""
    offset = MAIN.index(text) + len(text)
    return types.Position(MAIN.count("\n", 0, offset), offset - MAIN.rfind("\n", 0, offset) - 1)


async def test_references_are_found_in_all_files(editor):
    editor.open(FILE)
    parameters = types.ReferenceParams(
        types.ReferenceContext(True), editor.document(FILE), position_in('<link name="b')
    )
    references = await editor.client.text_document_references_async(parameters)
    assert sorted(place.uri.rpartition("/")[2] for place in references) == ["arm.urdf.xacro", "parts.xacro"]


async def test_rename_edits_open_files_with_versions(editor):
    editor.open(FILE)
    document, position = editor.document(FILE), position_in('<link name="b')
    prepared = await editor.client.text_document_prepare_rename_async(types.PrepareRenameParams(document, position))
    assert prepared.placeholder == "base"
    edit = await editor.client.text_document_rename_async(types.RenameParams(document, position, "trunk"))
    changes = {change.text_document.uri.rpartition("/")[2]: change for change in edit.document_changes}
    assert changes.keys() == {"arm.urdf.xacro", "parts.xacro"}
    assert changes["arm.urdf.xacro"].text_document.version == 1
    assert changes["parts.xacro"].text_document.version is None
    assert {text.new_text for change in changes.values() for text in change.edits} == {"trunk"}


async def test_rename_to_existing_link_is_rejected_with_reason(editor):
    editor.open(FILE)
    with pytest.raises(JsonRpcException, match="two links would have the same name"):
        await editor.client.text_document_rename_async(
            types.RenameParams(editor.document(FILE), position_in('<link name="b'), "upper")
        )


async def test_rename_during_change_is_rejected_or_uses_old_version(editor):
    editor.open(FILE)
    parameters = types.RenameParams(editor.document(FILE), position_in('<link name="b'), "trunk")
    renaming = asyncio.ensure_future(editor.client.text_document_rename_async(parameters))
    await asyncio.sleep(0)  # the request is sent before the change
    editor.change(FILE, "<!-- typed meanwhile -->\n" + MAIN)
    [outcome] = await asyncio.gather(renaming, return_exceptions=True)
    if isinstance(outcome, JsonRpcException):
        assert "rename again" in str(outcome)
    else:
        versions = {change.text_document.uri: change.text_document.version for change in outcome.document_changes}
        assert versions[editor.uri(FILE)] == 1


async def test_references_to_renamed_file_are_updated(editor, package):
    (package / "launch").mkdir()
    launch = package / "launch" / "view.launch.py"
    launch.write_text("PATH = ('urdf', 'parts.xacro')\n")
    editor.open("urdf/arm.urdf.xacro")
    (package / "urdf" / "sub").mkdir()
    renamed = types.FileRename(editor.uri("urdf/parts.xacro"), editor.uri("urdf/sub/parts2.xacro"))
    edit = await editor.client.workspace_will_rename_files_async(types.RenameFilesParams([renamed]))
    (change,) = edit.document_changes
    assert change.text_document.uri == editor.uri("urdf/arm.urdf.xacro")
    assert [edit.new_text for edit in change.edits] == ["sub/parts2.xacro"]
    assert any("view.launch.py:1 (parts.xacro)" in message for message in editor.messages)


async def test_file_without_references_is_renamed_without_edits(editor):
    renamed = types.FileRename(editor.uri("urdf/arm.urdf.xacro"), editor.uri("urdf/other.urdf.xacro"))
    assert await editor.client.workspace_will_rename_files_async(types.RenameFilesParams([renamed])) is None
