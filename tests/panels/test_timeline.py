"""A recording in a viewer: the messages to pages, and their requests."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import numpy as np
import pytest

from linkwright.bag import BagReader, BagWriter, Playback, PublishedRecording
from linkwright.graph import DEFAULT_QOS, Parameter
from linkwright.messages import TFMessage, TransformBatch, serialize
from tests.panels.test_time import POINT, arrived, config, point
from tests.skipping import skipping
from tests.viewer.scene import World, open_page, open_world

START_S = 1_700_000_000
SECOND_NS = 1_000_000_000


def recorded(folder: Path) -> Path:
    """Record ten seconds with a point each second.

    The x of a frame is the seconds since the start.
    """
    pytest.importorskip("rosbags", reason="rosbags has no wheel for Python 3.15")
    path = folder / "drive"
    with BagWriter(path) as writer:
        writer.add_topic("/p", POINT, [DEFAULT_QOS])
        writer.add_topic("/tf", "tf2_msgs/msg/TFMessage", [DEFAULT_QOS])
        for second in range(11):
            stamp = (START_S + second) * SECOND_NS
            batch = TransformBatch(("base",), ("tip",), stamp, np.array([[second, 0, 0, 0, 0, 0, 1.0]]))
            writer.write("/tf", stamp, serialize(TFMessage(batch=batch)))
            writer.write("/p", stamp, serialize(point(float(second), START_S + second)))
    return path


@asynccontextmanager
async def open_recording(folder: Path, **other: str) -> AsyncIterator[World]:
    """Show the recording in a viewer, in the recording's time.

    Words of its files can be replaced.
    """
    path = recorded(folder)
    for file in path.iterdir():
        for word, instead in other.items():
            file.write_bytes(file.read_bytes().replace(word.encode(), instead.encode()))
    async with open_world(config()) as world:
        with BagReader(path) as bag:
            world.viewer.context.node.set_parameters([Parameter("use_sim_time", value=True)])
            player = world.graph.create_node("player")
            output = PublishedRecording(player, bag)
            playback = Playback(player.handle, bag, output, world.viewer.on_playback_error)
            world.viewer.attach_recording(playback, bag)
            yield world
            playback.close()


@skipping
async def test_page_receives_timeline_and_playback_starts(tmp_path):
    async with open_recording(tmp_path) as world, open_page(world.viewer) as client:
        timeline = await client.until("timeline")
        assert (timeline["name"], timeline["start"], timeline["end"]) == ("drive", START_S, START_S + 10)
        assert {topic["name"]: sum(topic["counts"]) for topic in timeline["topics"]} == {"/p": 11, "/tf": 11}
        await client.until("playhead", playing=True)
        await arrived(client, "tip", 3)
        await client.until("playhead", playing=False, position=START_S + 10)


@skipping
async def test_seek_shows_data_of_that_time(tmp_path):
    async with open_recording(tmp_path) as world, open_page(world.viewer) as client:
        await client.until("playhead", playing=True)
        await client.send("play", playing=False)
        await client.until("playhead", playing=False)
        for second in (7, 2, 9):
            await client.send("seek_time", position=START_S + second)
            await client.until("playhead", position=START_S + second, playing=False)
            await arrived(client, "tip", second)
        await client.send("step_time", forward=False)
        await client.until("playhead", position=START_S + 8)
        await arrived(client, "tip", 8)


@skipping
async def test_playback_speed_and_loop_are_set(tmp_path):
    async with open_recording(tmp_path) as world, open_page(world.viewer) as client:
        await client.until("playhead", playing=True)
        await client.send("set_playback", speed=5, loop=True)
        await client.until("playhead", speed=5, loop=True)
        await client.send("set_playback", speed=-5, loop=False)
        await client.send("set_playback", speed=2, loop=True)
        await client.until("playhead", speed=2, loop=True)
        assert not any(isinstance(message, dict) and message.get("speed") == -5 for message in client.messages)


@skipping
async def test_recorded_simulation_has_no_simulation_bar(tmp_path):
    async with open_recording(tmp_path) as world:
        node = world.graph.create_node("recorded_simulation")
        state = node.create_publisher("simulation_interfaces/msg/SimulationState", "/simulation_state", 1)
        async with open_page(world.viewer) as client:
            assert (await client.until("simulation_status"))["present"] is False
            state.publish(state.msg_type(state=1))
            await client.until("playhead", playing=False, position=START_S + 10)
            messages = [
                message
                for message in client.messages
                if isinstance(message, dict) and message["type"] == "simulation_status"
            ]
            assert not any(message["present"] for message in messages)


@skipping
async def test_topics_of_unknown_type_are_reported(tmp_path):
    # The recording's definition of the unknown type is invalid too.
    async with open_recording(tmp_path, Point="Paint", float64="flaot64") as world, open_page(world.viewer) as client:
        message = await client.until("playhead", playing=True)
        assert message["problem"] == (
            "topics of 'drive' are left out because the definitions of their types are missing or invalid: "
            "/p (geometry_msgs/msg/PaintStamped)"
        )
        await arrived(client, "tip", 3)


@skipping
async def test_viewer_without_recording_has_no_timeline():
    async with open_world() as world, open_page(world.viewer) as client:
        assert "timeline" not in await client.opened()
        await client.send("play", playing=True)
        await client.send("seek_time", position=1)
