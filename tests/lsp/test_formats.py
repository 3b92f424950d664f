"""Launch files, interfaces, SRDF and ``package.xml``, through the protocol."""

from __future__ import annotations

import pytest
from lsprotocol import types

XML = """<launch>
  <arg name="机" default="true" description="Show it"/>
  <node pkg="arm_description" exec="x" if="$(var 机█)"/>
  <include file="$(find-pkg-share arm_description)/launch/other.launch.py"/>
</launch>
"""
PYTHON = """def generate_launch_description():
    arm = get_package_share_directory('arm_description')
    return LaunchDescription([DeclareLaunchArgument('speed', default_value='1'),
        Node(package='█', name='arm')])
"""


def open_at_cursor(editor, name: str, text: str) -> types.TextDocumentPositionParams:
    """Open a text, and return the position of its cursor."""
    before = text[: text.index("█")]
    editor.open(name, text.replace("█", ""))
    position = types.Position(before.count("\n"), len(before) - before.rfind("\n") - 1)
    return types.TextDocumentPositionParams(editor.document(name), position)


@pytest.mark.parametrize(
    ("name", "text", "first"),
    [
        ("launch/a.launch.xml", '<launch><node pkg="█"/></launch>', "arm_description"),
        ("launch/a.launch.py", PYTHON, "arm_description"),
        ("msg/A.msg", "float█", "float64"),
        ("package.xml", "<package><export><build_type>█</build_type>", "ament_cmake"),
        ("config/arm.srdf", '<robot name="arm"><group name="g"><joint name="█"/>', "upper_joint"),
        ("config/arm.srdf", '<robot name="arm"><group name="g"><chain base_link="█"/>', "base"),
    ],
)
async def test_best_completion_comes_first(editor, name, text, first):
    parameters = open_at_cursor(editor, name, text)
    completions = await editor.client.text_document_completion_async(
        types.CompletionParams(parameters.text_document, parameters.position)
    )
    typed = "float" if name.endswith(".msg") else ""
    shown = [item for item in sorted(completions, key=lambda item: item.sort_text) if item.label.startswith(typed)]
    assert shown[0].label == first


async def test_hover_and_definition_of_launch_argument_are_found(editor):
    parameters = open_at_cursor(editor, "launch/a.launch.xml", XML)
    hover = await editor.client.text_document_hover_async(
        types.HoverParams(parameters.text_document, parameters.position)
    )
    assert "Show it" in hover.contents.value
    (definition,) = await editor.client.text_document_definition_async(
        types.DefinitionParams(parameters.text_document, parameters.position)
    )
    assert definition.range == types.Range(types.Position(1, 13), types.Position(1, 14))


async def test_links_and_symbols_of_launch_files_are_found(editor):
    launch = editor.folder / "launch"
    launch.mkdir()
    (launch / "other.launch.py").write_text("")
    parameters = open_at_cursor(editor, "launch/a.launch.xml", XML)
    (link,) = await editor.client.text_document_document_link_async(types.DocumentLinkParams(parameters.text_document))
    assert link.target == editor.uri("launch/other.launch.py")
    parameters = open_at_cursor(editor, "launch/b.launch.py", PYTHON)
    symbols = await editor.client.text_document_document_symbol_async(
        types.DocumentSymbolParams(parameters.text_document)
    )
    assert [symbol.name for symbol in symbols] == ["arg speed", "Node arm"]


async def test_references_and_highlights_of_launch_argument_are_found(editor):
    parameters = open_at_cursor(editor, "launch/a.launch.xml", XML)
    references = await editor.client.text_document_references_async(
        types.ReferenceParams(
            types.ReferenceContext(include_declaration=True), parameters.text_document, parameters.position
        )
    )
    assert [place.range.start.line for place in references] == [1, 2]
    references = await editor.client.text_document_document_highlight_async(
        types.DocumentHighlightParams(parameters.text_document, parameters.position)
    )
    assert [place.range.start.line for place in references] == [1, 2]
