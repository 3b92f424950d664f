"""Completion, hover and definition, through the protocol."""

from __future__ import annotations

import pytest
from lsprotocol import types

from tests.lsp.conftest import MAIN, PARTS, connect_editor

FILE = "urdf/arm.urdf.xacro"
CURSOR = "█"


async def complete(editor, text: str, name: str = FILE) -> list[str]:
    """Return the labels of the completions at the cursor."""
    before = text[: text.index(CURSOR)]
    editor.open(name, text.replace(CURSOR, ""))
    position = types.Position(before.count("\n"), len(before) - before.rfind("\n") - 1)
    completions = await editor.client.text_document_completion_async(
        types.CompletionParams(editor.document(name), position)
    )
    return [item.label for item in completions]


async def request_at_cursor(editor, request, kind):
    text = MAIN.replace('length="0.4"', 'length="${2 * reach}"').replace(
        '<link name="base"/>', '<xacro:property name="reach" value="0.2"/>\n  <link name="base"/>'
    )
    if "reach" not in editor.__dict__:
        editor.open(FILE, text)
        editor.__dict__["reach"] = text
    before = text[: text.index(request) + len(request)]
    position = types.Position(before.count("\n"), len(before) - before.rfind("\n") - 1)
    return await kind(position)


@pytest.mark.parametrize(
    ("typed", "expected_labels", "not_offered"),
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
async def test_completions_depend_on_context(editor, typed, expected_labels, not_offered):
    completions = set(await complete(editor, MAIN.replace("<xacro:bar", typed + "\n  <xacro:bar", 1)))
    assert expected_labels <= completions
    assert not not_offered & completions


async def test_world_elements_are_completed_in_world(editor):
    assert "light" in await complete(editor, '<sdf version="1.9"><world name="w"><█', "a.world")


async def test_hover_explains_elements_attributes_and_names(editor):
    async def hover(position: types.Position) -> str:
        hover = await editor.client.text_document_hover_async(types.HoverParams(editor.document(FILE), position))
        return "" if hover is None else hover.contents.value

    assert "`<link>`" in await request_at_cursor(editor, "<lin", hover)
    assert "**macro bar**" in await request_at_cursor(editor, "<xacro:ba", hover)
    assert "`name length`" in await request_at_cursor(editor, "<xacro:ba", hover)
    assert "**property reach** = `0.2`" in await request_at_cursor(editor, "* rea", hover)
    assert await request_at_cursor(editor, "<xacro:bar na", hover) == "**name** (required), xacro:bar, parts.xacro"
    assert "name" in await request_at_cursor(editor, "<link na", hover)
    assert await request_at_cursor(editor, "\n", hover) == ""


async def test_definition_is_found_in_included_file(editor):
    async def define(position: types.Position):
        parameters = types.DefinitionParams(editor.document(FILE), position)
        return [
            (definition.uri.rpartition("/")[2], definition.range.start.line)
            for definition in await editor.client.text_document_definition_async(parameters)
        ]

    assert await request_at_cursor(editor, "<xacro:ba", define) == [("parts.xacro", 1)]
    assert await request_at_cursor(editor, "* rea", define) == [("arm.urdf.xacro", 2)]
    assert await request_at_cursor(editor, "<xacro:bar na", define) == [("parts.xacro", 1)]


async def test_hover_describes_links_joints_meshes_and_packages(editor, package):
    (package / "meshes").mkdir()
    triangle = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0.5 0 0\nvertex 0 2 1\nendloop\nendfacet\n"
    (package / "meshes" / "a.stl").write_text(f"solid a\n{triangle}endsolid a\n")
    text = MAIN.replace(
        '<link name="base"/>',
        '<link name="base"><inertial><mass value="2"/><inertia ixx="0.1" iyy="0.2" izz="0.3" ixy="0" ixz="0" '
        'iyz="0"/></inertial><visual><geometry><mesh filename="package://arm_description/meshes/a.stl"/></geometry>'
        "</visual></link>",
    )
    editor.open(FILE, text)

    async def hover(name: str, text: str, place: str) -> str:
        before = text[: text.index(place) + len(place)]
        position = types.Position(before.count("\n"), len(before) - before.rfind("\n") - 1)
        hover = await editor.client.text_document_hover_async(types.HoverParams(editor.document(name), position))
        return "" if hover is None else hover.contents.value

    base = await hover(FILE, text, 'link name="ba')
    assert "- root of the link tree" in base
    assert "- parent of `upper`" in base
    assert "- mass 2 kg" in base
    assert "0.5 × 2 × 1 m, triangles: 1" in await hover(FILE, text, "meshes/a")
    assert "**arm_description**: An arm." in await hover(FILE, text, "package://arm")
    editor.open("urdf/parts.xacro")
    joint = await hover("urdf/parts.xacro", PARTS, "${name}_jo")
    assert "**joint upper_joint**" in joint
    assert "- continuous joint from `base` to `upper`" in joint


async def test_hover_of_link_uses_facts_of_its_own_file(package):
    """Macros of several arms in one package give the same names to their links.

    xarm_description does so.
    """
    arm = (
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="{0}"><link name="elbow"><inertial>'
        '<mass value="{1}"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
        "</xacro:macro></robot>"
    )
    template = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">{}</robot>'
    included = "".join(f'<xacro:include filename="{name}.xacro"/>' for name in ("first", "second"))
    masses = {"first": 1.5, "second": 2.5, "third": 3.5}
    for name, mass in masses.items():
        (package / "urdf" / f"{name}.xacro").write_text(arm.format(name, mass))
    (package / "urdf" / "a.urdf.xacro").write_text(template.format(f"{included}<xacro:second/>"))
    (package / "urdf" / "b.urdf.xacro").write_text(template.format(f"{included}<xacro:first/>"))
    (package / "urdf" / "c.urdf.xacro").write_text(
        template.format('<xacro:include filename="third.xacro"/><link name="elbow"/>')
    )
    shown = {}
    async with connect_editor(package, types.ClientCapabilities()) as editor:
        for name, mass in masses.items():
            editor.open(f"urdf/{name}.xacro")
            position = types.Position(0, arm.format(name, mass).index('"elbow"') + 2)
            parameters = types.HoverParams(editor.document(f"urdf/{name}.xacro"), position)
            shown[name] = (await editor.client.text_document_hover_async(parameters)).contents.value
    assert "- mass 1.5 kg" in shown["first"]
    assert "- mass 2.5 kg" in shown["second"]
    assert "**link elbow**" not in shown["third"]


async def test_hover_of_material_shows_color(editor):
    material = '<material name="orange">\n    <color rgba="1 0.5 0 1"/></material>'
    use = '<link name="tip"><visual><geometry/><material name="orange"/></visual></link>'
    text = MAIN.replace("</robot>", f"{material}{use}</robot>")
    editor.open(FILE, text)
    before = text[: text.rindex("orange") + 2]
    position = types.Position(before.count("\n"), len(before) - before.rfind("\n") - 1)
    hover = await editor.client.text_document_hover_async(types.HoverParams(editor.document(FILE), position))
    assert "**material orange** = `1 0.5 0 1`" in hover.contents.value


async def test_completion_items_have_filter_text(editor):
    """Neovim offers an item that has an edit and no filter text for any typed text."""
    editor.open(FILE, MAIN.replace("<link", "<li"))
    parameters = types.CompletionParams(editor.document(FILE), types.Position(2, 5))
    completions = await editor.client.text_document_completion_async(parameters)
    assert {item.filter_text for item in completions} >= {"link", "xacro:bar"}


async def test_editor_without_snippets_gets_sorted_plain_text(editor):
    text = MAIN.replace("<xacro:bar", '<joint name="a" type="revolute">\n    █\n  </joint>\n  <xacro:bar', 1)
    before = text[: text.index(CURSOR)]
    editor.open(FILE, text.replace(CURSOR, ""))
    position = types.Position(before.count("\n"), len(before) - before.rfind("\n") - 1)
    completions = await editor.client.text_document_completion_async(
        types.CompletionParams(editor.document(FILE), position)
    )
    first = completions[0]
    assert (first.label, first.text_edit.new_text, first.filter_text) == ("parent", "<parent", "<parent")
    assert first.insert_text_format == types.InsertTextFormat.PlainText
    assert [item.sort_text for item in completions] == sorted(item.sort_text for item in completions)
    assert len({item.label for item in completions}) == len(completions)


async def test_macro_link_is_completed_while_text_is_invalid(editor):
    assert "upper" in await complete(editor, MAIN.replace("</robot>", '<joint name="b"><parent link="up█'))
