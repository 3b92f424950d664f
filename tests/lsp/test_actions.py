"""Code actions through the protocol: fixes, suppressions and refactorings."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence

import pytest
import pytest_asyncio
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from linkwright.lsp.positions import TextPositions
from tests.lsp.conftest import MAIN, PARTS, connect_editor

FILE, PARTS_FILE = "urdf/arm.urdf.xacro", "urdf/parts.xacro"
RESOLVING = types.ClientCapabilities(
    workspace=types.WorkspaceClientCapabilities(
        workspace_edit=types.WorkspaceEditClientCapabilities(
            document_changes=True, resource_operations=[types.ResourceOperationKind.Create]
        )
    ),
    text_document=types.TextDocumentClientCapabilities(
        code_action=types.CodeActionClientCapabilities(
            data_support=True, resolve_support=types.ClientCodeActionResolveOptions(["edit"])
        )
    ),
)


@pytest_asyncio.fixture
async def resolving_editor(package):
    async with connect_editor(package, RESOLVING) as editor:
        yield editor


async def request_actions(editor, name: str, text: str, place: str, kinds: Sequence[str] | None = None):
    """Return the actions for a selected text of a file."""
    start = text.index(place)
    selected = TextPositions(text).range(start, start + len(place))
    context = types.CodeActionContext(editor.diagnostics.get(editor.uri(name), ()), kinds)
    parameters = types.CodeActionParams(editor.document(name), selected, context)
    return await editor.client.text_document_code_action_async(parameters)


def apply_edit(text: str, edit: types.WorkspaceEdit) -> str:
    """Return a text with the edit of its file."""
    positions = TextPositions(text)
    (change,) = edit.document_changes
    for text_edit in sorted(change.edits, key=lambda text_edit: positions.offset(text_edit.range.start), reverse=True):
        start, end = positions.offset(text_edit.range.start), positions.offset(text_edit.range.end)
        text = text[:start] + text_edit.new_text + text[end:]
    return text


async def test_suppressed_finding_disappears(editor):
    text = MAIN.replace('  <link name="base"/>', '  <link name="base"/>\n  <xacro:nothing/>')
    editor.open(FILE, text)
    await editor.until(FILE, "XAC401")
    (action,) = await request_actions(editor, FILE, text, "<xacro:nothing", ["quickfix"])
    assert action.diagnostics[0].code == "XAC401"
    changed = apply_edit(text, action.edit)
    assert "\n  <!-- linkwright: ignore XAC401 (reason) -->\n  <xacro:nothing/>" in changed
    editor.change(FILE, changed)
    await editor.until(FILE)


async def test_single_selected_character_is_treated_as_block_cursor(editor):
    editor.open(FILE, MAIN)
    (action,) = await request_actions(editor, FILE, MAIN, "4", ["refactor.extract"])
    assert action.title == "extract '0.4' to a property"
    assert 'length="${bar_length}"' in apply_edit(MAIN, action.edit)


async def test_suppressed_finding_of_cmake_file_disappears(editor):
    (editor.folder / "linkwright.toml").write_text('select = ["LW824"]\n')
    text = (editor.folder / "CMakeLists.txt").read_text().replace("DIRECTORY urdf", "DIRECTORY urdf meshs")
    editor.open("CMakeLists.txt", text)
    await editor.until("CMakeLists.txt", "LW824")
    (action,) = await request_actions(editor, "CMakeLists.txt", text, "meshs", ["quickfix"])
    changed = apply_edit(text, action.edit)
    assert "\n# linkwright: ignore LW824 (reason)\ninstall(" in changed
    editor.change("CMakeLists.txt", changed)
    await editor.until("CMakeLists.txt")


async def test_refactoring_is_verified_immediately_without_resolve_support(editor):
    editor.open(FILE)
    (action,) = await request_actions(editor, FILE, MAIN, "0.4", ["refactor"])
    assert action.kind == "refactor.extract.property"
    changed = apply_edit(MAIN, action.edit)
    assert '<xacro:property name="bar_length" value="0.4"/>\n  <xacro:bar name="upper"' in changed
    assert 'length="${bar_length}"/>' in changed
    assert action.edit.document_changes[0].text_document.version == 1


async def test_unverified_refactoring_is_not_offered(editor):
    text = MAIN.replace('<link name="base"/>', '<link name="base"/><gazebo><gravity v="0.10"/></gazebo>')
    editor.open(FILE, text)
    assert not await request_actions(editor, FILE, text, "0.10", ["refactor"])


async def test_edit_is_computed_on_resolve(resolving_editor):
    editor = resolving_editor
    editor.open(PARTS_FILE)
    (action,) = await request_actions(editor, PARTS_FILE, PARTS, '<axis xyz="0 0 1"/>', ["refactor.extract"])
    assert action.edit is None
    resolved = await editor.client.code_action_resolve_async(action)
    changed = apply_edit(PARTS, resolved.edit)
    assert '<xacro:macro name="joint_axis" params="">\n    <axis xyz="0 0 1"/>\n  </xacro:macro>' in changed


async def test_unverified_edit_is_rejected_with_reason(resolving_editor):
    text = MAIN.replace('<link name="base"/>', '<link name="base"/><gazebo><gravity v="0.10"/></gazebo>')
    editor = resolving_editor
    editor.open(FILE, text)
    (action,) = await request_actions(editor, FILE, text, "0.10", ["refactor"])
    with pytest.raises(JsonRpcException, match=r"the robot of .* would change"):
        await editor.client.code_action_resolve_async(action)


async def test_edit_is_rejected_after_text_change(resolving_editor):
    editor = resolving_editor
    editor.open(FILE)
    (action,) = await request_actions(editor, FILE, MAIN, "0.4", ["refactor"])
    editor.change(FILE, "<!-- typed -->\n" + MAIN)
    await asyncio.sleep(0)
    with pytest.raises(JsonRpcException, match="changed in the meantime"):
        await editor.client.code_action_resolve_async(action)


async def test_urdf_is_converted_to_xacro_in_new_file(resolving_editor):
    editor, text = resolving_editor, '<robot name="r"><link name="a"/></robot>\n'
    (editor.folder / "urdf" / "r.urdf").write_text(text)
    editor.open("urdf/r.urdf", text)
    (action,) = await request_actions(editor, "urdf/r.urdf", text, "robot", ["refactor.rewrite"])
    created, written = (await editor.client.code_action_resolve_async(action)).edit.document_changes
    assert created.uri == written.text_document.uri == editor.uri("urdf/r.urdf.xacro")
    assert written.edits[0].new_text.startswith('<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">')


async def test_only_requested_action_kinds_are_returned(editor):
    editor.open(FILE)
    assert not await request_actions(editor, FILE, MAIN, "0.4", ["source"])
    assert await request_actions(editor, FILE, MAIN, "0.4", ["refactor.extract.property"])
    assert not await request_actions(editor, FILE, MAIN, "0.4", ["refactor.inline"])


async def test_missing_install_line_is_added_to_cmake_file(editor):
    (editor.folder / "linkwright.toml").write_text('select = ["LW822"]\n')
    (editor.folder / "launch").mkdir()
    (editor.folder / "launch" / "arm.launch.py").write_text("from launch import LaunchDescription\n")
    text = (editor.folder / "CMakeLists.txt").read_text()
    editor.open("CMakeLists.txt", text)
    await editor.until("CMakeLists.txt", "LW822")
    fix, *_ = await request_actions(editor, "CMakeLists.txt", text, "project(arm_description)", ["quickfix"])
    changed = apply_edit(text, fix.edit)
    assert "install(DIRECTORY urdf launch DESTINATION share/${PROJECT_NAME})" in changed
    editor.change("CMakeLists.txt", changed)
    await editor.until("CMakeLists.txt")
