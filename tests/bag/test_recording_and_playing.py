"""Recorder and player on a clock that the test moves."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path

import pytest
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from linkwright.bag import BagReader, BagWriter, Player, PlayOptions, Recorder, TopicSelection
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import DEFAULT_QOS, DESCRIPTION_QOS, SENSOR_DATA_QOS, Graph, JumpClock, LogRecord, Node
from linkwright.graph.endpoints.service import ServiceIntrospectionState
from linkwright.messages import String, deserialize, get_message, serialize, type_hash

START_NS = 1_700_000_000_000_000_000
SECOND_NS = 1_000_000_000


@pytest.fixture
def clock() -> JumpClock:
    return JumpClock(START_NS)


@pytest.fixture
def log() -> list[LogRecord]:
    return []


@pytest.fixture
async def graph(clock: JumpClock, log: list[LogRecord]) -> AsyncIterator[Graph]:
    graph = Graph(clock=clock, on_log=log.append)
    yield graph
    await graph.close()
    assert asyncio.all_tasks() == {asyncio.current_task()}


def recorded_texts(path: Path) -> list[str]:
    with BagReader(path) as bag:
        return [deserialize(data, String).data for topic, _, data in bag.messages() if topic == "/chatter"]


async def test_recorder_writes_topics_with_message_times(graph: Graph, clock: JumpClock, tmp_path: Path) -> None:
    publisher = graph.create_node("talker").create_publisher(String, "chatter", DEFAULT_QOS)
    recorder = Recorder(graph.create_node("recorder"), TopicSelection(names=["/chatter"]), BagWriter(tmp_path / "bag"))
    for number in range(4):
        publisher.publish(String(data=str(number)))
        await clock.advance(0.25)
    recorder.close()
    assert recorder.message_count == 4
    with BagReader(tmp_path / "bag") as bag:
        assert [stamp - START_NS for _, stamp, _ in bag.messages()] == [
            0,
            SECOND_NS // 4,
            SECOND_NS // 2,
            SECOND_NS * 3 // 4,
        ]
    assert recorded_texts(tmp_path / "bag") == ["0", "1", "2", "3"]


async def test_recorder_subscribes_to_later_topics_until_all_exist(
    graph: Graph, clock: JumpClock, tmp_path: Path, log: list[LogRecord]
) -> None:
    recorder = Recorder(graph.create_node("recorder"), TopicSelection(names=["/chatter"]), BagWriter(tmp_path / "bag"))
    await clock.advance(1)
    publisher = graph.create_node("talker").create_publisher(String, "chatter", DEFAULT_QOS)
    await clock.advance(0.2)
    publisher.publish(String(data="late"))
    await clock.advance(0.1)
    recorder.close()
    assert recorded_texts(tmp_path / "bag") == ["late"]
    logged = [record.text for record in log if record.node == "recorder"]
    assert logged == [
        "Listening for topics...",
        "Subscribed to topic '/chatter'",
        "All requested topics are subscribed. Stopping discovery...",
        "Recording stopped",
    ]


async def test_recorder_receives_latched_messages_published_earlier(
    graph: Graph, clock: JumpClock, tmp_path: Path
) -> None:
    publisher = graph.create_node("talker").create_publisher(String, "chatter", DESCRIPTION_QOS)
    publisher.publish(String(data="before"))
    recorder = Recorder(graph.create_node("recorder"), TopicSelection(all_topics=True), BagWriter(tmp_path / "bag"))
    await clock.advance(0.1)
    recorder.close()
    assert recorded_texts(tmp_path / "bag") == ["before"]


async def test_paused_recorder_writes_nothing(graph: Graph, clock: JumpClock, tmp_path: Path) -> None:
    publisher = graph.create_node("talker").create_publisher(String, "chatter", SENSOR_DATA_QOS)
    recorder = Recorder(
        graph.create_node("recorder"), TopicSelection(all_topics=True), BagWriter(tmp_path / "bag"), paused=True
    )
    for text in ("no", "yes"):
        publisher.publish(String(data=text))
        await clock.advance(0.1)
        recorder.toggle_paused()
    recorder.close()
    assert recorded_texts(tmp_path / "bag") == ["yes"]


async def test_unknown_type_is_reported_once(
    graph: Graph, clock: JumpClock, tmp_path: Path, log: list[LogRecord], monkeypatch: pytest.MonkeyPatch
) -> None:
    node = graph.create_node("recorder")
    monkeypatch.setattr(
        type(node), "get_topic_names_and_types", lambda _: [("/odd", ["nowhere_msgs/msg/Odd"])], raising=True
    )
    recorder = Recorder(node, TopicSelection(all_topics=True), BagWriter(tmp_path / "bag"), without_publishers=True)
    await clock.advance(1)
    recorder.close()
    assert sum("nowhere_msgs" in record.text for record in log) == 1
    assert log[-1].text == "Not in the recording: /odd"


async def test_recorder_reports_topics_without_messages_at_end(
    graph: Graph, tmp_path: Path, log: list[LogRecord]
) -> None:
    graph.create_node("talker").create_publisher(String, "chatter", DEFAULT_QOS)
    selection = TopicSelection(names=["/chatter", "/silent"], services=["/asked"])
    Recorder(graph.create_node("recorder"), selection, BagWriter(tmp_path / "bag")).close()
    assert log[-1].text == "Not in the recording: /asked/_service_event, /silent"


async def test_recorder_can_skip_topics_without_subscriptions(graph: Graph, clock: JumpClock, tmp_path: Path) -> None:
    node = graph.create_node("talker")
    node.create_publisher(String, "heard", DEFAULT_QOS)
    node.create_publisher(String, "unheard", DEFAULT_QOS)
    node.create_subscription(String, "heard", lambda _message: None, DEFAULT_QOS)
    writer = BagWriter(tmp_path / "bag")
    selection = TopicSelection(pattern="heard")
    recorder = Recorder(graph.create_node("recorder"), selection, writer, without_subscriptions=False)
    assert list(writer.topics) == ["/heard"]
    recorder.close()


async def test_service_events_are_recorded_and_played(graph: Graph, clock: JumpClock, tmp_path: Path) -> None:
    node = graph.create_node("server")
    service = node.create_service("example_interfaces/srv/AddTwoInts", "sum", lambda _request, response: response)
    service.configure_introspection(node.get_clock(), DEFAULT_QOS, ServiceIntrospectionState.CONTENTS)
    selection = TopicSelection(all_services=True)
    recorder = Recorder(graph.create_node("recorder"), selection, BagWriter(tmp_path / "bag"))
    client = graph.create_node("user").create_client("example_interfaces/srv/AddTwoInts", "sum")
    client.call_async(client.srv_type.Request(a=2, b=3))
    await clock.advance(0.1)
    recorder.close()
    service.destroy()
    events = []
    node.create_subscription(service.srv_type.Event, "sum/_service_event", events.append, DEFAULT_QOS)
    with BagReader(tmp_path / "bag") as bag:
        Player(graph.create_node("player"), bag, PlayOptions()).start()
        await clock.advance(1)
    assert [event.info.event_type for event in events] == [1, 2]
    assert (events[0].request[0].a, events[0].request[0].b) == (2, 3)


def write_recording(folder: Path, times: list[float]) -> BagReader:
    """Write a recording of one message at each of these times, in seconds after its start."""
    with BagWriter(folder / "bag") as writer:
        writer.add_topic("/chatter", "std_msgs/msg/String", [DEFAULT_QOS])
        for number, seconds in enumerate(times):
            writer.write("/chatter", round(seconds * SECOND_NS) + SECOND_NS, serialize(String(data=str(number))))
    return BagReader(folder / "bag")


class ChatterRecorder:
    """A subscription that records the messages of ``/chatter`` and their times in seconds."""

    def __init__(self, graph: Graph, clock: JumpClock, topic: str = "chatter") -> None:
        self.heard: list[tuple[float, str]] = []
        self._clock = clock
        graph.create_node("listener").create_subscription(String, topic, self._hear, DEFAULT_QOS)

    def _hear(self, message: String) -> None:
        self.heard.append((round(self._clock.steady_ns() / SECOND_NS, 3), message.data))


@pytest.fixture
def player_node(graph: Graph) -> Node:
    return graph.create_node("player")


async def test_player_keeps_intervals_between_messages(
    graph: Graph, clock: JumpClock, player_node: Node, tmp_path: Path
) -> None:
    listener = ChatterRecorder(graph, clock)
    with write_recording(tmp_path, [0, 0.5, 0.5, 2]) as bag:
        player = Player(player_node, bag, PlayOptions())
        player.start()
        await clock.advance(1.9)
        assert not player.finished
        await clock.advance(0.2)
    assert listener.heard == [(0.0, "0"), (0.5, "1"), (0.5, "2"), (2.0, "3")]
    assert player.finished
    assert player.message_count == 4


async def test_player_applies_rate_delay_offset_and_duration(
    graph: Graph, clock: JumpClock, player_node: Node, tmp_path: Path
) -> None:
    listener = ChatterRecorder(graph, clock)
    with write_recording(tmp_path, [0, 1, 2, 3, 4]) as bag:
        options = PlayOptions(rate=2.0, delay=1.0, start_offset=1.0, duration=2.0)
        player = Player(player_node, bag, options)
        player.start()
        await clock.advance(10)
    assert listener.heard == [(1.0, "1"), (1.5, "2"), (2.0, "3")]


async def test_player_pause_stops_recording_time(
    graph: Graph, clock: JumpClock, player_node: Node, tmp_path: Path
) -> None:
    listener = ChatterRecorder(graph, clock)
    with write_recording(tmp_path, [0, 1, 2]) as bag:
        player = Player(player_node, bag, PlayOptions())
        player.start()
        await clock.advance(0.5)
        player.toggle_paused()
        await clock.advance(5)
        assert len(listener.heard) == 1
        player.play_next()
        await clock.advance(0)
        assert len(listener.heard) == 2
        player.toggle_paused()
        await clock.advance(5)
    assert listener.heard == [(0.0, "0"), (5.5, "1"), (6.5, "2")]


async def test_player_rate_can_change_during_playback(
    graph: Graph, clock: JumpClock, player_node: Node, tmp_path: Path
) -> None:
    listener = ChatterRecorder(graph, clock)
    with write_recording(tmp_path, [0, 1, 2, 3]) as bag:
        player = Player(player_node, bag, PlayOptions())
        player.start()
        await clock.advance(1.5)
        player.set_rate(5.0)
        await clock.advance(1)
        with pytest.raises(ValueError, match="positive"):
            player.set_rate(0)
    assert listener.heard == [(0.0, "0"), (1.0, "1"), (1.6, "2"), (1.8, "3")]


async def test_looping_player_restarts_until_closed(
    graph: Graph, clock: JumpClock, player_node: Node, tmp_path: Path
) -> None:
    listener = ChatterRecorder(graph, clock)
    with write_recording(tmp_path, [0, 1]) as bag:
        player = Player(player_node, bag, PlayOptions(loop=True, delay=0.5))
        player.start()
        await clock.advance(4)
        player.close()
        count = len(listener.heard)
        await clock.advance(10)
    assert listener.heard[:4] == [(0.5, "0"), (1.5, "1"), (2.0, "0"), (3.0, "1")]
    assert len(listener.heard) == count


async def test_player_publishes_recording_time_on_clock(
    graph: Graph, clock: JumpClock, player_node: Node, tmp_path: Path
) -> None:
    clocks: list[int] = []
    graph.create_node("watch").create_subscription(
        get_message("rosgraph_msgs/msg/Clock"), "/clock", lambda message: clocks.append(message.clock.nanoseconds), 10
    )
    with write_recording(tmp_path, [0, 2]) as bag:
        Player(player_node, bag, PlayOptions(clock_hz=4, rate=2)).start()
        await clock.advance(1)
    assert clocks == [SECOND_NS * 3 // 2, SECOND_NS * 2, SECOND_NS * 5 // 2, SECOND_NS * 3]


async def test_unknown_topic_is_reported_before_playing(player_node: Node, tmp_path: Path) -> None:
    with write_recording(tmp_path, [0]) as bag, pytest.raises(LinkwrightError, match="'/chater'"):
        Player(player_node, bag, PlayOptions(topics=["/chater"]))


PROBE = "float64 depth\nsoil_msgs/Sample[] samples\nstd_msgs/Header header\n"
SAMPLE = "uint8 CLAY=1\nuint8 kind\nstring<=20 label\n"


def record_of_a_foreign_type(path: Path, package: str, storage: StoragePlugin, **texts: str) -> None:
    """Write a recording of a type that no package here has, as another program does."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    for name, text in texts.items():
        store.register(get_types_from_msg(text.replace("soil_msgs", package), f"{package}/msg/{name}"))
    probe, sample = store.types[f"{package}/msg/Probe"], store.types[f"{package}/msg/Sample"]
    header, stamp = store.types["std_msgs/msg/Header"], store.types["builtin_interfaces/msg/Time"]
    with Writer(path, version=9, storage_plugin=storage) as writer:
        connection = writer.add_connection("/probe", probe.__msgtype__, typestore=store)
        for number in range(3):
            samples = [sample(kind=1, label="topsoil")] * number
            message = probe(depth=number / 2, samples=samples, header=header(stamp(sec=number, nanosec=0), "drill"))
            data = store.serialize_cdr(message, probe.__msgtype__)
            writer.write(connection, SECOND_NS * (number + 1), data)


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
async def test_unknown_type_is_played_with_definition_from_recording(
    graph: Graph, clock: JumpClock, player_node: Node, tmp_path: Path, storage: StoragePlugin
) -> None:
    package = f"soil_{storage.name.lower()}_msgs"
    record_of_a_foreign_type(tmp_path / "bag", package, storage, Sample=SAMPLE, Probe=PROBE)
    with pytest.raises(LinkwrightError, match="there is no message"):
        get_message(f"{package}/msg/Probe")
    events: list[tuple[float, list[str], str]] = []
    with BagReader(tmp_path / "bag") as bag:
        probe = get_message(f"{package}/msg/Probe")
        graph.create_node("listener").create_subscription(
            probe,
            "/probe",
            lambda message: events.append(
                (message.depth, [sample.label for sample in message.samples], message.header.frame_id)
            ),
            10,
        )
        player = Player(player_node, bag, PlayOptions())
        player.start()
        await clock.advance(3)
    assert events == [(0.0, [], "drill"), (0.5, ["topsoil"], "drill"), (1.0, ["topsoil", "topsoil"], "drill")]
    assert get_message(f"{package}/msg/Sample").CLAY == 1
    store = get_typestore(Stores.ROS2_HUMBLE)
    for name, text in (("Sample", SAMPLE), ("Probe", PROBE)):
        store.register(get_types_from_msg(text.replace("soil_msgs", package), f"{package}/msg/{name}"))
    assert type_hash(probe) == store.hash_rihs01(f"{package}/msg/Probe")


