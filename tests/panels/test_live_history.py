"""The last minutes in a viewer: pausing, going back, and returning to the present."""

from __future__ import annotations

import asyncio

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import String, TFMessage, deserialize
from tests.panels.test_time import arrived, config
from tests.skipping import skipping
from tests.viewer.scene import World, open_page, open_world

MAX_HISTORY_BYTES = 10_000_000


def move_arm(world: World, x: float) -> int:
    """Publish the position of the arm, and return the time in nanoseconds."""
    world.move({("base", "tip"): (x, 0, 0, 0, 0, 0, 1)})
    return world.graph.timebase.now_ns()


async def publish_positions(world: World) -> list[float]:
    """Publish five positions of a frame, one each second.

    Return the times halfway between, in seconds.
    """
    times_between = []
    for x in range(5):
        move_arm(world, float(x))
        await asyncio.sleep(0.5)
        times_between.append(world.graph.timebase.now_ns() / 1e9)
        await asyncio.sleep(0.5)
    return times_between


@skipping
async def test_live_view_pauses_seeks_and_returns_to_live():
    async with open_world(config(), history=MAX_HISTORY_BYTES) as world, open_page(world.viewer) as client:
        timeline = await client.until("timeline")
        assert timeline["live"]
        await client.until("playhead", live=True)
        times_between = await publish_positions(world)
        await arrived(client, "tip", 4)
        await client.send("play", playing=False)
        await client.until("playhead", live=False, playing=False)
        move_arm(world, 9.0)
        for number in (1, 3, 0):
            await client.send("seek_time", position=times_between[number])
            await arrived(client, "tip", number)
        await client.send("step_time", forward=True)
        await arrived(client, "tip", 1)
        clock = world.viewer.context.node.get_clock()
        assert times_between[0] < clock.now().nanoseconds / 1e9 < times_between[1], (
            "the viewer's clock has the shown time"
        )
        await client.send("go_live")
        await client.until("playhead", live=True)
        await arrived(client, "tip", 9)
        assert clock.now().nanoseconds / 1e9 > times_between[-1]


@skipping
async def test_playback_of_history_reaches_live():
    async with open_world(config(), history=MAX_HISTORY_BYTES) as world, open_page(world.viewer) as client:
        await client.until("playhead", live=True)
        times_between = await publish_positions(world)
        await client.send("seek_time", position=times_between[0])
        await client.until("playhead", live=False)
        await client.send("set_playback", speed=10, loop=False)
        await client.send("play", playing=True)
        await arrived(client, "tip", 4)
        await client.until("playhead", live=True)


@skipping
async def test_subscription_during_pause_receives_past_latched_message():
    async with open_world(config(), history=MAX_HISTORY_BYTES) as world, open_page(world.viewer) as client:
        world.describe("<robot name='early'/>")
        texts: list[str] = []
        node = world.viewer.context.node
        node.create_subscription("std_msgs/msg/String", "robot_description", lambda _: None, DESCRIPTION_QOS)
        await world.settle()
        await client.send("play", playing=False)
        await client.until("playhead", live=False)
        world.describe("<robot name='late'/>")
        node.create_subscription(
            "std_msgs/msg/String", "robot_description", lambda message: texts.append(message.data), DESCRIPTION_QOS
        )
        await asyncio.sleep(1.0)
        await world.settle()
        assert texts == ["<robot name='early'/>"]
        await client.send("go_live")
        await client.until("playhead", live=True)
        await world.settle()
        assert texts[-1] == "<robot name='late'/>"


async def test_pending_messages_are_stored_when_history_is_read():
    async with open_world(config(), history=MAX_HISTORY_BYTES) as world:
        live = world.viewer.live
        for x in range(3):
            move_arm(world, float(x))
        assert live.size == 0
        assert not live.has_playback
        start_ns, end = live.span_ns
        assert start_ns <= end
        positions = [
            deserialize(data, TFMessage).batch.poses[0, 0]
            for _, _, data in live.history.messages_between(start_ns, end)
        ]
        assert positions == [0.0, 1.0, 2.0]
        assert live.size > 0


async def test_pending_messages_are_stored_in_batches():
    async with open_world(config(), history=MAX_HISTORY_BYTES) as world:
        for x in range(20):
            move_arm(world, float(x))
        assert world.viewer.live.size > 0


async def test_unserializable_message_is_reported_and_others_are_stored():
    async with open_world(config(), history=MAX_HISTORY_BYTES) as world:
        start_ns = move_arm(world, 1.0)
        invalid_message = String()
        invalid_message._data = 7  # the setter would reject this value
        world.viewer.context.node.create_subscription(String, "words", lambda _: None, 10)
        world.graph.create_node("speaker").create_publisher(String, "words", 10).publish(invalid_message)
        end = move_arm(world, 2.0)
        assert [topic for topic, _, _ in world.viewer.live.history.messages_between(start_ns, end)] == ["/tf", "/tf"]
        assert any("keeping a message of '/words' failed" in record.text for record in world.log)


@skipping
async def test_viewer_without_history_stores_nothing():
    async with open_world(config()) as world, open_page(world.viewer) as client:
        assert "timeline" not in await client.opened()
        assert world.viewer.context.node.handle.message_filter is None
