"""The details of a robot's description for pages."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

from linkwright.descriptions import examine
from linkwright.diagnostics import LinkwrightError
from linkwright.rviz import RvizConfig
from tests.viewer.scene import ARM, open_page, open_world

WHEELED = """\
<robot name="wheeled" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="wheel.xacro"/>
  <xacro:property name="sizes" value="${xacro.load_yaml('sizes.yaml')}"/>
  <link name="base">
    <inertial>
      <origin xyz="0 0 0.1"/>
      <mass value="6"/>
      <inertia ixx="0.05" ixy="0" ixz="0" iyy="0.05" iyz="0" izz="0.05"/>
    </inertial>
  </link>
  <xacro:wheel side="left" y="${sizes['track'] / 2}"/>
  <xacro:wheel side="right" y="-0.2"/>
</robot>
"""
WHEEL = """\
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="wheel" params="side y">
    <link name="${side}_wheel">
      <visual><geometry><cylinder radius="0.1" length="0.05"/></geometry></visual>
      <inertial>
        <mass value="0.5"/>
        <inertia ixx="1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>
      </inertial>
    </link>
    <joint name="${side}_wheel_joint" type="revolute">
      <parent link="base"/>
      <child link="${side}_wheel"/>
      <origin xyz="0 ${y} 0" rpy="1.5707963267948966 0 0"/>
      <axis xyz="0 0 2"/>
      <limit lower="-1.5" upper="2" velocity="3" effort="4"/>
      <dynamics damping="0.5"/>
    </joint>
  </xacro:macro>
