"""Plots for a past time: only the samples before it are plotted."""

from __future__ import annotations

import asyncio

from linkwright.messages import get_message
from tests.panels.monitor.test_live_panels import subscription_count, wait_for_samples
from tests.panels.test_live_history import MAX_HISTORY_BYTES
from tests.panels.test_time import config
from tests.panels.test_timeline import START_S, open_recording
from tests.skipping import skipping
from tests.viewer.scene import open_page, open_world
from tests.waiting import eventually

FLOAT = get_message("std_msgs/msg/Float64")
SERIES = [{"id": 1, "topic": "/speed", "path": "data"}]


async def wait_for_plot(client, values: list[float]) -> None:
    """Wait until a page receives these values of a series in one message."""
    while (await wait_for_samples(client))[1][2].tolist() != values:
        pass


@skipping
async def test_plots_follow_time_back_and_are_complete_in_live_mode():
    async with open_world(config(), history=MAX_HISTORY_BYTES) as world, open_page(world.viewer) as client:
        publisher = world.graph.create_node("talker").create_publisher(FLOAT, "/speed", 10)
        await client.send("watch_series", series=SERIES, seconds=30)
        await eventually(lambda: subscription_count(world, "/speed") == 1)
        times_between = []
        for number in range(5):
            publisher.publish(FLOAT(data=float(number)))
            await asyncio.sleep(0.5)
            times_between.append(world.graph.timebase.now_ns() / 1e9)
            await asyncio.sleep(0.5)
        await client.send("seek_time", position=times_between[2])
        await wait_for_plot(client, [0.0, 1.0, 2.0])
        publisher.publish(FLOAT(data=9.0))
        await client.send("watch_series", series=SERIES, seconds=1.0)
        await client.send("seek_time", position=times_between[3])
        await wait_for_plot(client, [3.0])
        await client.send("watch_series", series=SERIES, seconds=60)
        await wait_for_plot(client, [0.0, 1.0, 2.0, 3.0])
        await client.send("go_live")
        await wait_for_plot(client, [0.0, 1.0, 2.0, 3.0, 4.0, 9.0])


@skipping
async def test_added_series_begins_with_stored_samples():
    async with open_world(config(), history=MAX_HISTORY_BYTES) as world, open_page(world.viewer) as client:
        publisher = world.graph.create_node("talker").create_publisher(FLOAT, "/speed", 10)
        await client.send("watch_series", series=SERIES, seconds=30)
        await eventually(lambda: subscription_count(world, "/speed") == 1)
        for number in range(3):
            publisher.publish(FLOAT(data=float(number)))
            await asyncio.sleep(0.5)
        async with open_page(world.viewer) as late_client:
            await late_client.send("watch_series", series=SERIES, seconds=30)
            await wait_for_plot(late_client, [0.0, 1.0, 2.0])


@skipping
async def test_plots_of_recording_show_samples_before_playback_time(tmp_path):
    async with open_recording(tmp_path) as world, open_page(world.viewer) as client:
        await client.until("playhead", playing=True)
        await client.send("play", playing=False)
        await client.until("playhead", playing=False)
        await client.send("watch_series", series=[{"id": 1, "topic": "/p", "path": "point.x"}], seconds=3.5)
        for second in (9, 4):
            await client.send("seek_time", position=START_S + second)
            await wait_for_plot(client, [second - 3.0, second - 2.0, second - 1.0, float(second)])
        await client.send("step_time", forward=True)
        await wait_for_plot(client, [5.0])
