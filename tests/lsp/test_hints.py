"""Requests that annotate a text, through the protocol.

The tests cover inlay hints, lenses, colors, semantic tokens, links, workspace symbols and macro calls.
"""

from __future__ import annotations

import asyncio

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from linkwright.language.highlighting import HighlightKind
from tests.lsp.conftest import MAIN, PARTS

FILE, PARTS_FILE = "urdf/arm.urdf.xacro", "urdf/parts.xacro"
WHOLE_TEXT = types.Range(types.Position(0, 0), types.Position(1000, 0))


def position_after(text: str, place: str) -> types.Position:
    """Return the position behind a part of a text."""
    before = text[: text.index(place) + len(place)]
    return types.Position(before.count("\n"), len(before) - before.rfind("\n") - 1)


async def test_inlay_hints_show_expression_values(editor):
    text = MAIN.replace("</robot>", '  <xacro:bar name="lower" length="${0.2 + 0.1}"/>\n</robot>')
    editor.open(FILE, text)
    editor.open(PARTS_FILE)
    hints = await editor.client.text_document_inlay_hint_async(types.InlayHintParams(editor.document(FILE), WHOLE_TEXT))
    assert [hint.label for hint in hints] == ["= 0.30000000000000004"]
    hints = await editor.client.text_document_inlay_hint_async(
        types.InlayHintParams(editor.document(PARTS_FILE), WHOLE_TEXT)
    )
    expected = [(2, "= upper | lower"), (3, "= upper_joint | lower_joint"), (5, "= upper | lower")]
    assert [(hint.position.line, hint.label) for hint in hints] == expected


async def test_inlay_hints_are_limited_to_requested_lines(editor):
    editor.open(PARTS_FILE)
    lines = types.Range(types.Position(3, 0), types.Position(4, 0))
    hints = await editor.client.text_document_inlay_hint_async(
        types.InlayHintParams(editor.document(PARTS_FILE), lines)
    )
    assert [hint.position.line for hint in hints] == [3]


async def test_inlay_hints_name_block_parameters_of_macro_call(editor):
    text = MAIN.replace(
        "<link",
        '<xacro:macro name="placed" params="n *pose **rest"><link name="${n}"/></xacro:macro>\n'
        '  <xacro:placed n="a">\n    <origin xyz="0 0 0"/>\n    <visual/>\n  </xacro:placed>\n  <link',
        1,
    )
    editor.open(FILE, text)
    hints = await editor.client.text_document_inlay_hint_async(types.InlayHintParams(editor.document(FILE), WHOLE_TEXT))
    assert [hint.label for hint in hints if hint.kind is types.InlayHintKind.Parameter] == ["*pose:", "**rest:"]


async def test_hover_lists_value_for_each_macro_call(editor):
    text = MAIN.replace("</robot>", '  <xacro:bar name="lower" length="${2 * 0.1}"/>\n</robot>')
    editor.open(FILE, text)
    editor.open(PARTS_FILE)

    async def hover(name: str, place: types.Position) -> str:
        hover = await editor.client.text_document_hover_async(types.HoverParams(editor.document(name), place))
        return hover.contents.value

    assert "`${2 * 0.1}` = `0.2`" in await hover(FILE, position_after(text, "${2 "))
    values = await hover(PARTS_FILE, position_after(PARTS, "${na"))
    assert '- `\'upper\'` `bar name="upper" length="0.4"` (arm.urdf.xacro:4)' in values
    assert "- `'lower'` `bar name=\"lower\"" in values


async def test_code_lens_counts_macro_uses(editor):
    editor.open(PARTS_FILE)
    lens, page = await editor.client.text_document_code_lens_async(types.CodeLensParams(editor.document(PARTS_FILE)))
    assert page.command.command == "linkwright.showRobot"
    assert lens.range.start == position_after(PARTS, 'xacro:macro name="')
    resolved = await editor.client.code_lens_resolve_async(lens)
    assert (resolved.command.title, resolved.command.command) == ("1 use", "")


async def test_code_lens_uses_client_commands(editor_with_commands):
    editor = editor_with_commands
    editor.open(FILE)
    (page,) = await editor.client.text_document_code_lens_async(types.CodeLensParams(editor.document(FILE)))
    assert (page.command.command, page.command.arguments) == ("linkwright.openInPage", (editor.uri(FILE),))
    editor.open(PARTS_FILE)
    lens = (await editor.client.text_document_code_lens_async(types.CodeLensParams(editor.document(PARTS_FILE))))[0]
    command = (await editor.client.code_lens_resolve_async(lens)).command
    assert command.command == "linkwright.showReferences"
    uri, _, (location,) = command.arguments
    assert uri == editor.uri(PARTS_FILE)
    assert location["uri"] == editor.uri(FILE)


