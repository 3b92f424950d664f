"""Pages add, arrange, remove and change displays."""

from __future__ import annotations

import pytest

from linkwright.graph import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from linkwright.rviz.visualization import display_tree
from tests.viewer.configured import (
    TEXT,
    PointStamped,
    display_entries,
    display_names,
    open_configured,
    perform_edit,
    undo_edit,
)
from tests.viewer.scene import ARM, open_page, open_world

String = get_message("std_msgs/msg/String")


async def test_groups_contain_display_rows():
    async with open_configured() as (_, client):
        displays = client.first["tree"]["displays"]
        assert [(display["name"], display["group"]) for display in displays] == [
            ("Grid", None),
            ("Marks", None),
            ("Clicks", "display-2"),
            ("Radar", None),
        ]
        assert [display["supported"] for display in displays] == [True, True, True, False]


async def test_disabled_group_disables_its_displays():
    async with open_configured() as (world, client):
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        assert publisher.get_subscription_count() == 1
        await client.set("display-2/Enabled", False)
        await client.until("configuration", unsaved=True)
        assert publisher.get_subscription_count() == 0
        assert world.display("PointStamped").config.checked
        assert "Enabled: false" in world.viewer.config.text()
        state = await undo_edit(client)
        assert publisher.get_subscription_count() == 1
        assert (state["unsaved"], state["undo"], state["redo"]) == (False, None, {"kind": "disable", "name": "Marks"})
        assert world.viewer.config.text() == TEXT


@pytest.mark.parametrize(
    "checkbox_yaml", ["", "Enabled: true", "Value: true", "Enabled: true, Value: false", "Enabled: no"]
)
async def test_undo_of_checkbox_restores_file(checkbox_yaml):
    text = f"Visualization Manager:\n  Displays:\n    - {{Class: rviz_default_plugins/Axes, {checkbox_yaml}}}\n"
    async with open_world(RvizConfig.parse(text)) as world:
        manager = world.viewer.manager
        (display,) = manager.displays
        was_checked = display.config.checked
        manager.tree.check(display, not was_checked)
        changed = manager.config.text()
        assert display.config.checked is not was_checked
        for _ in range(2):
            manager.history.undo()
            assert (manager.config.text(), display.config.checked) == (text, was_checked)
            manager.history.redo()
            assert (manager.config.text(), display.config.checked) == (changed, not was_checked)


FRAMES = """Visualization Manager:
  Displays:
    - Class: rviz_common/Group
      Enabled: true
      Displays:
        - {Class: rviz_default_plugins/TF, Enabled: true, Frame Timeout: 5}
    - {Class: rviz_default_plugins/TF, Enabled: true, Frame Timeout: 8}
"""


async def test_fade_time_is_shortest_of_tf_displays():
    async with open_world(RvizConfig.parse(FRAMES)) as world:
        manager = world.viewer.manager
        stream, tree = manager._stream, manager.tree
        group, grouped, ungrouped = manager.displays
        assert stream.fade_time == 5
        tree.check(group, False)
        assert stream.fade_time == 8
        ungrouped.set_property(("Frame Timeout",), 3.0)
        assert stream.fade_time == 3
        tree.remove([ungrouped])
        assert stream.fade_time is None
        manager.history.undo()
        assert stream.fade_time == 3
        tree.check(group, True)
        grouped.set_property(("Frame Timeout",), 2.0)
        assert stream.fade_time == 2
        manager.open(RvizConfig.parse("Visualization Manager: {}"))
        assert stream.fade_time is None


# --- adding and choosing displays ----------------------------------------------------------------------------------


async def test_display_choices_are_sent():
    async with open_configured() as (_, client):
        await client.send("request_display_choices")
        message = (await client.until("display_choices"))["classes"]
        classes = {choice["cls"]: choice["messages"] for choice in message}
        assert classes["rviz_default_plugins/PointStamped"] == ["geometry_msgs/msg/PointStamped"]
        assert classes["rviz_default_plugins/Grid"] == []
        assert list(classes)[-1] == "rviz_common/Group"


