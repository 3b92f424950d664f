"""Displays of messages, tested with PointStamped."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

from linkwright.geometry.arrays import rotation_matrix
from linkwright.graph import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from linkwright.graph.endpoints.base import Endpoint, EndpointKind
from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from tests.skipping import skipping
from tests.viewer.contents import unpack_contents
from tests.viewer.scene import open_world
from tests.waiting import eventually

PointStamped = get_message("geometry_msgs/msg/PointStamped")

FILE = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/PointStamped
      Enabled: true
      Name: Clicks
      Topic:
        Value: /clicked_point
  Global Options:
    Fixed Frame: base
"""


def make_config(extra: str = "") -> RvizConfig:
    return RvizConfig.parse(FILE.replace("      Topic:\n", extra + "      Topic:\n"))


def make_point(x: float, frame: str = "base", stamp: int = 0) -> PointStamped:
    message = PointStamped()
    message.header.frame_id = frame
    message.header.stamp.sec = stamp
    message.point.x = x
    return message


def make_point_at(stamp_ns: int, frame: str) -> PointStamped:
    message = make_point(1.0, frame, stamp_ns // 1_000_000_000)
    message.header.stamp.nanosec = stamp_ns % 1_000_000_000
    return message


def sent_points(world) -> list[list[float]]:
    """Return the points of the frames for a page, in the fixed frame, oldest first."""
    shown = sorted(unpack_contents(world.display("PointStamped")), key=lambda content: content.key)
    assert all(content.fields["kind"] == "point_marks" for content in shown)
    return [
        (content.fields["positions"] @ rotation_matrix(content.pose[3:]).T + content.pose[:3]).tolist()
        for content in shown
    ]


async def test_point_is_drawn_at_its_pose_in_fixed_frame():
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        assert world.status("PointStamped") == {"Topic": ("warn", "No messages received: the topic has no publisher")}
        world.move({("base", "tip"): (1, 2, 3, 0, 0, 2**-0.5, 2**-0.5)}, static=True)
        publisher.publish(make_point(1.0, "tip"))
        await world.settle()
        np.testing.assert_allclose(sent_points(world), [[1, 3, 3]], atol=1e-6)
        assert world.status("PointStamped") == {
            "Topic": ("ok", "1 messages received"),
            "Transform": ("ok", "Transform OK"),
        }


async def test_message_waits_for_its_transform():
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        publisher.publish(make_point(1.0, "tip"))
        await world.settle()
        assert world.display("PointStamped").data() == []
        level, text = world.status("PointStamped")["Transform"]
        assert (level, text.split(":")[0]) == ("error", "Could not transform from [tip] to [base]")
        world.move({("base", "tip"): (1, 0, 0, 0, 0, 0, 1)}, static=True)
        await world.settle()
        assert sent_points(world) == [[2, 0, 0]]
        assert world.status("PointStamped")["Transform"] == ("ok", "Transform OK")


@skipping
async def test_slightly_late_transforms_are_not_an_error():
    """Drivers publish their data before tf has the pose of that time; this is normal."""
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        world.move({("base", "tip"): (0, 0, 0, 0, 0, 0, 1)})
        for _ in range(30):
            publisher.publish(make_point_at(world.graph.timebase.now_ns() + 50_000_000, "tip"))
            await world.settle()
            assert world.status("PointStamped").get("Transform") in (None, ("ok", "Transform OK"))
            await asyncio.sleep(0.1)
            assert world.status("PointStamped").get("Transform") in (None, ("ok", "Transform OK"))
            world.move({("base", "tip"): (1, 0, 0, 0, 0, 0, 1)})
            await world.settle()
            assert world.status("PointStamped")["Transform"] == ("ok", "Transform OK")
        assert len(sent_points(world)) == 1


@skipping
async def test_missing_transforms_are_an_error():
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        world.move({("base", "tip"): (0, 0, 0, 0, 0, 0, 1)})
        publisher.publish(make_point_at(world.graph.timebase.now_ns() + 50_000_000, "tip"))
        await world.settle()
        assert "Transform" not in world.status("PointStamped")
        await asyncio.sleep(2.0)
        level, text = world.status("PointStamped")["Transform"]
        assert level == "error"
        assert "extrapolation" in text
        world.move({("base", "tip"): (1, 0, 0, 0, 0, 0, 1)})
        await world.settle()
        assert world.status("PointStamped")["Transform"] == ("ok", "Transform OK")
        await asyncio.sleep(2.0)
        assert world.status("PointStamped")["Transform"] == ("ok", "Transform OK")


async def test_fixed_frame_change_transforms_last_message_again():
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        world.move({("base", "tip"): (1, 0, 0, 0, 0, 0, 1)}, static=True)
        publisher.publish(make_point(1.0))
        await world.settle()
        assert sent_points(world) == [[1, 0, 0]]
        world.viewer.manager.set_fixed_frame("tip")
        await world.settle()
        assert sent_points(world) == [[0, 0, 0]]


@pytest.mark.parametrize(("length", "expected"), [(1, [[3, 0, 0]]), (3, [[1, 0, 0], [2, 0, 0], [3, 0, 0]])])
async def test_history_length_limits_number_of_points(length, expected):
    async with open_world(make_config(f"      History Length: {length}\n")) as world:
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        for x in (1.0, 2.0, 3.0):
            publisher.publish(make_point(x))
        await world.settle()
        assert sent_points(world) == expected


async def test_nan_point_is_reported():
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        publisher.publish(make_point(float("nan")))
        await world.settle()
        assert world.status("PointStamped")["Message"][0] == "error"
        assert world.display("PointStamped").data() == []


async def test_disabled_display_unsubscribes_from_topic():
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        display = world.display("PointStamped")
        assert publisher.get_subscription_count() == 1
        world.viewer.manager.tree.check(display, False)
        assert publisher.get_subscription_count() == 0
        assert display.data() == []
        world.viewer.manager.tree.check(display, True)
        assert publisher.get_subscription_count() == 1


async def test_incompatible_qos_is_reported():
    async with open_world(make_config()) as world:
        best_effort = QoSProfile(5, reliability=ReliabilityPolicy.BEST_EFFORT)
        world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", best_effort)
        await world.settle()
        level, text = world.status("PointStamped")["Topic"]
        assert level == "warn"
        assert "RELIABILITY" in text


async def test_qos_is_read_from_file():
    text = FILE + "\n"
    text = text.replace(
        "        Value: /clicked_point\n", "        Durability Policy: Transient Local\n        Value: /p\n"
    )
    async with open_world(RvizConfig.parse(text)) as world:
        transient_local = QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/p", transient_local)
        publisher.publish(make_point(4.0))
        await world.settle()
        assert sent_points(world) == [[4, 0, 0]]


async def test_failing_message_is_reported_and_next_one_is_shown(monkeypatch):
    def fail(self, message, pose):
        if message.point.x < 0:
            raise ZeroDivisionError("no such point")
        self.send_marks(message, pose)

    async with open_world(make_config()) as world:
        display = world.display("PointStamped")
        kind = type(display)
        monkeypatch.setattr(kind, "send_marks", kind.process_message, raising=False)
        monkeypatch.setattr(kind, "process_message", fail)
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        for x in (-1.0, -2.0):
            publisher.publish(make_point(x, "tip"))
        publisher.publish(make_point(-3.0))
        world.move({("base", "tip"): (1, 2, 3, 0, 0, 0, 1)}, static=True)
        await world.settle()
        assert world.status("PointStamped")["Failure"] == ("error", "The message could not be shown: no such point")
        assert world.logged().count("'Clicks' failed") == 1
        publisher.publish(make_point(3.0))
        await world.settle()
        assert "Failure" not in world.status("PointStamped")
        assert sent_points(world) == [[3.0, 0.0, 0.0]]


async def test_final_message_count_is_shown(monkeypatch):
    monkeypatch.setattr("linkwright.rviz.displays.base.topic_display._COUNT_PERIOD_S", 0.05)
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 10)
        for x in range(4):
            publisher.publish(make_point(float(x)))

        def status() -> tuple[str, str]:
            level, text = world.status("PointStamped")["Topic"]
            return level, text.split(" at ")[0]

        await eventually(lambda: status() == ("ok", "4 messages received"))


