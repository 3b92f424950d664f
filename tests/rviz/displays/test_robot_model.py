"""The RobotModel display: descriptions, links, joints and statuses."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import String
from linkwright.rviz import RvizConfig
from tests.page.test_files import write_file, write_package
from tests.viewer.scene import ARM, World, open_page, open_world, rows_by_id

ARM_WITH_MESH = ARM.replace('<box size="1 2 3"/>', '<mesh filename="package://robot/meshes/arm.stl"/>')


def make_config(extra: str = "") -> RvizConfig:
    return RvizConfig.parse(
        "Visualization Manager:\n"
        "  Global Options: {Fixed Frame: base}\n"
        "  Displays:\n"
        f"    - {{Class: rviz_default_plugins/RobotModel, Name: Robot, Enabled: true{extra}}}\n"
    )


async def open_client(world):
    async with open_page(world.viewer) as client:
        return await client.opened()


async def test_robot_model_waits_for_description():
    async with open_world(make_config()) as world:
        opening = await open_client(world)
    assert opening["robot_scene"]["links"] == []
    assert world.status("RobotModel") == {"Topic": ("warn", "No messages received")}


async def test_description_becomes_scene_with_rows_and_status():
    async with open_world(make_config()) as world:
        world.describe(ARM)
        await world.settle()
        opening = await open_client(world)
        scene = opening["robot_scene"]
        assert (scene["display"], scene["name"], scene["revision"]) == ("display-1", "arm", 1)
        assert [link["name"] for link in scene["links"]] == ["base", "tip", "mark"]
        assert world.status("RobotModel") == {
            "Topic": ("ok", "OK"),
            "URDF": ("ok", "URDF parsed OK"),
            "base": ("ok", "Transform OK"),
            "mark": ("error", "No transform from [mark] to [base]"),
            "tip": ("error", "No transform from [tip] to [base]"),
        }
        world.move_arm()
        await world.settle()
        await open_client(world)
        assert {text for _, text in world.status("RobotModel").values()} == {"OK", "URDF parsed OK", "Transform OK"}


async def test_robot_model_properties_match_rviz():
    async with open_world(make_config()) as world:
        world.describe(ARM)
        await world.settle()
        properties = (await open_client(world))["tree"]["displays"][0]["properties"]
    values = {row["name"]: row["value"] for row in properties}
    assert values == {
        "Visual Enabled": True,
        "Collision Enabled": False,
        "Update Interval": 0.0,
        "Alpha": 1.0,
        "Description Source": "Topic",
        "Description Topic": "/robot_description",
        "TF Prefix": "",
        "Mass Properties": None,
        "Links": None,
        "Joints": None,
    }
    rows = rows_by_id(properties)
    masses = {row["name"]: row["value"] for row in rows["display-1/Mass Properties"]["children"]}
    assert masses == {"Mass": False, "Inertia": False}
    options = {row["name"]: row["value"] for row in rows["display-1/Links"]["children"][:5]}
    assert options == {
        "Link Tree Style": "Links in Alphabetic Order",
        "Expand Tree": False,
        "Expand Link Details": False,
        "Expand Joint Details": False,
        "All Links Enabled": True,
    }
    assert (rows["display-1/Joints/turn"]["kind"], rows["display-1/Joints/fix"]["kind"]) == ("bool", "group")
    assert [row["name"] for row in rows["display-1/Joints/turn"]["children"]] == ["Show Axes", "Show Joint Axis"]
    assert [row["name"] for row in rows["display-1/Joints/fix"]["children"]] == ["Show Axes"]
    details = [rows[f"display-1/{name}"]["details"] for name in ("Links/base", "Links/mark", "Joints/fix", "Links")]
    assert details == ["link", "link", "joint", None]
    assert rows["display-1/Links/All Links Enabled"]["value"] is True
    assert (rows["display-1/Links/base"]["kind"], rows["display-1/Links/mark"]["kind"]) == ("bool", "group")
    assert [row["name"] for row in rows["display-1/Links/base"]["children"]] == ["Alpha", "Show Trail", "Show Axes"]
    assert rows["display-1/Links/tip/Alpha"]["maximum"] == 1.0


async def test_link_properties_are_read_from_file():
    async with open_world(make_config(", Alpha: 0.8, Links: {tip: {Alpha: 0.25, Value: false}}")) as world:
        world.describe(ARM)
        await world.settle()
        rows = rows_by_id((await open_client(world))["tree"]["displays"][0]["properties"])
    assert rows["display-1/Alpha"]["value"] == 0.8
    assert rows["display-1/Links/tip"]["value"] is False
    assert rows["display-1/Links/tip/Alpha"]["value"] == 0.25
    assert rows["display-1/Links/base"]["value"] is True


async def test_all_links_enabled_sets_all_links():
    async with open_world(make_config()) as world:
        world.describe(ARM)
        await world.settle()
        async with open_page(world.viewer) as client:
            await client.opened()
            await client.set("display-1/Links/All Links Enabled", False)
            for name in ("Links/base", "Links/tip", "Joints/turn"):
                assert (await client.until("property_changed", id=f"display-1/{name}"))["value"] is False
            assert world.viewer.config.displays[0].section.scalar("Links", "tip").text == "false"


async def test_joint_checkbox_sets_links_below_and_follows_them():
    async with open_world(make_config(", Links: {Link Tree Style: Tree of links and joints}")) as world:
        world.describe(
            ARM.replace(
                '<link name="mark"/>',
                '<link name="mark"><visual><geometry><sphere radius="1"/></geometry></visual></link>',
            )
        )
        await world.settle()
        display = world.display("RobotModel")

        def boxes() -> dict[str, object]:
            paths = (("Links", "base"), ("Links", "tip"), ("Links", "mark"), ("Joints", "turn"), ("Joints", "fix"))
            property_values = {path[1]: display.properties.get(*path) for path in paths}
            return {**property_values, "all": display.properties.get("Links", "All Links Enabled")}

        all_enabled = dict.fromkeys(boxes(), True)
        assert boxes() == all_enabled
        display.set_property(("Joints", "turn"), False)
        assert boxes() == {**dict.fromkeys(all_enabled, False), "base": True}
        display.set_property(("Links", "mark"), True)
        assert boxes() == {**all_enabled, "tip": False, "turn": False, "all": False}
        display.set_property(("Links", "tip"), True)
        assert boxes() == all_enabled
        display.set_property(("Links", "Link Tree Style"), "Joints in Alphabetic Order")
        display.set_property(("Joints", "turn"), False)
        assert boxes() == {**all_enabled, "tip": False, "turn": False, "all": False}


@pytest.mark.parametrize("box", ["Joints/turn", "Links/All Links Enabled", "Links/base"])
async def test_undo_reverts_all_links_set_by_checkbox(box):
    async with open_world(make_config(", Links: {tip: {Value: false}}")) as world:
        world.describe(ARM)
        await world.settle()
        display = world.display("RobotModel")
        paths = (("Links", "base"), ("Links", "tip"), ("Joints", "turn"), ("Links", "All Links Enabled"))

        def boxes() -> list[object]:
            return [display.properties.get(*path) for path in paths]

        before, text = boxes(), world.viewer.config.text()
        assert before == [True, False, False, False]
        async with open_page(world.viewer) as client:
            await client.opened()
            value = not display.properties.get(*box.split("/"))
            await client.set(f"display-1/{box}", value)
            await client.until("property_changed", id=f"display-1/{box}")
            assert boxes() != before
            await client.send("undo")
            await client.until("display_properties", display="display-1")
            assert boxes() == before
            assert world.viewer.config.text() == text


async def test_link_checkboxes_do_not_change_file_on_load():
    text = ", Links: {All Links Enabled: true, tip: {Value: false}}"
    async with open_world(make_config(text)) as world:
        before = world.viewer.config.text()
        world.describe(ARM)
        await world.settle()
        display = world.display("RobotModel")
        assert display.properties.get("Joints", "turn") is False
        assert display.properties.get("Links", "All Links Enabled") is False
        assert world.viewer.config.text() == before


async def test_joint_and_mass_properties_come_from_description():
    inertial_text = '<inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    limited = '<axis xyz="0 0 1"/><origin xyz="0 0 1"/><limit lower="-1" upper="2" effort="1" velocity="1"/>'
    async with open_world(make_config()) as world:
        text = ARM.replace('type="continuous"', 'type="revolute"').replace('<axis xyz="0 0 1"/>', limited)
        world.describe(text.replace('<link name="mark"/>', f'<link name="mark">{inertial_text}</link>'))
        await world.settle()
        scene = (await open_client(world))["robot_scene"]
    turn, fix = scene["joints"]
    assert turn == {
        "name": "turn",
        "kind": "revolute",
        "parent": "base",
        "child": "tip",
        "position": [0.0, 0.0, 1.0],
        "quaternion": [0.0, 0.0, 0.0, 1.0],
        "axis": [0.0, 0.0, 1.0],
        "lower": -1.0,
        "upper": 2.0,
    }
    assert (fix["kind"], fix["lower"]) == ("fixed", None)
    base, _, mark = scene["links"]
    assert base["inertia"] is None
    assert mark["inertia"]["mass"] == 2.0
    assert mark["inertia"]["box"] == pytest.approx([3**0.5] * 3)


async def test_new_description_replaces_robot_and_frames():
    async with open_world(make_config()) as world, open_page(world.viewer) as client:
        world.describe(ARM)
        world.move_arm()
        await client.until("robot_scene", revision=1)
        world.describe(ARM.replace('"mark"', '"point"'))
        scene = await client.until("robot_scene", revision=2)
        assert [link["name"] for link in scene["links"]] == ["base", "tip", "point"]
        await client.drain()  # the frame table may arrive before or after the scene
        tables = [
            message for message in client.messages if isinstance(message, dict) and message["type"] == "frame_table"
        ]
        assert sorted(tables[-1]["names"]) == ["base", "tip"]


async def test_new_description_waits_while_time_is_paused():
    async with open_world(make_config()) as world:
        world.describe(ARM)
        await world.settle()
        world.viewer.manager.set_time(paused=True, mode="Off", source="")
        world.describe(ARM.replace('"mark"', '"point"'))
        await world.settle()
        assert "mark" in world.display("RobotModel").robot.links
        world.viewer.manager.set_time(paused=False, mode="Off", source="")
        assert "point" in world.display("RobotModel").robot.links


async def test_repeated_description_changes_nothing():
    async with open_world(make_config()) as world:
        world.describe(ARM)
        await world.settle()
        async with open_page(world.viewer) as client:
            await client.opened()
            world.describe(ARM)
            assert [message for message in await client.drain() if isinstance(message, dict)] == []


@pytest.mark.parametrize(
    ("text", "rows"),
    [
        ("", {"URDF": ("error", "URDF is empty")}),
        ("<robot", {"URDF": ("error", "URDF failed XML parse")}),
        ('<robot name="r"/>', {"URDF": ("error", "URDF failed Model parse")}),
    ],
)
async def test_invalid_description_keeps_last_robot(text, rows):
    async with open_world(make_config()) as world:
        world.describe(ARM)
        await world.settle()
        world.describe(text)
        await world.settle()
        status = world.status("RobotModel")
        assert rows.items() <= status.items()
        assert "base" in status
        assert len((await open_client(world))["robot_scene"]["links"]) == 3
        world.describe(ARM)
        await world.settle()
        assert world.status("RobotModel")["URDF"] == ("ok", "URDF parsed OK")


async def test_tf_prefix_is_prepended_to_frames():
    async with open_world(make_config(", TF Prefix: one")) as world:
        world.describe(ARM)
        await world.settle()
        assert world.status("RobotModel")["tip"][1] == "No transform from [one/tip] to [base]"
        async with open_page(world.viewer) as client:
            await client.opened()
            await client.set("display-1/TF Prefix", "")
            scene = await client.until("robot_scene")
            assert [link["frame"] for link in scene["links"]] == ["base", "tip", "mark"]


@pytest.mark.parametrize(
    "topic", ["Value: /robot_description, Durability Policy: Volatile", "Value: robot_description"]
)
async def test_latched_description_is_received_with_any_topic_settings(topic):
    world = World(make_config(f", Description Topic: {{{topic}}}"))
    world.describe(ARM)
    await world.settle()
    await world.viewer.start()
    await world.settle()
    assert "base" in world.status("RobotModel")
    await world.viewer.close()
    await world.graph.close()


async def test_changed_description_topic_is_subscribed():
    async with open_world(make_config()) as world, open_page(world.viewer) as client:
        await client.opened()
        await client.set("display-1/Description Topic", "/other")
        await client.until("property_changed", id="display-1/Description Topic")
        assert world.graph.count_subscribers("/robot_description") == 0
        assert world.graph.count_subscribers("/other") == 1
        for topic, text in (("", "Empty topic name"), ("a b", "'a b' is not a valid topic name")):
            await client.set("display-1/Description Topic", topic)
            await client.until("property_changed", id="display-1/Description Topic")
            level, status = world.status("RobotModel")["Topic"]
            assert (level, text in status) == ("error", True)
            assert status.startswith("Error subscribing: ")


async def test_description_may_come_from_xacro_file(tmp_path):
    path = write_file(
        tmp_path / "r.xacro",
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n  <link name="${\'ba\' + \'se\'}"/>\n</robot>\n',
    )
    async with (
        open_world(make_config(f", Description Source: File, Description File: {path}")) as world,
        open_page(world.viewer) as client,
    ):
        scene = await client.until("robot_scene", revision=1)
        (link,) = scene["links"]
        assert (link["name"], link["place"]["file"], link["place"]["line"]) == ("base", str(path), 2)
        await client.set("display-1/Description File", str(tmp_path / "gone.urdf"))
        await client.until("display_status", level="error")
        rows = world.status("RobotModel")
        assert rows["URDF"][0] == "error"
        assert any("gone.urdf" in text for _, text in rows.values())
        await client.set("display-1/Description File", "")
        await client.until("property_changed", id="display-1/Description File")
        assert world.status("RobotModel")["Description File"] == ("error", "No Description File is set")
        await client.set("display-1/Description Source", "Topic")
        rows = {row["name"] for row in (await client.until("display_properties"))["properties"]}
        assert "Description Topic" in rows
        assert "Description File" not in rows


async def test_missing_mesh_is_reported_in_status_and_once_in_log(tmp_path: Path):
    share = write_package(tmp_path / "robot", "robot")
    async with open_world(make_config(), packages={"robot": share}) as world:
        world.describe(ARM_WITH_MESH)
        await world.settle()
        world.describe(ARM_WITH_MESH + "<!-- saved again -->")
        await world.settle()
        level, text = world.status("RobotModel")["base"]
        assert level == "error"
        assert "'package://robot/meshes/arm.stl'" in text
        assert str(share / "meshes" / "arm.stl") in text
        assert world.logged().count(str(share / "meshes" / "arm.stl")) == 1
        write_file(share / "meshes" / "arm.stl")
        world.describe(ARM_WITH_MESH)
        await world.settle()
        assert world.status("RobotModel")["base"] == ("ok", "Transform OK")


async def test_mesh_errors_of_pages_are_shown_in_status(tmp_path):
    share = write_package(tmp_path / "robot", "robot")
    write_file(share / "meshes" / "arm.stl")
    async with open_world(make_config(), packages={"robot": share}) as world:
        world.describe(ARM_WITH_MESH)
        await world.settle()
        async with open_page(world.viewer) as client:
            url = (await client.opened())["robot_scene"]["links"][0]["visuals"][0]["url"]

            async def report_mesh_error(error, address=url, link="base"):
                await client.send("mesh_status", display="display-1", link=link, url=address, error=error)

            await report_mesh_error("not an STL file")
            status = await client.until("display_status")
            row = next(row for row in status["status"] if row["name"] == "base")
            assert row == {"name": "base", "level": "error", "text": "Could not load mesh 'arm.stl': not an STL file"}
            await report_mesh_error("not an STL file")
            await report_mesh_error("stale", address="/mesh/other")
            await report_mesh_error("stale", link="tip")
            await report_mesh_error(None)
            status = await client.until("display_status")
            assert next(row for row in status["status"] if row["name"] == "base")["level"] == "ok"
            assert world.logged().count("not an STL file") == 1
            assert "stale" not in world.logged()


def publish_description(world: World, node: str, text: str):
    """Return a node that publishes a description."""
    publisher = world.graph.create_node(node)
    publisher.create_publisher(String, "robot_description", DESCRIPTION_QOS).publish(String(data=text))
    return publisher


async def test_status_names_publisher_of_shown_description():
    other = ARM.replace('name="arm"', 'name="other"')
    async with open_world(make_config()) as world:
        first = publish_description(world, "first", ARM)
        await world.settle()
        assert world.status("RobotModel")["Topic"] == ("ok", "OK")
        second = publish_description(world, "second", ARM)
        await world.settle()
        level, text = world.status("RobotModel")["Topic"]
        assert (level, "of /second is shown; /first" in text) == ("ok", True)
        assert "replaces that of" not in world.logged()
        publish_description(world, "third", other)
        await world.settle()
        level, text = world.status("RobotModel")["Topic"]
        assert (level, "of /third is shown; /first, /second also publish" in text) == ("warn", True)
        assert "The description of /third replaces that of /second" in world.logged()
        for node in (first, second):
            node.destroy_node()


async def test_description_publisher_change_is_reported_after_gid_change():
    """After the change, publishers have other GIDs than their first messages had."""
    async with open_world(make_config()) as world:
        first = world.graph.create_node("first")
        publisher = first.create_publisher(String, "robot_description", DESCRIPTION_QOS)
        publisher.publish(String(data=ARM))
        await world.settle()
        publisher.gid = bytes(range(16))
        second = publish_description(world, "second", ARM.replace('name="arm"', 'name="other"'))
        await world.settle()
        level, text = world.status("RobotModel")["Topic"]
        assert (level, "of /second is shown; /first also publish" in text) == ("warn", True)
        publisher.publish(String(data=ARM))
        await world.settle()
        assert "of /first is shown; /second also publish" in world.status("RobotModel")["Topic"][1]
        second.destroy_node()


async def test_description_from_vanished_node_is_reported():
    async with open_world(make_config()) as world:
        publish_description(world, "first", ARM)
        await world.settle()
        second = publish_description(world, "second", ARM.replace('name="arm"', 'name="other"'))
        second.destroy_node()
        await world.settle()
        assert world.display("RobotModel").robot.name == "other"
        level, text = world.status("RobotModel")["Topic"]
        assert (level, "of an unknown node is shown; /first also publish" in text) == ("warn", True)


async def test_description_from_restarted_node_replaces_without_warning():
    async with open_world(make_config()) as world:
        first = publish_description(world, "first", ARM)
        await world.settle()
        first.destroy_node()
        publish_description(world, "first", ARM.replace('name="arm"', 'name="other"'))
        await world.settle()
        assert world.display("RobotModel").robot.name == "other"
        assert "replaces that of" not in world.logged()
