"""Recording from pages: the files, the messages to pages, and the end."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import NamedTuple

import aiohttp
import pytest

from linkwright.bag import BagReader, BagWriter
from linkwright.graph import Parameter
from linkwright.messages import Time
from linkwright.page.access import TOKEN_PARAMETER
from linkwright.panels import recording as module
from linkwright.panels.recording import RecordingFeature
from tests.full_disk import full_disk, needs_limits
from tests.panels.test_live_history import MAX_HISTORY_BYTES, publish_positions
from tests.panels.test_time import config
from tests.panels.test_timeline import open_recording
from tests.recordings import needs_rosbags
from tests.skipping import skipping
from tests.viewer.scene import Client, World, open_page, open_world

pytestmark = needs_rosbags

TF, STRING = "/tf", "std_msgs/msg/String"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the working directory, to which recordings are written."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def made_in(folder: Path) -> set[str]:
    """Return the names of the files in a folder."""
    return {path.name for path in folder.iterdir()}


def mcap(recording: str) -> Path:
    """Return the file of a recording."""
    (file,) = Path(recording).glob("*.mcap")
    return file


def feature(world: World) -> RecordingFeature:
    return world.viewer.add_feature(RecordingFeature)


async def start_recording(client: Client, *topics: str) -> dict:
    await client.send("record_topics", topics=list(topics))
    while not (state := await client.until("recording_state"))["path"]:
        assert not state["problem"]
    return state


async def wait_for_end(client: Client) -> dict:
    while (state := await client.until("recording_state"))["path"]:
        pass
    return state


async def saved(client: Client, start: float | None = None, end: float | None = None) -> dict:
    await client.send("save_minutes", start=start, end=end)
    while (await client.until("recording_state"))["saved"] is None:
        pass
    while (state := await client.until("recording_state"))["saved"] is not None:
        pass
    return state


@skipping
async def test_all_topics_are_recorded_and_file_can_be_opened(folder: Path):
    async with open_world() as world, open_page(world.viewer) as client:
        assert not (await client.until("recording_state"))["path"]
        state = await start_recording(client)
        await world.settle()
        for x in range(5):
            world.move_arm(float(x))
            await world.settle()
            await asyncio.sleep(0.5)
        logged = await client.until("recording_state")
        assert logged["length"] >= 0
        await client.send("stop_recording")
        (file,) = (await wait_for_end(client))["files"]
        assert Path(state["path"]).parent == folder
        assert Path(file["path"]) == Path(state["path"])
        with BagReader(file["path"]) as bag:
            assert {"/tf", "/tf_static"} <= {topic.name for topic in bag.topics}
            assert len(list(bag.messages([TF]))) == 5


@skipping
async def test_only_selected_topics_are_recorded():
    async with open_world() as world, open_page(world.viewer) as client:
        await start_recording(client, TF)
        await world.settle()
        world.move_arm(1.0)
        world.describe("<robot name='r'/>")
        await world.settle()
        await client.send("stop_recording")
        (file,) = (await wait_for_end(client))["files"]
        with BagReader(file["path"]) as bag:
            assert [topic.name for topic in bag.topics] == [TF]


@skipping
async def test_pages_share_recording_that_outlives_its_page():
    async with open_world() as world:
        async with open_page(world.viewer) as other:
            async with open_page(world.viewer) as client:
                state = await start_recording(client)
                while (recording_state := await other.until("recording_state"))["path"] != state["path"]:
                    pass
                await other.send("record_topics", topics=[])
            world.move_arm(1.0)
            await world.settle()
            await asyncio.sleep(2.0)
            assert (await other.until("recording_state"))["path"] == recording_state["path"]
        async with open_page(world.viewer) as late_client:
            assert (await late_client.until("recording_state"))["path"] == state["path"]
            world.move_arm(2.0)
            await world.settle()
            await late_client.send("stop_recording")
            assert [file["path"] for file in (await wait_for_end(late_client))["files"]] == [state["path"]]


@skipping
async def test_program_exit_finishes_recording():
    async with open_world() as world, open_page(world.viewer) as client:
        state = await start_recording(client, TF)
        await world.settle()
        world.move_arm(1.0)
        await world.settle()
    with BagReader(state["path"]) as bag:
        assert not bag.findings
        assert len(list(bag.messages())) == 1


@skipping
async def test_recordings_within_one_second_get_unique_names(folder: Path):
    async with open_world() as world, open_page(world.viewer) as client:
        paths = set()
        for _ in range(3):
            state = await start_recording(client, TF)
            await world.settle()
            world.move_arm(1.0)
            await world.settle()
            await client.send("stop_recording")
            await wait_for_end(client)
            paths.add(state["path"])
        assert len(paths) == 3
        assert {str(folder / name) for name in made_in(folder)} == paths


@skipping
async def test_empty_recording_is_deleted(folder: Path):
    async with open_world() as world, open_page(world.viewer) as client:
        await start_recording(client, "/nobody")
        await client.send("stop_recording")
        state = await wait_for_end(client)
        assert "no messages arrived" in state["problem"]
        assert not state["files"]
        assert made_in(folder) == set()


@skipping
@needs_limits
async def test_full_disk_stops_recording_and_keeps_messages():
    async with open_world() as world, open_page(world.viewer) as client:
        await start_recording(client, "/long")
        node = world.graph.create_node("talker")
        publisher = node.create_publisher(STRING, "/long", 10)
        await asyncio.sleep(0.5)
        await world.settle()
        publisher.publish(publisher.msg_type(data="first"))
        await world.settle()
        await asyncio.sleep(1.5)
        with full_disk(20_000):
            for _ in range(2000):
                publisher.publish(publisher.msg_type(data="x" * 1000))
                await world.settle()
            await asyncio.sleep(2.0)
            state = await wait_for_end(client)
        assert " stopped: " in state["problem"]
        (file,) = state["files"]
        with BagReader(Path(file["path"])) as bag:
            assert len(list(bag.messages())) >= 1


class Usage(NamedTuple):
    """The result of `shutil.disk_usage` in bytes."""

    total: int
    used: int
    free: int


@skipping
async def test_recording_stops_when_little_disk_space_is_left(monkeypatch: pytest.MonkeyPatch, folder: Path):
    async with open_world() as world, open_page(world.viewer) as client:
        state = await start_recording(client, TF)
        await world.settle()
        world.move_arm(1.0)
        await world.settle()
        monkeypatch.setattr(module.shutil, "disk_usage", lambda _: Usage(10**12, 10**12, 10**8))
        stopped = await wait_for_end(client)
        assert "less than 256 MB left" in stopped["problem"]
        with BagReader(state["path"]) as bag:
            assert not bag.findings, "the recording is complete"
        await client.send("record_topics", topics=[])
        while not (refused := await client.until("recording_state"))["problem"].startswith("there is not enough space"):
            pass
        assert not refused["path"]
        assert made_in(folder) == {Path(state["path"]).name}


@skipping
async def test_unwritable_folder_is_reported(folder: Path):
    async with open_world() as world, open_page(world.viewer) as client:
        feature(world).folder = folder / "gone" / "away"
        (folder / "gone").write_text("a file in its place")
        await client.send("record_topics", topics=[])
        while not (state := await client.until("recording_state"))["problem"]:
            pass
        assert not state["path"]


@skipping
async def test_simulated_time_reset_stops_recording():
    async with open_world() as world, open_page(world.viewer) as client:
        world.viewer.context.node.set_parameters([Parameter("use_sim_time", value=True)])
        clock = world.graph.create_node("simulator").create_publisher("rosgraph_msgs/msg/Clock", "/clock", 10)
        state = await start_recording(client, TF)
        for second in (100, 101, 102):
            clock.publish(clock.msg_type(clock=Time(sec=second)))
            await world.settle()
            await asyncio.sleep(0.2)
            world.move_arm(1.0)
            await world.settle()
        clock.publish(clock.msg_type(clock=Time(sec=1)))
        await world.settle()
        stopped = await wait_for_end(client)
        assert "simulated time was reset" in stopped["problem"]
        with BagReader(state["path"]) as bag:
            assert 100 <= bag.start_ns / 1e9 <= bag.end_ns / 1e9 <= 102


@skipping
async def test_history_and_part_of_history_are_saved():
    async with open_world(config(), history=MAX_HISTORY_BYTES) as world, open_page(world.viewer) as client:
        await client.until("recording_state")
        world.move({("tip", "mark"): (0, 0, 0, 0, 0, 0, 1)}, static=True)
        times_between = await publish_positions(world)
        (whole_file,) = (await saved(client))["files"]
        with BagReader(whole_file["path"]) as bag:
            assert len(list(bag.messages([TF]))) == 5
        part = (await saved(client, times_between[1], times_between[3]))["files"][0]
        assert part["path"] != whole_file["path"]
        with BagReader(part["path"]) as bag:
            stamps = [stamp / 1e9 for _, stamp, _ in bag.messages()]
            assert times_between[1] - 1e-6 <= stamps[0] <= stamps[-1] <= times_between[3]
            assert len(list(bag.messages(["/tf_static"]))) == 1, "earlier static transforms are included"
            later = [stamp for _, stamp, _ in bag.messages([TF]) if stamp / 1e9 > times_between[1] + 1e-6]
            assert len(later) == 2
        empty_result = await saved(client, 1.0, 2.0)
        assert "no messages arrived in that time" in empty_result["problem"]


@skipping
async def test_saved_simulation_history_starts_at_last_time_reset():
    async with open_world(config(), history=MAX_HISTORY_BYTES) as world, open_page(world.viewer) as client:
        await client.until("recording_state")
        world.viewer.context.node.set_parameters([Parameter("use_sim_time", value=True)])
        clock = world.graph.create_node("simulator").create_publisher("rosgraph_msgs/msg/Clock", "/clock", 10)
        await world.settle()
        world.move({("tip", "mark"): (0, 0, 0, 0, 0, 0, 1)}, static=True)
        await world.settle()
        for second in (50, 51, 52, 3, 4):
            clock.publish(clock.msg_type(clock=Time(sec=second)))
            await world.settle()
            await asyncio.sleep(0.2)
            world.move_arm(float(second))
            await world.settle()
            await asyncio.sleep(0.2)
        (file,) = (await saved(client))["files"]
        with BagReader(file["path"]) as bag:
            assert (bag.start_ns, bag.end_ns) == (3 * 10**9, 4 * 10**9)
            assert len(list(bag.messages([TF]))) == 2
            assert len(list(bag.messages(["/tf_static"]))) >= 1


@skipping
async def test_recording_can_be_downloaded_completely_and_repeatedly():
    async with open_world() as world, open_page(world.viewer) as client:
        await start_recording(client, TF)
        await world.settle()
        for x in range(2000):
            world.move_arm(float(x))
            await world.settle()
        await client.send("stop_recording")
        (file,) = (await wait_for_end(client))["files"]
        path = mcap(file["path"])
        address = world.viewer.url.split(f"?{TOKEN_PARAMETER}")[0].rstrip("/") + file["url"]
        async with aiohttp.ClientSession() as session:
            for _ in range(2):
                async with session.get(address) as response:
                    assert response.status == 200
                    assert response.headers["Content-Disposition"].endswith(path.name)
                    assert await response.read() == path.read_bytes()
            path.unlink()
            async with session.get(address) as response:
                assert response.status == 404


@skipping
async def test_recording_is_disabled_during_playback(folder: Path):
    async with open_recording(folder) as world, open_page(world.viewer) as client:
        assert not (await client.until("recording_state"))["possible"]
        await client.send("record_topics", topics=[])
        await client.send("play", playing=False)
        await client.until("playhead", playing=False)
        assert made_in(folder) == {"drive"}


def test_bag_writer_reports_written_size(tmp_path: Path):
    with BagWriter(tmp_path / "bag") as writer:
        writer.add_topic("/chatter", STRING)
        before = writer.size
        writer.write("/chatter", 1, bytes(1000))
        writer.flush()
        assert writer.size >= before + 1000