async def test_malformed_definition_is_reported_and_other_topics_play(
    graph: Graph, clock: JumpClock, player_node: Node, tmp_path: Path, log: list[LogRecord]
) -> None:
    record_of_a_foreign_type(tmp_path / "bag", "mud_msgs", StoragePlugin.MCAP, Sample=SAMPLE, Probe=PROBE)
    file = next((tmp_path / "bag").glob("*.mcap"))
    file.write_bytes(file.read_bytes().replace(b"float64 depth", b"flaot64 depth"))
    listener = ChatterRecorder(graph, clock, "/probe")
    with BagReader(file) as bag:
        player = Player(player_node, bag, PlayOptions())
        player.start()
        await clock.advance(3)
    assert listener.heard == []
    (warning,) = [record.text for record in log if record.node == "player"]
    assert warning.startswith("Topic '/probe' is not played: ")
    assert f"{file.name}/mud_msgs/msg/Probe.msg:1:1: there is no type 'flaot64'" in warning


async def test_player_excludes_given_topics(graph: Graph, clock: JumpClock, player_node: Node, tmp_path: Path) -> None:
    with write_recording(tmp_path, [0]) as bag:
        player = Player(player_node, bag, PlayOptions(excluded_topics=["/chatter"]))
        player.start()
        await clock.advance(1)
    assert player.finished
    assert player.publishers == ()


