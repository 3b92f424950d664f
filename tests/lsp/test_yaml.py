"""Requests about parameter files and RViz configurations, through the protocol."""

from __future__ import annotations

from lsprotocol import types

from tests.lsp.test_texts import find_position

FILE = "config/controllers.yaml"
TEXT = """controller_manager:
  ros__parameters:
    drive:
      type: diff_drive_controller/DiffDriveController
# 中文🤖
drive:
  ros__parameters:
    left_wheel_names: ["upper_joint"]
    wheel_
"""


async def test_parameter_file_is_completed_with_snippets(editor):
    editor.open(FILE, TEXT)
    position = find_position(TEXT, "    wheel_\n", len("    wheel_"))
    parameters = types.CompletionParams(editor.document(FILE), position)
    items = await editor.client.text_document_completion_async(parameters)
    assert items[0].label == "wheel_separation"
    assert (items[0].detail, items[0].sort_text) == ("double = 0.0", "00000")
    assert items[0].text_edit.range == types.Range(types.Position(8, 4), types.Position(8, 10))


async def test_joint_in_parameter_file_has_hover_and_definition(editor):
    editor.open(FILE, TEXT)
    position = find_position(TEXT, "upper_joint", 3)
    hover = await editor.client.text_document_hover_async(types.HoverParams(editor.document(FILE), position))
    assert "joint upper_joint" in hover.contents.value
    (target,) = await editor.client.text_document_definition_async(
        types.DefinitionParams(editor.document(FILE), position)
    )
    assert target.uri.endswith("parts.xacro")
    assert (target.range.start.line, target.range.end.character - target.range.start.character) == (3, 13)


async def test_rviz_configuration_has_frame_completions_and_symbols(editor):
    text = "Visualization Manager:\n  Global Options:\n    Fixed Frame: \n"
    editor.open("a.rviz", text)
    document = editor.document("a.rviz")
    parameters = types.CompletionParams(document, find_position(text, "Frame: ", len("Frame: ")))
    items = await editor.client.text_document_completion_async(parameters)
    assert [item.label for item in items][:2] == ["base", "upper"]
    (manager,) = await editor.client.text_document_document_symbol_async(types.DocumentSymbolParams(document))
    assert manager.children[0].children[0].name == "Fixed Frame"