</robot>
"""
DISPLAY = "display-2"


@pytest.fixture
def files(tmp_path):
    (tmp_path / "robot.xacro").write_text(WHEELED)
    (tmp_path / "wheel.xacro").write_text(WHEEL)
    (tmp_path / "sizes.yaml").write_text("track: 0.4\n")
    return tmp_path


def describe(world, folder: Path) -> str:
    text = world.library.store(examine(folder / "robot.xacro"))
    world.describe(text)
    return text


async def request(client, request_kind: str, response_kind: str, **fields) -> dict:
    await client.send(request_kind, **fields)
    return await client.until(response_kind)


def text_of_range(text: str, written: dict) -> str:
    """Return the text of a range."""
    text_lines = text.splitlines(keepends=True)[written["line"] - 1 : written["end_line"]]
    text_lines[-1] = text_lines[-1][: written["end_column"] - 1]
    text_lines[0] = text_lines[0][written["column"] - 1 :]
    return "".join(text_lines)


async def test_description_has_links_and_joints_with_locations(files):
    async with open_world() as world, open_page(world.viewer) as client:
        text = describe(world, files)
        message = await request(client, "request_description", "description", display=DISPLAY)
    assert (message["name"], message["root"]) == ("wheeled", "base")
    links = {link["name"]: link for link in message["links"]}
    assert list(links) == ["base", "left_wheel", "right_wheel"]
    left = links["left_wheel"]
    assert (left["frame"], left["parent_joint"]) == ("left_wheel", "left_wheel_joint")
    assert text_of_range(text, left["written"]["expanded"]).startswith('<link name="left_wheel">')
    assert text_of_range(text, left["written"]["expanded"]).endswith("</link>")
    origin = left["written"]["origin"]
    assert origin["file"] == str(files / "wheel.xacro")
    assert (origin["line"], origin["end_line"]) == (3, 9)
    calls = [(call["macro"], Path(call["file"]).name, call["line"]) for call in left["written"]["calls"]]
    assert calls == [("wheel", "robot.xacro", 11)]
    (joint, _) = message["joints"]
    assert (joint["kind"], joint["parent"], joint["child"]) == ("revolute", "base", "left_wheel")
    assert joint["axis"] == [0, 0, 1]
    assert joint["xyz"] == pytest.approx([0, 0.2, 0])
    assert joint["rpy"] == pytest.approx([1.5707963, 0, 0])
    assert [joint[name] for name in ("lower", "upper", "velocity", "effort", "damping", "friction")] == [
        *(-1.5, 2, 3, 4, 0.5, 0),
    ]
    assert joint["soft_lower"] is None
    assert joint["mimic"] is None


async def test_inertia_is_shown_as_equivalent_box(files):
    async with open_world() as world, open_page(world.viewer) as client:
        describe(world, files)
        message = await request(client, "request_description", "description", display=DISPLAY)
    base, left, _ = (link["inertia"] for link in message["links"])
    assert (base["mass"], base["center"]) == (6, [0, 0, 0.1])
    # A cube of edge a has I = m a2 / 6.
    assert base["box"] == pytest.approx([(0.05 * 6 / 6) ** 0.5] * 3)
    assert left["box"] == []  # 1 > 0.1 + 0.1 is impossible for a body


async def test_implausible_inertias_are_reported_for_each_link_of_macro(files):
    async with open_world() as world, open_page(world.viewer) as client:
        describe(world, files)
        message = await request(client, "request_inertia", "inertia_findings", display=DISPLAY)
    broken = [finding["link"] for finding in message["findings"] if finding["code"] == "LW314"]
    assert broken == ["left_wheel", "right_wheel"]
    assert all(finding["message"] and finding["code"].startswith("LW3") for finding in message["findings"])


async def test_texts_are_sent_only_for_files_of_description(files):
    (files / "secret.txt").write_text("secret")
    async with open_world() as world, open_page(world.viewer) as client:
        text = describe(world, files)
        message = await request(client, "request_description", "description", display=DISPLAY)
        assert [Path(name).name for name in message["files"]] == ["robot.xacro", "wheel.xacro", "sizes.yaml"]

        async def text_of(file: str) -> str | None:
            response = await request(client, "request_description_text", "description_text", display=DISPLAY, file=file)
            assert response["file"] == file
            return response["text"]

        assert await text_of("") == text
        assert await text_of(str(files / "wheel.xacro")) == WHEEL
        assert await text_of(str(files / "sizes.yaml")) == "track: 0.4\n"
        for other in ("secret.txt", "../secret.txt", "wheel.xacro/../secret.txt"):
            assert await text_of(str(files / other)) is None
        assert await text_of("/etc/hostname") is None
        # The page gets the texts from which the description was made.
        (files / "wheel.xacro").write_text("<robot/>")
        assert await text_of(str(files / "wheel.xacro")) == WHEEL


async def test_edit_is_reported_with_changed_links_and_joints(files):
    async with open_world() as world, open_page(world.viewer) as client:
        describe(world, files)
        first = await client.until("description_changed")
        assert (first["links"], first["joints"]) == ([], [])
        (files / "wheel.xacro").write_text(WHEEL.replace('radius="0.1"', 'radius="0.2"'))
        describe(world, files)
        second = await client.until("description_changed")
        assert (second["links"], second["joints"]) == (["left_wheel", "right_wheel"], [])
        (files / "robot.xacro").write_text(
            WHEELED.replace("-0.2", "-0.3").replace('  <link name="base"', '\n<link name="base"')
        )
        describe(world, files)
        third = await client.until("description_changed")
        assert (third["links"], third["joints"]) == ([], ["right_wheel_joint"])
        assert first["revision"] < second["revision"] < third["revision"]


async def test_opened_page_is_notified_of_description():
    async with open_world() as world:
        world.describe(ARM)
        await world.settle()
        async with open_page(world.viewer) as client:
            message = await client.until("description_changed", display=DISPLAY)
            assert (message["links"], message["joints"]) == ([], [])
            details = await request(client, "request_description", "description", display=DISPLAY)
    assert details["revision"] == message["revision"]
    # The description was published as text, without files.
    assert details["files"] == []
    assert details["links"][0]["written"]["origin"] is None
    assert details["links"][0]["written"]["expanded"]["line"] == 2


async def test_text_with_errors_is_sent_instead_of_shown_robot(files):
    async with open_world() as world, open_page(world.viewer) as client:
        describe(world, files)
        (files / "robot.xacro").write_text(WHEELED.replace('side="left"', 'sid="left"'))
        with pytest.raises(LinkwrightError) as caught:
            examine(files / "robot.xacro")
        world.viewer.show_diagnostics(caught.value.diagnostics)
        file = str(files / "robot.xacro")
        message = await request(client, "request_description_text", "description_text", display=DISPLAY, file=file)
        assert 'sid="left"' in message["text"]
        world.viewer.show_diagnostics([])
        message = await request(client, "request_description_text", "description_text", display=DISPLAY, file=file)
        assert message["text"] == WHEELED


async def test_robot_with_all_meshes_missing_is_reported(files):
    box = '<visual><geometry><box size="1 1 1"/></geometry></visual>'
    mesh = f'<visual><geometry><mesh filename="file://{files}/gone.stl"/></geometry></visual>'
    async with open_world() as world, open_page(world.viewer) as client:
        assert (await client.until("diagnostics"))["items"] == []
        for shapes, codes in ((mesh, ["VIEW207"]), (box + mesh, []), (mesh, ["VIEW207"])):
            world.describe(f'<robot name="r"><link name="base">{shapes}</link></robot>')
            message = await client.until("diagnostics")
            assert [item["code"] for item in message["items"]] == codes
        (note,) = message["items"][0]["notes"]
        assert "gone.stl" in note["message"]


async def test_requests_for_unknown_display_are_ignored():
    async with open_world(RvizConfig.for_model("base")) as world, open_page(world.viewer) as client:
        response = await request(
            client, "request_description_text", "description_text", display="display-99", file="/etc/passwd"
        )
        assert response["text"] is None
        await client.send("request_description", display="display-99")
        await client.send("request_inertia", display="display-99")
        remaining_messages = await client.drain()
    assert not [
        message for message in remaining_messages if isinstance(message, dict) and message["type"] == "description"
    ]


async def test_page_with_own_displays_receives_only_their_descriptions(files):
    async with open_world() as world, open_page(world.viewer) as shared:
        describe(world, files)
        response = await shared.until("description_changed")
        async with open_page(SimpleNamespace(url=f"{world.viewer.url}&own=of-my-own")) as own_client:
            own_description = await own_client.until("description_changed")
            assert own_description["display"] != response["display"]
            await own_client.send(
                "request_description", display=response["display"]
            )  # this page does not have that display
            details = await request(
                own_client, "request_description", "description", display=own_description["display"]
            )
            assert details["display"] == own_description["display"]
            describe(world, files)
            remaining_messages = await shared.drain()
    kinds = [
        message["display"]
        for message in remaining_messages
        if isinstance(message, dict) and "description_changed" in message["type"]
    ]
    assert set(kinds) <= {response["display"]}
