"""Completion, hover and definition, through the protocol."""

from __future__ import annotations

import pytest
from lsprotocol import types

from tests.lsp.conftest import MAIN

FILE = "urdf/arm.urdf.xacro"
CURSOR = "█"


async def complete(editor, text: str, name: str = FILE) -> list[str]:
    """Return the labels that are offered at the cursor."""
    before = text[: text.index(CURSOR)]
    editor.open(name, text.replace(CURSOR, ""))
    at = types.Position(before.count("\n"), len(before) - before.rfind("\n") - 1)
    found = await editor.client.text_document_completion_async(types.CompletionParams(editor.document(name), at))
    return [item.label for item in found]


async def look(editor, request, kind):
    text = MAIN.replace('length="0.4"', 'length="${2 * reach}"').replace(
        '<link name="base"/>', '<xacro:property name="reach" value="0.2"/>\n  <link name="base"/>'
    )
    if "reach" not in editor.__dict__:
        editor.open(FILE, text)
        editor.__dict__["reach"] = text
    before = text[: text.index(request) + len(request)]
    at = types.Position(before.count("\n"), len(before) - before.rfind("\n") - 1)
    return await kind(at)


@pytest.mark.parametrize(
    ("typed", "offered", "not_offered"),
    [
        ("<█", {"link", "joint", "material", "xacro:property", "xacro:bar"}, {"visual"}),
        ('<link name="tip"><vis█</link>', {"visual", "collision", "inertial"}, {"joint"}),
        ('<joint name="j" █/>', {"type"}, {"name"}),
        ('<joint name="j" type="█"/>', {"revolute", "continuous", "fixed"}, {"ball"}),
        ('<joint name="j"><parent link="█"/></joint>', {"base"}, {"j"}),
        ("<xacro:bar █/>", {"name", "length"}, {"params"}),
        ('<xacro:property name="a" value="2"/><xacro:bar name="${█', {"a", "sin", "pi"}, {"base"}),
        ('<xacro:arg name="b" default="2"/><xacro:bar name="$(arg █', {"b"}, {"a"}),
        ('<xacro:include filename="$(find █', {"arm_description"}, set()),
        ('<xacro:include filename="$(find arm_description)/urdf/█', {"parts.xacro"}, {"package.xml"}),
        ('<mesh filename="package://arm_description/█"/>', {"urdf", "package.xml"}, set()),
        ("<link></█", {"link"}, {"joint"}),
    ],
)
async def test_what_a_place_may_have_is_offered(editor, typed, offered, not_offered):
    found = set(await complete(editor, MAIN.replace("<xacro:bar", typed + "\n  <xacro:bar", 1)))
    assert offered <= found
    assert not not_offered & found


async def test_words_of_a_world_are_offered_in_a_world(editor):
    assert "light" in await complete(editor, '<sdf version="1.9"><world name="w"><█', "a.world")


async def test_a_hover_explains_elements_attributes_and_names(editor):
    async def hover(at: types.Position) -> str:
        found = await editor.client.text_document_hover_async(types.HoverParams(editor.document(FILE), at))
        return "" if found is None else found.contents.value

    assert "`<link>`" in await look(editor, "<lin", hover)
    assert "**macro bar**" in await look(editor, "<xacro:ba", hover)
    assert "`name length`" in await look(editor, "<xacro:ba", hover)
    assert "**property reach** = `0.2`" in await look(editor, "* rea", hover)
    assert "name" in await look(editor, "<link na", hover)
    assert await look(editor, "\n", hover) == ""


async def test_a_definition_is_found_in_an_included_file(editor):
    async def define(at: types.Position):
        asked = types.DefinitionParams(editor.document(FILE), at)
        return [
            (found.uri.rpartition("/")[2], found.range.start.line)
            for found in await editor.client.text_document_definition_async(asked)
        ]

    assert await look(editor, "<xacro:ba", define) == [("parts.xacro", 1)]
    assert await look(editor, "* rea", define) == [("arm.urdf.xacro", 2)]
