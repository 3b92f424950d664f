"""The services of a player, called by another node on a clock that the test moves."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.bag import BagReader, BagWriter, Player, PlayerServices, PlayOptions
from linkwright.graph import DEFAULT_QOS, Graph, JumpClock
from linkwright.messages import String, get_message, serialize

SECOND_NS = 1_000_000_000
START = 1_700_000_000 * SECOND_NS

Time = get_message("builtin_interfaces/msg/Time")


class PlayerHarness:
    """A player of a recording, a subscription to its topic, and clients of its services.

    The recording has a message each second.
    """

    def __init__(self, graph: Graph, bag: BagReader, options: PlayOptions) -> None:
        self.graph = graph
        self.heard: list[str] = []
        self._node = graph.create_node("other")
        self._node.create_subscription(String, "chatter", lambda message: self.heard.append(message.data), DEFAULT_QOS)
        node = graph.create_node("rosbag2_player")
        self.player = Player(node, bag, options)
        PlayerServices(node, self.player)
        self.player.start()

    async def call(self, name: str, **request):
        kind = "".join(word.title() for word in name.split("_"))
        client = self._node.create_client(f"rosbag2_interfaces/srv/{kind}", f"/rosbag2_player/{name}")
        response = client.call_async(client.srv_type.Request(**request))
        await self.graph.settle()
        return response.result()


@pytest.fixture
def clock():
    return JumpClock(START)


@pytest.fixture
async def scene(clock, tmp_path: Path):
    with BagWriter(tmp_path / "bag") as writer:
        writer.add_topic("/chatter", "std_msgs/msg/String", [DEFAULT_QOS])
        for number in range(5):
            writer.write("/chatter", START + number * SECOND_NS, serialize(String(data=str(number))))
    graph = Graph(clock=clock)
    with BagReader(tmp_path / "bag") as bag:
        yield lambda **options: PlayerHarness(graph, bag, PlayOptions(**options))
        await graph.close()


async def test_player_pauses_and_resumes(scene, clock):
    scene = scene(paused=True)
    await clock.advance(5)
    assert scene.heard == []
    assert (await scene.call("is_paused")).paused
    for _ in range(2):
        await scene.call("resume")
    await clock.advance(1.5)
    for _ in range(2):
        await scene.call("pause")
    await clock.advance(5)
    assert scene.heard == ["0", "1"]
    await scene.call("toggle_paused")
    assert not (await scene.call("is_paused")).paused
    await clock.advance(5)
    assert scene.heard == ["0", "1", "2", "3", "4"]
    assert scene.player.finished


async def test_player_rate_is_set_and_returned(scene, clock):
    scene = scene()
    await clock.advance(0.5)
    assert (await scene.call("set_rate", rate=10.0)).success
    for invalid_rate in (0.0, -1.0, float("nan"), float("inf")):
        assert not (await scene.call("set_rate", rate=invalid_rate)).success
    assert (await scene.call("get_rate")).rate == 10.0
    await clock.advance(0.3)
    assert scene.heard == ["0", "1", "2", "3"]


async def test_play_next_and_burst_require_pause(scene, clock):
    scene = scene()
    await clock.advance(0.5)
    assert not (await scene.call("play_next")).success
    assert (await scene.call("burst", num_messages=2)).actually_burst == 0
    await scene.call("pause")
    assert (await scene.call("play_next")).success
    assert (await scene.call("burst", num_messages=2)).actually_burst == 2
    assert scene.heard == ["0", "1", "2", "3"]
    assert (await scene.call("burst", num_messages=2)).actually_burst == 1
    assert scene.player.finished


async def test_burst_of_all_messages_ends_after_one_loop(scene):
    scene = scene(paused=True, loop=True)
    assert (await scene.call("burst", num_messages=0)).actually_burst == 5
    assert (await scene.call("burst", num_messages=7)).actually_burst == 5
    assert scene.heard == 2 * ["0", "1", "2", "3", "4"]
    assert not scene.player.finished


async def test_loop_over_zero_duration_recording_does_not_block(clock, tmp_path):
    with BagWriter(tmp_path / "short") as writer:
        writer.add_topic("/chatter", "std_msgs/msg/String", [DEFAULT_QOS])
        for number in range(3):
            writer.write("/chatter", START + number, serialize(String(data=str(number))))
    graph = Graph(clock=clock)
    with BagReader(tmp_path / "short") as bag:
        scene = PlayerHarness(graph, bag, PlayOptions(loop=True))
        await clock.advance(0.01)
        assert 3 < len(scene.heard) < 40
        assert scene.heard[:4] == ["0", "1", "2", "0"]
        await graph.close()


@pytest.mark.parametrize("paused", [True, False])
async def test_player_seek_continues_from_given_time(scene, clock, paused):
    scene = scene(paused=paused)
    await clock.advance(0.5)
    seek_s = START // SECOND_NS + 3
    assert (await scene.call("seek", time=Time(sec=seek_s))).success
    if paused:
        await scene.call("resume")
    await clock.advance(0.9)
    assert scene.heard == (["3"] if paused else ["0", "3"])
    assert (await scene.call("seek", time=Time(sec=1))).success  # before the start of the recording
    await clock.advance(1.1)
    assert scene.heard[-2:] == ["0", "1"]


async def test_stopped_player_does_not_restart(scene, clock):
    scene = scene()
    await clock.advance(0.5)
    assert not (await scene.call("play")).success
    await scene.call("stop")
    await clock.advance(5)
    assert scene.player.finished
    assert scene.heard == ["0"]