async def test_silent_topic_status_names_publishers_and_alternatives(monkeypatch):
    monkeypatch.setattr("linkwright.rviz.displays.base.topic_display._COUNT_PERIOD_S", 0.05)
    async with open_world(make_config()) as world:

        def status() -> str:
            return world.status("PointStamped")["Topic"][1].removeprefix("No messages received: ")

        assert status() == "the topic has no publisher"
        node = world.graph.create_node("clicks")
        node.create_publisher(PointStamped, "/other", 5)
        expected_status = "the topic has no publisher, but geometry_msgs/msg/PointStamped is published on /other"
        await eventually(lambda: status() == expected_status, what=status)
        for name in ("/a", "/b", "/clicked_points", "/c"):
            node.create_publisher(PointStamped, name, 5)
        await eventually(
            lambda: status().startswith(expected_status.replace("/other", "/clicked_points, ")), what=status
        )
        node.create_publisher(PointStamped, "/clicked_point", 5)
        await eventually(lambda: status() == "no message arrived yet from clicks", what=status)


async def test_topic_type_mismatch_is_reported(monkeypatch):
    monkeypatch.setattr("linkwright.rviz.displays.base.topic_display._COUNT_PERIOD_S", 0.05)
    async with open_world(RvizConfig.parse(FILE.replace("/clicked_point", "/words"))) as world:
        world.graph.create_node("speaker").create_publisher(get_message("std_msgs/msg/String"), "/words", 1)
        message = (
            "warn",
            "No messages received: the topic carries std_msgs/msg/String, not geometry_msgs/msg/PointStamped",
        )
        await eventually(lambda: world.status("PointStamped")["Topic"] == message)


