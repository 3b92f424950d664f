"""Requests about the text of one file, through the protocol."""

from __future__ import annotations

import asyncio

from lsprotocol import types

from tests.lsp.conftest import MAIN
from tests.waiting import TIMEOUT_S

FILE = "urdf/arm.urdf.xacro"
OPTIONS = types.FormattingOptions(2, insert_spaces=True)
MESSY = MAIN.replace('  <link name="base"/>', '      <link   name="base"/>').replace("  <xacro:bar", "<xacro:bar")


def find_position(text: str, mark: str, after: int = 0) -> types.Position:
    """Return the position of a mark in a text."""
    before = text[: text.index(mark) + after]
    return types.Position(before.count("\n"), len(before) - before.rfind("\n") - 1)


def apply_edits(text: str, edits) -> str:
    """Return a text with the edits of the server."""
    lines = text.splitlines(keepends=True)
    for edit in sorted(edits, key=lambda edit: edit.range.start.line, reverse=True):
        assert edit.range.start.character == edit.range.end.character == 0
        lines[edit.range.start.line : edit.range.end.line] = [edit.new_text]
    return "".join(lines)


async def test_formatting_matches_format_command(editor):
    editor.open(FILE, MESSY)
    edits = await editor.client.text_document_formatting_async(
        types.DocumentFormattingParams(editor.document(FILE), OPTIONS)
    )
    assert apply_edits(MESSY, edits) == MAIN
    selected_range = types.Range(find_position(MESSY, "      <link"), find_position(MESSY, "<xacro:bar"))
    edits = await editor.client.text_document_range_formatting_async(
        types.DocumentRangeFormattingParams(editor.document(FILE), selected_range, OPTIONS)
    )
    assert '  <link name="base"/>\n' in apply_edits(MESSY, edits)


async def test_malformed_xml_is_not_formatted(editor):
    editor.open(FILE, "<robot>")
    parameters = types.DocumentFormattingParams(editor.document(FILE), OPTIONS)
    assert await editor.client.text_document_formatting_async(parameters) is None


async def test_symbols_are_named_elements(editor):
    editor.open("urdf/parts.xacro")
    (robot,) = await editor.client.text_document_document_symbol_async(
        types.DocumentSymbolParams(editor.document("urdf/parts.xacro"))
    )
    (macro,) = robot.children
    assert (robot.name, macro.name, macro.kind) == ("robot", "xacro:macro bar", types.SymbolKind.Function)
    assert [child.name for child in macro.children] == ["link ${name}", "joint ${name}_joint"]


async def test_folds_selections_and_linked_tags_are_returned(editor):
    text = (editor.folder / "urdf/parts.xacro").read_text()
    editor.open("urdf/parts.xacro")
    document = editor.document("urdf/parts.xacro")
    folds = await editor.client.text_document_folding_range_async(types.FoldingRangeParams(document))
    assert [(fold.start_line, fold.end_line) for fold in folds] == [(0, 8), (1, 7), (3, 6)]
    (selection,) = await editor.client.text_document_selection_range_async(
        types.SelectionRangeParams(document, [find_position(text, "continuous", 2)])
    )
    lengths = []
    while selection is not None:
        start, end = selection.range.start, selection.range.end
        lengths.append((end.line - start.line, end.character - start.character))
        selection = selection.parent
    written = ("continuous", 'type="continuous"', '<joint name="${name}_joint" type="continuous">')
    assert lengths[:3] == [(0, len(text)) for text in written]
    linked = await editor.client.text_document_linked_editing_range_async(
        types.LinkedEditingRangeParams(document, find_position(text, "<joint", 3))
    )
    assert [linked_range.start.line for linked_range in linked.ranges] == [3, 7]


async def test_code_action_fixes_finding(editor):
    (editor.folder / "linkwright.toml").write_text('select = ["LW221"]\n')
    text = (editor.folder / "urdf/parts.xacro").read_text().replace('xyz="0 0 1"', 'xyz="0 0 2"')
    editor.open("urdf/parts.xacro", text)
    (finding,) = await editor.until("urdf/parts.xacro", "LW221")
    context = types.CodeActionContext([finding], only=["quickfix", "source"])
    parameters = types.CodeActionParams(editor.document("urdf/parts.xacro"), finding.range, context)
    fix, fix_all, ignoring = await editor.client.text_document_code_action_async(parameters)
    for action in (fix, fix_all):
        (change,) = action.edit.document_changes
        assert [edit.new_text for edit in change.edits] == ["0 0 1"]
        assert change.text_document.version == 1
    assert ignoring.title == "ignore LW221 here, with a reason"
    assert [fix.kind, fix_all.kind] == [types.CodeActionKind.QuickFix, types.CodeActionKind.SourceFixAll]


async def test_build_files_have_no_symbols(editor):
    editor.open("CMakeLists.txt")
    parameters = types.DocumentSymbolParams(editor.document("CMakeLists.txt"))
    assert await editor.client.text_document_document_symbol_async(parameters) == []
    (editor.folder / "notes.txt").write_text("")
    editor.open("notes.txt")
    parameters = types.DocumentSymbolParams(editor.document("notes.txt"))
    assert await editor.client.text_document_document_symbol_async(parameters) is None


async def test_unsupported_file_has_empty_list_of_colors(editor):
    (editor.folder / "notes.txt").write_text("red")
    editor.open("notes.txt")
    document = editor.document("notes.txt")
    colors = editor.client.text_document_document_color_async(types.DocumentColorParams(document))
    assert [*await asyncio.wait_for(colors, TIMEOUT_S)] == []
    place = types.Range(types.Position(0, 0), types.Position(0, 3))
    parameters = types.ColorPresentationParams(document, types.Color(1.0, 0.0, 0.0, 1.0), place)
    assert [*await asyncio.wait_for(editor.client.text_document_color_presentation_async(parameters), TIMEOUT_S)] == []


async def test_single_line_file_has_no_folds(editor):
    editor.open("urdf/line.urdf", '<robot name="r"><!-- a --><link name="a"></link></robot>')
    parameters = types.FoldingRangeParams(editor.document("urdf/line.urdf"))
    assert not await editor.client.text_document_folding_range_async(parameters)