async def test_colors_are_found_and_written_in_file_notation(editor):
    text = MAIN.replace("<link", '<material name="m"><color rgba="1 0.5 0 1"/></material>\n  <link', 1)
    editor.open(FILE, text)
    (color,) = await editor.client.text_document_document_color_async(types.DocumentColorParams(editor.document(FILE)))
    assert color.color == types.Color(1.0, 0.5, 0.0, 1.0)
    parameters = types.ColorPresentationParams(editor.document(FILE), types.Color(0.123456, 0.0, 1.0, 1.0), color.range)
    (presented,) = await editor.client.text_document_color_presentation_async(parameters)
    assert presented.text_edit == types.TextEdit(color.range, "0.1235 0 1 1")


async def test_semantic_tokens_classify_names(editor):
    editor.open(PARTS_FILE)
    tokens = await editor.client.text_document_semantic_tokens_full_async(
        types.SemanticTokensParams(editor.document(PARTS_FILE))
    )
    line = column = 0
    kinds = [*HighlightKind]
    token_names = []
    lines = PARTS.splitlines()
    for start in range(0, len(tokens.data), 5):
        line_step, step, length, kind, modifiers = tokens.data[start : start + 5]
        line, column = line + line_step, step if line_step else column + step
        token_names.append((lines[line][column : column + length], kinds[kind].value, modifiers))
    assert token_names[:2] == [("bar", "macro", 1), ("name", "parameter", 1)]
    assert ("${", "operator", 0) in token_names
    assert ("name", "parameter", 0) in token_names
    assert ("base", "class", 0) in token_names


async def test_includes_and_meshes_are_links_and_definitions(editor, package):
    (package / "meshes").mkdir()
    (package / "meshes" / "a.stl").write_bytes(b"solid")
    text = MAIN.replace(
        "<link",
        '<xacro:property name="folder" value="package://arm_description/meshes"/>\n'
        '  <link name="m"><visual><geometry><mesh filename="${folder}/a.stl"/></geometry></visual></link>\n  <link',
        1,
    )
    editor.open(FILE, text)
    links = await editor.client.text_document_document_link_async(types.DocumentLinkParams(editor.document(FILE)))
    assert [link.target for link in links] == [editor.uri(PARTS_FILE), (package / "meshes" / "a.stl").as_uri()]
    (place,) = await editor.client.text_document_definition_async(
        types.DefinitionParams(editor.document(FILE), position_after(text, "parts.x"))
    )
    assert place.uri == editor.uri(PARTS_FILE)


async def test_workspace_symbols_match_subset_of_letters(editor):
    editor.open(FILE)

    async def find(query: str) -> list[str]:
        symbols = await editor.client.workspace_symbol_async(types.WorkspaceSymbolParams(query))
        return [symbol.name for symbol in symbols]

    assert await find("bs") == ["base"]
    assert await find("BAR") == ["bar"]
    assert await find("zzz") == []


async def test_uses_of_name_are_highlighted(editor):
    editor.open(PARTS_FILE)
    highlights = await editor.client.text_document_document_highlight_async(
        types.DocumentHighlightParams(editor.document(PARTS_FILE), position_after(PARTS, "${na"))
    )
    assert [(use.range.start.line, use.kind) for use in highlights] == [
        (1, types.DocumentHighlightKind.Write),
        *[(line, types.DocumentHighlightKind.Read) for line in (2, 3, 5)],
    ]


async def test_macro_calls_have_hierarchy(editor):
    text = PARTS.replace(
        "</robot>", '  <xacro:macro name="pair" params=""><xacro:bar name="x" length="1"/></xacro:macro>\n</robot>'
    )
    editor.open(FILE)
    editor.open(PARTS_FILE, text)
    document = editor.document(PARTS_FILE)
    (bar,) = await editor.client.text_document_prepare_call_hierarchy_async(
        types.CallHierarchyPrepareParams(document, position_after(text, 'name="ba'))
    )
    incoming = await editor.client.call_hierarchy_incoming_calls_async(types.CallHierarchyIncomingCallsParams(bar))
    assert sorted(call.from_.name for call in incoming) == ["arm.urdf.xacro", "pair"]
    (pair,) = (call.from_ for call in incoming if call.from_.name == "pair")
    (outgoing,) = await editor.client.call_hierarchy_outgoing_calls_async(types.CallHierarchyOutgoingCallsParams(pair))
    assert outgoing.to.name == "bar"
    assert outgoing.from_ranges[0].start.line == text[: text.index('name="x"')].count("\n")


async def test_request_for_changing_text_is_rejected(editor):
    calls = "".join(f'<xacro:bar name="b{number}" length="${{{number} + 1}}"/>\n' for number in range(3000))
    editor.open(FILE, MAIN.replace("</robot>", calls + "</robot>"))
    parameters = editor.client.text_document_inlay_hint_async(types.InlayHintParams(editor.document(FILE), WHOLE_TEXT))
    task = asyncio.ensure_future(parameters)
    await asyncio.sleep(0)  # the request is sent, then the change; the expansion takes much longer
    editor.change(FILE, MAIN)
    with pytest.raises(JsonRpcException, match="changed in the meantime"):
        await task