@skipping
async def test_stamps_of_another_clock_are_reported():
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        world.move({("base", "tip"): (0, 0, 0, 0, 0, 0, 1)})
        publisher.publish(make_point_at(world.graph.timebase.now_ns() + 60_000_000_000, "tip"))
        await world.settle()
        await asyncio.sleep(2)
        level, text = world.status("PointStamped")["Transform"]
        assert level == "error"
        assert text.startswith("The message's stamp is 60 s after the local time: check the clocks of both computers")


@pytest.mark.parametrize(
    ("policy", "remedy"),
    [
        (QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT), "Choose Best Effort for Reliability Policy"),
        (QoSProfile(depth=5, durability=DurabilityPolicy.VOLATILE), "Choose Volatile for Durability Policy"),
    ],
)
async def test_qos_mismatch_status_names_property_to_change(policy, remedy):
    expected_changes = {"Reliability Policy": "Reliable", "Durability Policy": "Transient Local"}
    async with open_world(make_config()) as world:
        display = world.display("PointStamped")
        for row, value in expected_changes.items():
            if row.split()[0] in remedy:
                display.set_property(("Topic", row), value)
        world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", policy)
        await world.settle()
        level, text = world.status("PointStamped")["Topic"]
        assert (level, f"{remedy} below Topic" in text) == ("warn", True), text


async def test_waiting_displays_query_only_publisher_endpoints(monkeypatch):
    described: list[str] = []
    info = Endpoint.info
    monkeypatch.setattr(Endpoint, "info", lambda self: (described.append(self.kind), info(self))[1])
    entry = FILE[FILE.index("    - Class") : FILE.index("  Global")]
    many = "".join(entry.replace("/clicked_point", f"/point{i}") for i in range(40))
    async with open_world(RvizConfig.parse(FILE.replace(entry, many))) as world:
        other = world.graph.create_node("other").create_publisher(PointStamped, "/point7x", 10)
        shown = [display for display in world.viewer.displays if display.CLASS.endswith("PointStamped")]
        assert len(shown) == 40
        await eventually(lambda: "/point7x" in shown[7].status[0].text)
        assert described.count(EndpointKind.SUBSCRIPTION) == 0
        before = len(described)
        for display in shown:
            display._report_count()  # as each display does every second
        assert len(described) == before
        other.destroy()
        await eventually(lambda: "there is" not in shown[7].status[0].text)


async def test_path_display_has_no_warning_once_planner_publishes():
    path = RvizConfig.parse(FILE.replace("PointStamped", "Path").replace("/clicked_point", "/plan"))
    async with open_world(path) as world:
        assert world.status("Path")["Topic"][0] == "warn", "the topic has no publisher"
        world.graph.create_node("planner").create_publisher("nav_msgs/msg/Path", "/plan", 5)
        awaited = ("ok", "No messages received: no message arrived yet from planner")
        await eventually(lambda: world.status("Path")["Topic"] == awaited)
