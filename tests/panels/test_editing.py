"""Editing a robot in the page: editable values, previews, writing, undo."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from linkwright.descriptions import examine
from linkwright.page.audience import Page
from tests.viewer.scene import ARM, open_page, open_world

ROBOT = """\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="height" value="0.25"/>
  <link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <xacro:macro name="side" params="name">
    <link name="${name}"/>
    <joint name="${name}_joint" type="fixed">
      <origin xyz="0 0 0.1"/><parent link="base"/><child link="${name}"/>
    </joint>
  </xacro:macro>
  <xacro:side name="left"/>
  <xacro:side name="right"/>
  <link name="mast">
    <visual name="pole"><origin xyz="0 0 0.5"/><geometry><cylinder radius="0.1" length="1"/></geometry></visual>
    <collision><geometry><mesh filename="package://nowhere/mast.stl"/></geometry></collision>
    <inertial><origin xyz="0 0 0.4"/><mass value="1.5"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <joint name="turn" type="continuous">
    <origin xyz="0 0 ${height}" rpy="0 0 0.5"/><parent link="base"/><child link="mast"/><axis xyz="0 0 1"/>
  </joint>
</robot>
"""
DISPLAY = "display-2"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "robot.xacro"
    path.write_text(ROBOT)
    return path


def describe(world: Any, file: Path) -> None:
    world.describe(world.library.store(examine(file)))


def file_content(file: Path) -> str:
    return file.read_text()


def write_file(file: Path, text: str) -> None:
    file.write_text(text)


def delete_file(file: Path) -> None:
    file.unlink()


async def request(client: Any, request_kind: str, response_kind: str, **fields: Any) -> dict[str, Any]:
    await client.send(request_kind, **fields)
    response: dict[str, Any] = await client.until(response_kind)
    return response


async def request_parts(client: Any, link: str) -> dict[str, Any]:
    return await request(client, "request_editable_parts", "editable_parts", display=DISPLAY, link=link)


async def request_preview(client: Any, number: int, part: str, name: str, **fields: Any) -> dict[str, Any]:
    question = {"index": 0, "xyz": None, "rpy": None, "together": False, **fields}
    return await request(
        client, "preview_edit", "edit_preview", number=number, display=DISPLAY, part=part, name=name, **question
    )


async def test_link_parts_have_numbers_and_locations(file: Path) -> None:
    async with open_world() as world, open_page(world.viewer) as client:
        describe(world, file)
        await client.until("description_changed")
        response = await request_parts(client, "mast")
        assert response["refusal_reason"] == ""
        part_facts = [
            (part["part"], part["name"], part["title"], part["xyz"], part["rpy"]) for part in response["parts"]
        ]
        assert part_facts == [
            ("joint", "turn", "continuous", [0, 0, 0.25], [0, 0, 0.5]),
            ("axis", "turn", "continuous", [0, 0, 1], []),
            ("visual", "mast", "pole", [0, 0, 0.5], [0, 0, 0]),
            ("collision", "mast", "mast.stl", [0, 0, 0], [0, 0, 0]),
            ("inertial", "mast", "1.5 kg", [0, 0, 0.4], [0, 0, 0]),
        ]
        assert [part["written"] for part in response["parts"]] == [
            'xyz="0 0 ${height}" rpy="0 0 0.5"',
            'xyz="0 0 1"',
            'xyz="0 0 0.5"',
            "",
            'xyz="0 0 0.4"',
        ]
        assert {(part["file"], part["line"]) for part in response["parts"][:2]} == {(str(file), 19)}


async def test_sdf_robot_cannot_be_edited(tmp_path: Path) -> None:
    file = tmp_path / "crate.sdf"
    box = "<geometry><box><size>1 1 1</size></box></geometry>"
    file.write_text(
        f'<sdf version="1.9"><model name="crate"><link name="base"><visual name="v">{box}</visual></link></model></sdf>'
    )
    async with open_world() as world, open_page(world.viewer) as client:
        describe(world, file)
        await client.until("description_changed")
        response = await request_parts(client, "base")
        assert "described in SDF" in response["refusal_reason"]
        refused = await request_preview(client, 1, "visual", "base", xyz=[0, 0, 1])
        assert refused["files"] == []
        assert refused["refusal"]["message"] == response["refusal_reason"]


async def test_edit_is_previewed_written_and_undone(file: Path) -> None:
    async with open_world() as world, open_page(world.viewer) as client:
        describe(world, file)
        await client.until("description_changed")
        shown = await request_preview(client, 7, "joint", "turn", xyz=[0, 0, 0.3])
        assert (shown["number"], shown["refusal"], shown["also"]) == (7, None, [])
        (changed,) = shown["files"]
        assert changed["file"] == str(file)
        old, new = '  <xacro:property name="height" value="0.25"/>', '  <xacro:property name="height" value="0.3"/>'
        assert [line for line in changed["diff"] if line[0] in "+-"] == [f"-{old}", f"+{new}"]
        assert file_content(file) == ROBOT

        written = await request(client, "apply_edit", "edit_written", number=7)
        assert (written["files"], written["refusal"]) == ([str(file)], None)
        assert file_content(file) == ROBOT.replace(old, new)
        history = await client.until("edit_history")
        assert (history["can_undo"], history["can_redo"]) == (True, False)

        await request(client, "undo_edit", "edit_written")
        assert file_content(file) == ROBOT
        await request(client, "redo_edit", "edit_written")
        assert file_content(file) == ROBOT.replace(old, new)


async def test_only_previewed_edit_is_written(file: Path) -> None:
    async with open_world() as world, open_page(world.viewer) as client:
        describe(world, file)
        await client.until("description_changed")
        await request_preview(client, 1, "joint", "turn", xyz=[0, 0, 0.3])
        assert (await request(client, "apply_edit", "edit_written", number=2))["refusal"]["code"] == "EDIT101"
        assert file_content(file) == ROBOT


async def test_edit_with_side_effects_requires_together_option(file: Path) -> None:
    async with open_world() as world, open_page(world.viewer) as client:
        describe(world, file)
        await client.until("description_changed")
        refused = await request_preview(client, 1, "joint", "left_joint", xyz=[0, 0, 0.2])
        assert refused["files"] == []
        assert refused["refusal"]["code"] == "EDIT104"
        assert refused["refusal"]["line"] == 7
        assert "right_joint" in refused["refusal"]["message"]
        shown = await request_preview(client, 2, "joint", "left_joint", xyz=[0, 0, 0.2], together=True)
        assert (shown["refusal"], shown["also"]) == (None, ["joint 'right_joint'"])


async def test_file_changed_after_preview_is_not_overwritten(file: Path) -> None:
    async with open_world() as world, open_page(world.viewer) as client:
        describe(world, file)
        await client.until("description_changed")
        await request_preview(client, 1, "joint", "turn", xyz=[0, 0, 0.3])
        write_file(file, ROBOT + "<!-- mine -->")
        assert (await request(client, "apply_edit", "edit_written", number=1))["refusal"]["code"] == "EDIT107"
        assert file_content(file) == ROBOT + "<!-- mine -->"


async def test_malformed_or_missing_file_is_reported_and_editing_continues(file: Path) -> None:
    async with open_world() as world, open_page(world.viewer) as client:
        describe(world, file)
        await client.until("description_changed")
        write_file(file, "<robot")
        assert (await request_preview(client, 1, "joint", "turn", xyz=[0, 0, 1]))["refusal"]["code"].startswith("XML")
        delete_file(file)
        assert (await request_preview(client, 2, "joint", "turn", xyz=[0, 0, 1]))["refusal"] is not None
        write_file(file, ROBOT)
        assert (await request_preview(client, 3, "joint", "turn", xyz=[0, 0, 1]))["refusal"] is None
        assert (await request_preview(client, 4, "joint", "turn", xyz=[0, 1]))["refusal"]["code"] == "EDIT102"


async def test_description_without_file_cannot_be_edited(file: Path) -> None:
    async with open_world() as world, open_page(world.viewer) as client:
        world.describe(ARM)
        await client.until("description_changed")
        response = await request_parts(client, "base")
        assert "linkwright view FILE" in response["refusal_reason"]
        assert (await request_preview(client, 1, "joint", "shoulder", xyz=[0, 0, 1]))["refusal"]["code"] == "EDIT101"


async def test_page_on_another_machine_cannot_edit(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    initialize = Page.__init__

    def elsewhere(self: Page, *words: Any, is_local: bool = False, **named: Any) -> None:
        assert is_local, "the page of the test is on this machine"
        initialize(self, *words, is_local=False, **named)

    monkeypatch.setattr(Page, "__init__", elsewhere)
    async with open_world() as world, open_page(world.viewer) as client:
        describe(world, file)
        await client.until("description_changed")
        assert "open on the machine with the files" in (await request_parts(client, "mast"))["refusal_reason"]
        assert (await request_preview(client, 1, "joint", "turn", xyz=[0, 0, 1]))["refusal"]["code"] == "EDIT109"
        assert (await request(client, "undo_edit", "edit_written"))["refusal"]["code"] == "EDIT109"
    assert file_content(file) == ROBOT
