"""The Time panel: pauses, and synchronization with a topic."""

from __future__ import annotations

import asyncio
import time

import numpy as np
import yaml

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from linkwright.rviz.frames.stream import TimeControl
from tests.skipping import skipping
from tests.viewer.scene import open_page, open_world

POINT = "geometry_msgs/msg/PointStamped"
CONFIG = {
    "Visualization Manager": {
        "Displays": [
            {"Class": "rviz_default_plugins/PointStamped", "Name": "Clicks", "Enabled": True, "Topic": {"Value": "/p"}},
        ],
        "Global Options": {"Fixed Frame": "base"},
    }
}


class FakeClock:
    def __init__(self) -> None:
        self.ns = 100

    def now_ns(self) -> int:
        return self.ns


def config() -> RvizConfig:
    return RvizConfig.parse(yaml.safe_dump(CONFIG))


def x_of(client, transforms, name: str) -> float:
    table = next(
        message
        for message in reversed(client.messages)
        if isinstance(message, dict) and message["type"] == "frame_table"
    )
    return float(transforms.poses[table["names"].index(name), 0])


async def arrived(client, name: str, x: float) -> None:
    """Wait until a frame has a position."""
    while True:
        transforms = await client.transforms()
        if transforms.poses.size and x_of(client, transforms, name) == x:
            return


def point(x: float, stamp: float, frame: str = "base"):
    message = get_message(POINT)()
    message.header.frame_id = frame
    message.header.stamp.sec, message.header.stamp.nanosec = int(stamp), int(stamp % 1 * 1e9)
    message.point.x = x
    return message


def test_exact_mode_shows_time_of_last_source_message():
    clock, received = FakeClock(), []
    control = TimeControl(clock, on_signal=lambda: received.append(1))
    control.record_stamp("scan", 90)
    assert (control.lookup_ns(), control.sources) == (None, ["scan"])
    control.set(paused=False, mode="Exact", source="scan")
    assert control.lookup_ns() is None  # until the next message of the source
    control.record_stamp("other", 80)
    control.record_stamp("scan", 95)
    assert (control.lookup_ns(), control.now_ns(), received) == (95, 95, [1])


def test_approximate_mode_follows_source_delay_smoothly():
    clock = FakeClock()
    control = TimeControl(clock)
    control.set(paused=False, mode="Approximate", source="scan")
    clock.ns = 2_000
    control.record_stamp("scan", 1_000)
    times = [control.lookup_ns() for _ in range(30)]
    assert times[0] == 1_700
    assert abs(times[-1] - 1_000) < 20
    assert times == sorted(times, reverse=True)


def test_displayed_time_stops_while_paused():
    clock = FakeClock()
    control = TimeControl(clock)
    control.set(paused=True, mode="Off", source="")
    clock.ns = 500
    assert (control.now_ns(), control.lookup_ns()) == (100, None)
    control.set(paused=False, mode="Off", source="")
    assert control.now_ns() == 500


async def test_pause_stops_frames_and_messages_for_all_pages():
    async with open_world(config()) as world, open_page(world.viewer) as first, open_page(world.viewer) as second:
        node = world.graph.create_node("clicker")
        points = node.create_publisher(POINT, "/p", 10)
        await first.opened()
        await second.opened()
        world.move_arm(x=1.0)
        await arrived(first, "tip", 1.0)
        await second.send("set_time", paused=True, mode="Off", source="")
        assert (await first.until("time_state"))["paused"] is True
        await first.drain()
        world.move_arm(x=2.0)
        world.move_arm(x=3.0)
        points.publish(point(0.25, time.time()))
        await world.settle()
        drained = await first.drain()
        assert all(isinstance(message, dict) for message in drained)  # no transforms and no data
        async with open_page(world.viewer) as late_client:
            assert (await late_client.opened())["time_state"]["paused"] is True
            await arrived(late_client, "tip", 1.0)
        await first.send("set_time", paused=False, mode="Off", source="")
        await arrived(first, "tip", 3.0)
        display = world.display("PointStamped")
        assert len(display.data()) == 1


PANEL = """\
Panels:
  - Class: rviz_common/Time
    Experimental: true
    Name: Time
    SyncMode: 1
    SyncSource: Clicks
Visualization Manager:
  Name: root
"""