async def test_display_is_added_and_undone():
    async with open_configured() as (world, client):
        await client.send("add_display", cls="rviz_default_plugins/Axes", name="Axes", group="display-2", topic=None)
        tree = await client.until("tree")
        assert [(display["name"], display["group"], display["id"]) for display in tree["displays"]][3] == (
            "Axes",
            "display-2",
            "display-5",
        )
        assert display_entries(world)[1]["Displays"][1] == {
            "Class": "rviz_default_plugins/Axes",
            "Enabled": True,
            "Name": "Axes",
            "Value": True,
        }
        state = await undo_edit(client)
        assert (state["undo"], state["redo"]["name"], state["unsaved"]) == (None, "Axes", False)
        assert world.viewer.config.text() == TEXT
        await undo_edit(client, "redo")
        assert [display.id for display in world.viewer.displays] == [
            "display-1",
            "display-2",
            "display-3",
            "display-5",
            "display-4",
        ]


async def test_display_for_topic_uses_qos_of_publishers():
    async with open_configured() as (world, client):
        qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        publisher = world.graph.create_node("sensor").create_publisher(PointStamped, "/found", qos)
        await client.send("request_display_choices")
        topics = (await client.until("display_choices"))["topics"]
        cls = "rviz_default_plugins/PointStamped"
        assert {"topic": "/found", "message": "geometry_msgs/msg/PointStamped", "classes": [cls]} in topics
        await perform_edit(client, "add_display", cls=cls, name="Found", group=None, topic="/found")
        assert publisher.get_subscription_count() == 1
        assert display_entries(world)[-1]["Topic"] == {"Reliability Policy": "Best Effort", "Value": "/found"}


async def test_robot_model_is_added_by_description_topic():
    async with open_configured() as (world, client):
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node = world.graph.create_node("robot_state_publisher")
        publisher = node.create_publisher(String, "/other/robot_description", qos)
        publisher.publish(String(data='<robot name="other"><link name="base"/></robot>'))
        await client.send("request_display_choices")
        topics = (await client.until("display_choices"))["topics"]
        topic_entry = next(topic for topic in topics if topic["topic"] == "/other/robot_description")
        cls = "rviz_default_plugins/RobotModel"
        assert cls in topic_entry["classes"]
        await perform_edit(client, "add_display", cls=cls, name="Other", group=None, topic="/other/robot_description")
        assert display_entries(world)[-1]["Description Topic"]["Value"] == "/other/robot_description"
        assert publisher.get_subscription_count() == 1


async def test_removed_displays_unsubscribe_and_undo_restores_them():
    async with open_configured() as (world, client):
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        await client.set("display-3/Alpha", 0.25)
        await client.until("property_changed", id="display-3/Alpha")
        text = world.viewer.config.text()
        await perform_edit(client, "remove_displays", displays=["display-2", "display-3"])
        assert display_names(world) == ["Grid", "Radar"]
        assert publisher.get_subscription_count() == 0
        await undo_edit(client)
        assert display_names(world) == ["Grid", "Marks", "Clicks", "Radar"]
        assert publisher.get_subscription_count() == 1
        assert world.viewer.config.text() == text
        await undo_edit(client)  # undo the earlier edit of the display, which is a new object since it was restored
        assert world.viewer.displays[2].properties.number("Alpha") == 0.5
        assert world.viewer.config.text() == TEXT


async def test_removed_robot_model_is_restored_by_undo():
    async with open_world(RvizConfig.for_model("base")) as world, open_page(world.viewer) as client:
        await client.opened()
        world.describe(ARM)
        await client.until("robot_scene", revision=1)
        await client.send("remove_displays", displays=["display-2"])
        await client.until("tree")
        await client.send("undo")
        await client.until("robot_scene")
        await world.settle()
        assert len(world.display("RobotModel").scene.links) == 3


