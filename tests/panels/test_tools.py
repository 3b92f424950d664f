"""The tools of RViz: their properties, and what they publish."""

from __future__ import annotations

import math

import pytest
import yaml

from linkwright.graph import ActionServer
from linkwright.messages import get_action
from linkwright.rviz import RvizConfig
from linkwright.rviz.config.tools import DEFAULT_TOOLS, TOOL_KINDS, get_tool_name
from tests.viewer.scene import open_page, open_world, rows_by_id
from tests.waiting import eventually

FILE = """\
Visualization Manager:
  Tools:
    - Class: rviz_default_plugins/MoveCamera
    - Class: rviz/SetGoal
      Topic: /move_base_simple/goal
    - Class: other_plugins/GoalTool
      Secret: kept
    - Class: rviz_default_plugins/SetInitialPose
      Covariance x: 0.04
      Covariance y: 0.09
      Covariance yaw: 0.01
      Topic:
        Depth: 5
        Durability Policy: Volatile
        History Policy: Keep Last
        Reliability Policy: Reliable
        Value: /first
"""


def tools_of(config: RvizConfig) -> list[dict]:
    return yaml.safe_load(config.text())["Visualization Manager"]["Tools"]


def test_tool_names_match_rviz():
    assert [kind.name for kind in TOOL_KINDS.values()] == [
        "Interact",
        "Move Camera",
        "Select",
        "Focus Camera",
        "Measure",
        "2D Pose Estimate",
        "2D Goal Pose",
        "Publish Point",
        "Nav2 Goal",
    ]
    assert get_tool_name("other_plugins/GoalTool") == "Goal Tool"


def test_tools_of_file_keep_order_classes_and_unknown_entries():
    config = RvizConfig.parse(FILE)
    assert [entry.cls.rpartition("/")[2] for entry in config.tools.entries] == [
        "MoveCamera",
        "SetGoal",
        "GoalTool",
        "SetInitialPose",
    ]
    goal, pose = config.tools.entries[1], config.tools.entries[3]
    assert goal.properties.text("Topic") == "/move_base_simple/goal"
    assert pose.properties.number("Covariance y") == 0.09
    pose.properties.set(("Topic",), "/second")
    assert config.text() == FILE.replace("/first", "/second")


def test_file_without_tools_uses_defaults():
    config = RvizConfig.parse("Visualization Manager: {}\n")
    assert [entry.cls for entry in config.tools.entries] == list(DEFAULT_TOOLS)
    assert "Tools" not in config.text()
    config.tools.remove(config.tools.entries[0].id)
    config.tools.add("rviz_default_plugins/Measure")
    assert [tool["Class"] for tool in tools_of(config)] == [*list(DEFAULT_TOOLS)[1:], "rviz_default_plugins/Measure"]
    with pytest.raises(ValueError, match="no tool"):
        config.tools.add("no/Such")
    while len(config.tools.entries) < 100:
        config.tools.add("rviz_default_plugins/Measure")
    with pytest.raises(ValueError, match="already"):
        config.tools.add("rviz_default_plugins/Measure")


@pytest.fixture
def config() -> RvizConfig:
    config = RvizConfig.parse(FILE.replace("rviz_default_plugins/MoveCamera", "rviz_default_plugins/PublishPoint"))
    config.options.set(("Fixed Frame",), "odom")
    return config


def listen(world, kind: str, topic: str) -> list:
    messages: list = []
    node = world.graph.create_node("listener")
    node.create_subscription(kind, topic, messages.append, 10)
    return messages