async def test_rviz1_time_panel_is_read_and_keeps_its_format():
    text = PANEL.replace("    Experimental: true\n", "").replace("rviz_common", "rviz")
    file = RvizConfig.parse(text)
    async with open_world(file) as world, open_page(world.viewer) as client:
        state = (await client.opened())["time_state"]
        assert (state["mode"], state["source"]) == ("Exact", "Clicks")
        await client.send("set_time", paused=False, mode="Approximate", source="Clicks")
        await client.until("time_state", mode="Approximate")
        assert file.text() == text.replace("SyncMode: 1", "SyncMode: 2")


async def test_time_panel_of_file_is_read_and_written():
    file = RvizConfig.parse(PANEL)
    async with open_world(file) as world, open_page(world.viewer) as client:
        state = (await client.opened())["time_state"]
        assert (state["mode"], state["source"], state["paused"]) == ("Exact", "Clicks", False)
        assert file.text() == PANEL
        await client.send("set_time", paused=False, mode="Approximate", source="Other")
        await client.until("time_state", mode="Approximate")
        assert file.text() == PANEL.replace("SyncMode: 1", "SyncMode: 2").replace("Clicks", "Other")


@skipping
async def test_exact_synchronization_shows_frames_at_message_times():
    async with open_world(config()) as world, open_page(world.viewer) as client:
        node = world.graph.create_node("clicker")
        points = node.create_publisher(POINT, "/p", 10)
        await client.opened()
        points.publish(point(0.0, time.time()))
        assert (await client.until("time_state"))["sources"] == ["Clicks"]
        await client.send("set_time", paused=False, mode="Exact", source="Clicks")
        await client.until("time_state", mode="Exact")
        now_ns = world.graph.timebase.now_ns
        stamps = []
        for x in (0.0, 1.0):
            world.move_arm(x=x)
            stamps.append(now_ns() / 1e9)
            await asyncio.sleep(0.1)
        points.publish(point(0.0, (stamps[0] + stamps[1]) / 2))
        await world.settle()
        await client.drain()
        world.move_arm(x=2.0)  # the frame is shown between the earlier poses, not at this newest one
        points.publish(point(0.0, (stamps[0] + stamps[1]) / 2))
        await client.drain()
        frames = [message for message in client.messages if not isinstance(message, dict) and hasattr(message, "poses")]
        shown = x_of(client, frames[-1], "tip")
        assert 0.3 < shown < 0.7


async def test_reset_clears_displays_and_dynamic_frames():
    async with open_world(config()) as world, open_page(world.viewer) as client:
        node = world.graph.create_node("clicker")
        points = node.create_publisher(POINT, "/p", 10)
        await client.opened()
        world.move_arm(x=1.0)
        points.publish(point(0.25, time.time()))
        await world.settle()
        assert len(world.display("PointStamped").data()) == 1
        await client.send("reset_time")
        await client.until("time_reset")
        assert world.display("PointStamped").data() == []
        frames = world.viewer.manager.frames
        assert "mark" in frames.names
        assert "base" not in frames.names


async def test_clock_is_sent_only_to_watching_pages():
    async with open_world() as world, open_page(world.viewer) as client:
        await client.opened()
        assert not [
            message for message in await client.drain() if isinstance(message, dict) and message["type"] == "clock"
        ]
        await client.send("watch_clock", watching=True)
        clock = await client.until("clock")
        assert abs(clock["ros"] - time.time()) < 5
        assert clock["running"] is True
        assert 0 <= clock["wall"] - clock["wall_start"] < 5
        assert not [
            message for message in await client.drain() if isinstance(message, dict) and message["type"] == "clock"
        ]
        await client.send("set_time", paused=True, mode="Off", source="")
        assert (await client.until("clock"))["running"] is False


async def test_simulated_time_is_followed_and_resets_when_jumping_back():
    async with open_world() as world, open_page(world.viewer) as client:
        await client.opened()
        await client.send("watch_clock", watching=True)
        await client.until("clock")
        viewer_node = world.viewer.manager.context.node
        from linkwright.graph import Parameter

        viewer_node.set_parameters([Parameter("use_sim_time", value=True)])
        clocks = world.graph.create_node("simulator").create_publisher("rosgraph_msgs/msg/Clock", "/clock", 10)
        message = get_message("rosgraph_msgs/msg/Clock")()
        for seconds in (50, 51):
            message.clock.sec = seconds
            clocks.publish(message)
            await world.settle()
            clock = await client.until("clock", ros=float(seconds), running=False)
            assert clock["ros_start"] == 50  # not zero, the time before the first /clock
        message.clock.sec = 10
        await client.drain()
        clocks.publish(message)
        await world.settle()
        await client.until("time_reset")
        clock = await client.until("clock")
        assert np.isclose(clock["ros"] - clock["ros_start"], 0.0, atol=0.5)