async def test_displays_are_duplicated_with_contents():
    async with open_configured() as (world, client):
        await client.send("duplicate_displays", displays=["display-2", "display-3", "display-4"])
        tree = await client.until("tree")
        assert [(display["name"], display["group"]) for display in tree["displays"]] == [
            ("Grid", None),
            ("Marks", None),
            ("Clicks", "display-2"),
            ("Marks", None),
            ("Clicks", tree["displays"][3]["id"]),
            ("Radar", None),
            ("Radar", None),
        ]
        assert display_entries(world)[1] == display_entries(world)[2]
        assert display_entries(world)[3] == display_entries(world)[4]
        await undo_edit(client)
        assert world.viewer.config.text() == TEXT


async def test_displays_are_renamed():
    async with open_configured() as (world, client):
        await client.send("rename_display", display="display-4", name="  Far   radar ")
        assert (await client.until("tree"))["displays"][3]["name"] == "Far radar"
        assert (await client.until("configuration"))["undo"] == {"kind": "rename", "name": "Far radar"}
        await undo_edit(client)
        assert world.viewer.config.text() == TEXT
        await client.send("rename_display", display="display-4", name=" ")
        assert (await client.until("configuration_refused"))["question"] is None


@pytest.mark.parametrize(
    ("displays", "group", "before", "expected"),
    [
        (["display-4"], None, "display-1", [("Radar", None), ("Grid", None), ("Marks", None), ("Clicks", "Marks")]),
        (["display-3"], None, None, [("Grid", None), ("Marks", None), ("Radar", None), ("Clicks", None)]),
        (
            ["display-1", "display-4"],
            "display-2",
            "display-3",
            [("Marks", None), ("Grid", "Marks"), ("Radar", "Marks"), ("Clicks", "Marks")],
        ),
        (
            ["display-1", "display-2"],
            None,
            "display-2",
            [("Grid", None), ("Marks", None), ("Clicks", "Marks"), ("Radar", None)],
        ),
    ],
)
async def test_displays_are_moved(displays, group, before, expected):
    async with open_configured() as (world, client):
        await client.send("move_displays", displays=displays, group=group, before=before)
        await client.until("tree")

        def group_name(display) -> str | None:
            return display.config.group.name if display.config.group else None

        assert [(display.config.name, group_name(display)) for display in world.viewer.displays] == expected
        await undo_edit(client)
        assert world.viewer.config.text() == TEXT


async def test_display_moved_out_of_disabled_group_is_enabled():
    async with open_configured(
        TEXT.replace("      Enabled: true\n      Name: Marks", "      Enabled: false\n      Name: Marks")
    ) as (
        world,
        client,
    ):
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        assert publisher.get_subscription_count() == 0
        await perform_edit(client, "move_displays", displays=["display-3"], group=None, before=None)
        assert publisher.get_subscription_count() == 1
        await undo_edit(client)
        assert publisher.get_subscription_count() == 0


async def test_invalid_group_moves_are_refused():
    async with open_configured() as (world, client):
        for group in ("display-2", "display-1"):
            await client.send("move_displays", displays=["display-2"], group=group, before=None)
            assert "cannot be put into" in (await client.until("configuration_refused"))["message"]
        await client.send("add_display", cls="rviz_default_plugins/Axes", name="Axes", group="display-1", topic=None)
        assert "cannot be put into" in (await client.until("configuration_refused"))["message"]
        assert world.viewer.config.text() == TEXT
        assert display_names(world) == ["Grid", "Marks", "Clicks", "Radar"]


async def test_displays_are_grouped():
    async with open_configured() as (world, client):
        await client.send("group_displays", displays=["display-1", "display-3", "display-4"], name="All")
        tree = await client.until("tree")
        assert [(display["name"], display["group"]) for display in tree["displays"]] == [
            ("All", None),
            ("Grid", "display-5"),
            ("Clicks", "display-5"),
            ("Radar", "display-5"),
            ("Marks", None),
        ]
        await undo_edit(client)
        assert world.viewer.config.text() == TEXT