async def test_player_selects_topics_by_regular_expression(
    graph: Graph, clock: JumpClock, player_node: Node, tmp_path: Path
) -> None:
    with write_recording(tmp_path, [0]) as bag:
        for options in (PlayOptions(pattern="^/other"), PlayOptions(without_pattern="chat")):
            assert Player(player_node, bag, options).publishers == ()
        assert [publisher.name for publisher in Player(player_node, bag, PlayOptions(pattern="chat")).publishers] == [
            "/chatter"
        ]


async def test_player_stops_at_given_time(graph: Graph, clock: JumpClock, player_node: Node, tmp_path: Path) -> None:
    listener = ChatterRecorder(graph, clock)
    with write_recording(tmp_path, [0, 1, 2]) as bag:
        player = Player(player_node, bag, PlayOptions(until_ns=round(2.5 * SECOND_NS), duration=9.0))
        player.start()
        await clock.advance(5)
        assert player.finished
    assert [text for _, text in listener.heard] == ["0", "1"]


@pytest.mark.parametrize("options", [PlayOptions(clock_topics=["/chatter"]), PlayOptions(clock_before_all=True)])
async def test_player_publishes_clock_before_messages(
    graph: Graph, clock: JumpClock, player_node: Node, tmp_path: Path, options: PlayOptions
) -> None:
    times = []
    graph.create_node("watcher").create_subscription(
        get_message("rosgraph_msgs/msg/Clock"), "/clock", lambda message: times.append(message.clock.sec), 10
    )
    with write_recording(tmp_path, [0, 1, 3]) as bag:
        Player(player_node, bag, options).start()
        await clock.advance(5)
    assert times == [1, 2, 4]


async def test_recorder_on_simulated_time_waits_for_first_clock(graph: Graph, clock: JumpClock, tmp_path: Path) -> None:
    node = graph.create_node("recorder", parameters={"use_sim_time": True})
    talker = graph.create_node("talker")
    talker.create_publisher(String, "chatter", DESCRIPTION_QOS).publish(String(data="kept"))
    tick = get_message("rosgraph_msgs/msg/Clock")
    ticks = talker.create_publisher(tick, "/clock", DEFAULT_QOS)
    recorder = Recorder(node, TopicSelection(all_topics=True), BagWriter(tmp_path / "bag"))
    await clock.advance(1)
    for second in (1, 2):
        message = tick()
        message.clock.sec = second
        ticks.publish(message)
        await clock.advance(1)
    recorder.close()
    with BagReader(tmp_path / "bag") as bag:
        assert [stamp for _, stamp, _ in bag.messages(["/chatter"])] == [1_000_000_000]
