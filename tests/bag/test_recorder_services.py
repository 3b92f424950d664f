"""The services of a recorder, called by another node on a clock that the test moves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from linkwright.bag import BagReader, BagWriter, Recorder, RecorderServices, TopicSelection
from linkwright.graph import DEFAULT_QOS, Graph, JumpClock
from linkwright.messages import String, deserialize, get_message

START_NS = 1_700_000_000_000_000_000


class RecorderHarness:
    """A recorder, clients of its services, and a publisher."""

    def __init__(self, graph: Graph, path: Path, snapshot_size: int = 0) -> None:
        self.graph = graph
        self.events: list[tuple[str, str]] = []
        self._path = path
        self._node = graph.create_node("other")
        self._talking = self._node.create_publisher(String, "chatter", DEFAULT_QOS)
        event = get_message("rosbag2_interfaces/msg/WriteSplitEvent")
        self._node.create_subscription(event, "/events/write_split", self._split, DEFAULT_QOS)
        node = graph.create_node("rosbag2_recorder")
        writer = BagWriter(path, snapshot_size=snapshot_size)
        self.recorder = Recorder(node, TopicSelection(names=["/chatter"]), writer)
        RecorderServices(node, self.recorder, writer, snapshots=bool(snapshot_size))

    async def say(self, word: str) -> None:
        self._talking.publish(String(data=word))
        await self.graph.settle()

    async def call(self, name: str) -> Any:
        kind = "".join(word.title() for word in name.split("_"))
        client = self._node.create_client(f"rosbag2_interfaces/srv/{kind}", f"/rosbag2_recorder/{name}")
        response = client.call_async(client.srv_type.Request())
        await self.graph.settle()
        return response.result()

    def recorded(self) -> list[str]:
        self.recorder.close()
        with BagReader(self._path) as bag:
            return [deserialize(data, String).data for _, _, data in bag.messages()]

    def _split(self, event: Any) -> None:
        self.events.append((Path(event.closed_file).name, Path(event.opened_file).name))


@pytest.fixture
async def open_scene(tmp_path: Path):
    graph = Graph(clock=JumpClock(START_NS))
    yield lambda **options: RecorderHarness(graph, tmp_path / "bag", **options)
    await graph.close()


async def test_recorder_pauses_and_resumes(open_scene) -> None:
    open_scene = open_scene()
    await open_scene.say("one")
    await open_scene.call("pause")
    await open_scene.call("pause")
    assert (await open_scene.call("is_paused")).paused
    await open_scene.say("two")
    await open_scene.call("resume")
    assert not (await open_scene.call("is_paused")).paused
    await open_scene.say("three")
    assert open_scene.recorded() == ["one", "three"]


async def test_split_bagfile_starts_next_file_and_publishes_event(open_scene, tmp_path: Path) -> None:
    open_scene = open_scene()
    await open_scene.say("one")
    await open_scene.call("split_bagfile")
    await open_scene.say("two")
    assert open_scene.events == [("bag_0.mcap", "bag_1.mcap")]
    assert open_scene.recorded() == ["one", "two"]
    with BagReader(tmp_path / "bag") as bag:
        assert [file.name for file in bag.files] == ["bag_0.mcap", "bag_1.mcap"]


async def test_snapshot_mode_writes_only_snapshots(open_scene) -> None:
    open_scene = open_scene(snapshot_size=1000)
    await open_scene.say("one")
    assert (await open_scene.call("snapshot")).success
    await open_scene.say("two")
    assert open_scene.recorded() == ["one"]


async def test_snapshot_service_exists_only_in_snapshot_mode(open_scene) -> None:
    open_scene = open_scene()
    names = [name for name, _ in open_scene.graph.get_service_names_and_types()]
    assert "/rosbag2_recorder/split_bagfile" in names
    assert "/rosbag2_recorder/snapshot" not in names
    assert open_scene.recorded() == []