async def test_group_nesting_depth_is_limited():
    async with open_configured() as (world, client):
        for depth in range(display_tree.MAX_NESTING):
            await perform_edit(client, "group_displays", displays=["display-1"], name=f"Group {depth}")
        await client.send("group_displays", displays=["display-1"], name="Too deep")
        assert "nested" in (await client.until("configuration_refused"))["message"]
        innermost = next(display for display in world.viewer.displays if display.id == "display-1").config.group
        await client.send("move_displays", displays=["display-2"], group=innermost.identity, before=None)
        assert "nested" in (await client.until("configuration_refused"))["message"]
        await client.send("add_display", cls="rviz_common/Group", name="More", group=innermost.identity, topic=None)
        assert "nested" in (await client.until("configuration_refused"))["message"]
        assert len(RvizConfig.parse(world.viewer.config.text()).displays) == 3


async def test_number_of_displays_is_limited(monkeypatch):
    monkeypatch.setattr(display_tree, "MAX_DISPLAYS", 6)
    async with open_configured() as (world, client):
        await perform_edit(client, "duplicate_displays", displays=["display-2"])  # a group and its display
        for kind, fields in (
            ("duplicate_displays", {"displays": ["display-1"]}),
            ("group_displays", {"displays": ["display-1"], "name": "All"}),
            ("add_display", {"cls": "rviz_default_plugins/Grid", "name": "Grid", "group": None, "topic": None}),
        ):
            await client.send(kind, **fields)
            assert "no more than 6 displays" in (await client.until("configuration_refused"))["message"]
        assert len(world.viewer.displays) == 6


# --- undo of properties --------------------------------------------------------------------------------------------


async def test_drag_is_undone_in_one_step():
    async with open_configured() as (world, client):
        for alpha in (0.1, 0.2, 0.3):
            await client.set("display-1/Alpha", alpha)
        await client.until("property_changed", id="display-1/Alpha", value=0.3)
        assert display_entries(world)[0]["Alpha"] == 0.3
        state = await undo_edit(client)
        rows = {row["name"]: row for row in (await wait_for_rows(client, world, "display-1"))}
        assert rows["Alpha"]["value"] == 0.5
        assert world.viewer.config.text() == TEXT
        assert state["redo"] == {"kind": "set", "name": "Alpha"}
        await undo_edit(client, "redo")
        assert display_entries(world)[0]["Alpha"] == 0.3


async def wait_for_rows(client, world, identity: str) -> list[dict]:
    messages = [
        message for message in client.messages if isinstance(message, dict) and message["type"] == "display_properties"
    ]
    return next(message["properties"] for message in reversed(messages) if message["display"] == identity)


async def test_all_links_checkbox_is_undone_with_its_effects():
    config = RvizConfig.for_model("base")
    async with open_world(config) as world, open_page(world.viewer) as client:
        await client.opened()
        world.describe(ARM)
        await client.until("robot_scene", revision=1)
        await client.set("display-2/Links/tip", False)
        await client.until("configuration")
        await client.set("display-2/Links/All Links Enabled", False)
        await client.until("configuration")
        robot = world.display("RobotModel")
        assert not robot.properties.flag("Links", "base")
        await undo_edit(client)
        assert robot.properties.flag("Links", "base")
        assert not robot.properties.flag("Links", "tip")
        await undo_edit(client, "redo")
        assert not robot.properties.flag("Links", "base")


async def test_fixed_frame_change_is_undone():
    async with open_configured() as (world, client):
        await client.set("global/Fixed Frame", "odom")
        await client.until("configuration")
        assert world.viewer._node.get_parameter("fixed_frame").value == "odom"
        await undo_edit(client)
        assert world.viewer.manager.fixed_frame == "base"
        assert world.viewer._node.get_parameter("fixed_frame").value == "base"
        assert world.viewer.manager.frames.fixed_frame == "base"