async def test_tools_publish_poses_and_points_in_fixed_frame(config):
    async with open_world(config) as world, open_page(world.viewer) as client:
        point, goal, unknown, pose = (await client.opened())["tools"]["tools"]
        assert [tool["supported"] for tool in (point, goal, unknown, pose)] == [True, True, False, True]
        poses = listen(world, "geometry_msgs/msg/PoseWithCovarianceStamped", "/first")
        goals = listen(world, "geometry_msgs/msg/PoseStamped", "/move_base_simple/goal")
        points = listen(world, "geometry_msgs/msg/PointStamped", "/clicked_point")
        await client.send("pose_chosen", tool=pose["id"], x=1.0, y=-2.0, yaw=math.pi / 2)
        await client.send("pose_chosen", tool=goal["id"], x=3.0, y=4.0, yaw=0.0)
        await client.send("point_chosen", tool=point["id"], x=0.5, y=0.25, z=-1.0)
        await client.send("point_chosen", tool=goal["id"], x=0.0, y=0.0, z=0.0)
        await client.send("pose_chosen", tool=unknown["id"], x=1.0, y=-2.0, yaw=0.0)
        await eventually(lambda: poses and goals and points)
        await world.settle()
    (estimate,), (target,), (clicked,) = poses, goals, points
    assert estimate.header.frame_id == target.header.frame_id == clicked.header.frame_id == "odom"
    assert estimate.header.stamp.sec > 0
    assert (estimate.pose.pose.position.x, estimate.pose.pose.position.y) == (1.0, -2.0)
    assert estimate.pose.pose.orientation.z == pytest.approx(math.sqrt(0.5))
    covariance = list(estimate.pose.covariance)
    assert (covariance[0], covariance[7], covariance[35]) == (0.04, 0.09, 0.01)
    assert sum(map(bool, covariance)) == 3
    assert (target.pose.position.x, target.pose.position.y, target.pose.orientation.w) == (3.0, 4.0, 1.0)
    assert (clicked.point.x, clicked.point.y, clicked.point.z) == (0.5, 0.25, -1.0)
    assert "Setting estimate pose: Frame:odom, Position(1, -2, 0)" in world.logged()


async def test_tool_topic_can_be_changed_and_invalid_topic_is_rejected(config):
    async with open_world(config) as world, open_page(world.viewer) as first, open_page(world.viewer) as second:
        goal = (await first.opened())["tools"]["tools"][1]
        await second.opened()
        topic = f"{goal['id']}/Topic"
        assert rows_by_id(goal["properties"])[topic]["value"] == "/move_base_simple/goal"
        await first.send("set_tool_property", id=topic, value="/elsewhere")
        assert (await second.until("tool_property_changed"))["value"] == "/elsewhere"
        await first.send("set_tool_property", id=topic, value="not a name!")
        assert (await first.until("tool_property_changed", value="/elsewhere"))["id"] == topic
        poses = listen(world, "geometry_msgs/msg/PoseStamped", "/elsewhere")
        await first.send("pose_chosen", tool=goal["id"], x=3.0, y=4.0, yaw=0.0)
        await eventually(lambda: poses)
        await world.settle()
    assert len(poses) == 1
    assert tools_of(config)[1]["Topic"] == "/elsewhere"


async def test_tools_are_added_and_removed_on_all_pages(config):
    async with open_world(config) as world, open_page(world.viewer) as first, open_page(world.viewer) as second:
        tools = (await first.opened())["tools"]["tools"]
        await second.opened()
        await first.send("add_tool", cls="rviz_default_plugins/Measure")
        added = (await second.until("tools"))["tools"]
        assert [tool["name"] for tool in added] == [*(tool["name"] for tool in tools), "Measure"]
        await second.send("remove_tool", id=tools[0]["id"])
        await first.until("tools")
        assert [tool["id"] for tool in (await first.until("tools"))["tools"]] == [tool["id"] for tool in added[1:]]
    assert [tool["Class"].rpartition("/")[2] for tool in tools_of(config)] == [
        "SetGoal",
        "GoalTool",
        "SetInitialPose",
        "Measure",
    ]


NAV2 = """\
Visualization Manager:
  Global Options: {Fixed Frame: base}
  Tools:
    - Class: nav2_rviz_plugins/GoalTool
"""


async def test_nav2_goal_uses_action_and_logs_missing_server():
    config = RvizConfig.parse(NAV2)
    async with open_world(config) as world, open_page(world.viewer) as opened:
        (tool,) = (await opened.opened())["tools"]["tools"]
        assert (tool["name"], tool["supported"], tool["properties"]) == ("Nav2 Goal", True, [])
        await opened.send("pose_chosen", tool=tool["id"], x=1.0, y=2.0, yaw=0.0)
        await eventually(lambda: "navigate_to_pose action server is not available" in world.logged())
        goals = []

        def drive(handle):
            goals.append(handle.request)
            handle.succeed()
            return get_action("nav2_msgs/action/NavigateToPose").Result()

        navigator = world.graph.create_node("bt_navigator")
        ActionServer(navigator, "nav2_msgs/action/NavigateToPose", "navigate_to_pose", drive)
        await world.settle()
        await opened.send("pose_chosen", tool=tool["id"], x=3.0, y=4.0, yaw=math.pi)
        await eventually(lambda: goals)
    (goal,) = goals
    assert (goal.pose.header.frame_id, goal.behavior_tree) == ("base", "")
    assert (goal.pose.pose.position.x, goal.pose.pose.position.y) == (3.0, 4.0)
    assert goal.pose.pose.orientation.z == pytest.approx(1.0)
