"""Playback of a recording at any time, on a clock that the test moves."""

from __future__ import annotations

import asyncio
import struct
from collections.abc import AsyncIterator, Iterable
from pathlib import Path
from typing import Any

import pytest

from linkwright.bag import STORAGES, BagReader, BagWriter, Playback, PublishedRecording
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import DEFAULT_QOS, DESCRIPTION_QOS, Graph, JumpClock, LogRecord, QoSProfile
from linkwright.messages import String, deserialize, get_message, serialize

START_NS = 1_700_000_000_000_000_000
SECOND_NS = 1_000_000_000
STRING, TF = "std_msgs/msg/String", "tf2_msgs/msg/TFMessage"


def string_text(data: str) -> bytes:
    return serialize(String(data=data))


def make_transform(child: str) -> bytes:
    message = get_message(TF)()
    stamped_transform = get_message("geometry_msgs/msg/TransformStamped")()
    stamped_transform.child_frame_id = child
    message.transforms = [stamped_transform]
    return serialize(message)


def write_recording(folder: Path, storage: str = "mcap", *, compressed: bool = False, chunk: int = 3) -> Path:
    """Write a recording of 20 s.

    ``/a`` has a message each second, ``/b`` each fourth, ``/tf`` twice a second, and ``/tf_static`` at 0 and 9 s.
    """
    path = folder / "bag"
    with BagWriter(path, storage, compression="storage" if compressed else "none") as writer:
        for name, kind, qos in (
            ("/a", STRING, DEFAULT_QOS),
            ("/b", STRING, DEFAULT_QOS),
            ("/robot_description", STRING, DESCRIPTION_QOS),
            ("/tf", TF, DEFAULT_QOS),
            ("/tf_static", TF, DEFAULT_QOS),
        ):
            writer.add_topic(name, kind, [qos])
        writer.write("/robot_description", START_NS, string_text("<robot/>"))
        for half in range(40):
            stamp = START_NS + half * SECOND_NS // 2
            if half in (0, 18):
                writer.write("/tf_static", stamp, make_transform(f"static {half}"))
            writer.write("/tf", stamp, make_transform(f"moving {half}"))
            if half % 2 == 0:
                writer.write("/a", stamp, string_text(f"a {half // 2}"))
            if half % 8 == 0:
                writer.write("/b", stamp, string_text(f"b {half // 2}"))
            if half % chunk == 0:
                writer.flush()
    return path


def message_words(messages: Iterable[tuple[str, int, bytes]]) -> list[str]:
    return [
        deserialize(data, String).data
        if topic in ("/a", "/b", "/robot_description")
        else deserialize(data, get_message(TF)).transforms[0].child_frame_id
        for topic, _, data in messages
    ]


TOPICS = ("/a", "/b", "/robot_description", "/tf", "/tf_static")


@pytest.mark.parametrize(("storage", "compressed"), [("mcap", False), ("mcap", True), ("sqlite3", False)])
def test_state_at_returns_last_message_of_each_topic_and_transforms(
    tmp_path: Path, storage: str, compressed: bool
) -> None:
    with BagReader(write_recording(tmp_path, storage, compressed=compressed)) as bag:
        time_ns = START_NS + 7 * SECOND_NS + 1
        assert message_words(bag.state_at(TOPICS, time_ns)) == [
            "static 0", "<robot/>", "b 4", "moving 11", "moving 12", "moving 13", "moving 14", "a 7",
        ]  # fmt: skip
        assert message_words(bag.state_at(["/tf_static", "/a"], START_NS + 12 * SECOND_NS)) == [
            "static 0",
            "static 18",
            "a 12",
        ]
        assert bag.state_at(["/a"], START_NS - 1) == []
        assert bag.time_before(["/a", "/b"], START_NS + 5 * SECOND_NS) == START_NS + 4 * SECOND_NS
        assert bag.time_before(["/a"], START_NS) is None


def without_index(data: bytes, *, message_indexes: bool) -> bytes:
    """Return a finished MCAP file without its summary, and without message indexes on request."""
    records, place = bytearray(data[:8]), 8
    while True:
        kind, length = struct.unpack_from("<BQ", data, place)
        end = place + 9 + length
        if kind == 0x0F:  # the record DataEnd
            break
        if kind != 0x07 or message_indexes:
            records += data[place:end]
        place = end
    return bytes(records) + struct.pack("<BQI", 0x0F, 4, 0) + struct.pack("<BQ", 0x02, 20) + bytes(20) + data[:8]


@pytest.mark.parametrize("compressed", [False, True])
@pytest.mark.parametrize("way", ["cut off", "without a summary", "without any index"])
def test_bag_reader_indexes_mcap_without_index(tmp_path: Path, way: str, compressed: bool) -> None:
    folder = write_recording(tmp_path, chunk=3, compressed=compressed)
    (file,) = folder.glob("*.mcap")
    with BagReader(file) as bag:
        messages = list(bag.messages())
        time_ns = START_NS + 7 * SECOND_NS + 1
        state, counts = bag.state_at(TOPICS, time_ns), bag.counts(4)
    unindexed = tmp_path / "bare.mcap"
    data = file.read_bytes()
    unindexed.write_bytes(
        data[:-20] if way == "cut off" else without_index(data, message_indexes=way != "without any index")
    )
    with BagReader(unindexed) as bag:
        assert bool(bag.findings) == (way == "cut off")
        assert list(bag.messages()) == messages
        assert bag.state_at(TOPICS, time_ns) == state
        assert bag.counts(4) == counts
        assert {topic.name: topic.count for topic in bag.topics} == {name: sum(row) for name, row in counts.items()}


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_message_counts_per_interval_are_returned(tmp_path: Path, storage: str) -> None:
    with BagReader(write_recording(tmp_path, storage, chunk=1)) as bag:
        counts = bag.counts(2)
    assert counts["/a"] == [10, 10]
    assert counts["/robot_description"] == [1, 0]


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_state_at_matches_reading_all_messages(tmp_path: Path, storage: str) -> None:
    """Compare the state at many times with a reading of all messages.

    The times are also before and after all messages, in long pauses, and at equal times of several messages.
    """
    stamps = [0, 1, 1, 5, 9_000, 9_001, 9_001, 500_000_000, 500_000_001, 7 * SECOND_NS, 90 * SECOND_NS]
    topics = ("/a", "/b", "/tf", "/tf_static")
    with BagWriter(tmp_path / "bag", storage) as writer:
        for name in topics:
            writer.add_topic(name, TF if "tf" in name else STRING, [DEFAULT_QOS])
        for number, stamp in enumerate(stamps):
            for topic in topics[: 1 + number % 4]:
                writer.write(
                    topic, START_NS + stamp, make_transform(f"{number}") if "tf" in topic else string_text(f"{number}")
                )
    with BagReader(tmp_path / "bag") as bag:
        messages = list(bag.messages())
        for time_ns in sorted({START_NS + stamp + step for stamp in stamps for step in (-1, 0, 1)}):
            before = [message for message in messages if message[1] <= time_ns]
            transforms = [message for message in before if message[0] == "/tf"]
            since = min(
                time_ns, transforms[-1][1] if transforms and transforms[-1][1] < time_ns - 2 * SECOND_NS else time_ns
            )
            moving = [transform for transform in transforms if transform[1] >= since - 2 * SECOND_NS]
            last = [[message for message in before if message[0] == topic][-1:] for topic in ("/a", "/b")]
            static = [message for message in before if message[0] == "/tf_static"]
            assert sorted(bag.state_at(topics, time_ns)) == sorted([*static, *moving, *last[0], *last[1]])
            assert bag.time_before(topics, time_ns) == max(
                (message[1] for message in messages if message[1] < time_ns), default=None
            )


class PlayedRecording:
    """A graph that plays a recording, and a node that subscribes to its topics."""

    def __init__(self, path: Path) -> None:
        self.log: list[LogRecord] = []
        self.clock = JumpClock(0)
        self.graph = Graph(clock=self.clock, on_log=self.log.append)
        self.bag = BagReader(path)
        player = self.graph.create_node("player")
        self.output = PublishedRecording(player, self.bag)
        self.failures: list[LinkwrightError] = []
        self.playback = Playback(player.handle, self.bag, self.output, self.failures.append)
        self.heard: list[str] = []
        self.listener = self.graph.create_node("listener")
        self.times: list[int] = []
        self.listener.create_subscription("rosgraph_msgs/msg/Clock", "/clock", self._tick, QoSProfile(depth=1000))
        self.playback.on_reset = lambda: self.heard.append("reset")

    def listen(self, topic: str) -> None:
        self.listener.create_subscription(String, topic, lambda message: self.heard.append(message.data), 100)
        self.playback.update_subscribed_topics()

    def _tick(self, message: Any) -> None:
        stamp = message.clock
        self.times.append(stamp.sec * SECOND_NS + stamp.nanosec - START_NS)

    async def settle(self) -> None:
        for _ in range(4):  # a seek takes a few turns of the loop
            await asyncio.sleep(0)
        await self.graph.settle()

    async def take_heard(self) -> list[str]:
        await self.settle()
        heard, self.heard = self.heard, []
        return heard


@pytest.fixture
async def recording(tmp_path: Path, request: pytest.FixtureRequest) -> AsyncIterator[PlayedRecording]:
    recording = PlayedRecording(write_recording(tmp_path, getattr(request, "param", "mcap")))
    yield recording
    recording.playback.close()
    recording.bag.close()
    await recording.graph.close()


@pytest.mark.parametrize("recording", STORAGES, indirect=True)
async def test_playback_publishes_subscribed_topics_and_clock(recording: PlayedRecording) -> None:
    recording.listen("/a")
    assert await recording.take_heard() == ["a 0"]
    recording.playback.play()
    await recording.clock.advance(2.5)
    assert await recording.take_heard() == ["a 1", "a 2"]
    assert recording.times == sorted(recording.times)
    assert 2.4 * SECOND_NS < recording.times[-1] <= 2.5 * SECOND_NS
    recording.listen("/b")
    assert await recording.take_heard() == ["b 0"], "a late subscription receives the last message"
    recording.playback.set_speed(2)
    await recording.clock.advance(1.0)
    assert await recording.take_heard() == ["a 3", "a 4", "b 4"]
    recording.playback.pause()
    await recording.clock.advance(5.0)
    assert await recording.take_heard() == []


async def test_seek_resets_listeners_before_publishing_state(recording: PlayedRecording) -> None:
    recording.listen("/a")
    recording.listen("/b")
    await recording.take_heard()
    recording.playback.seek(START_NS + 3 * SECOND_NS)
    recording.playback.seek(START_NS + 10 * SECOND_NS + 5)
    assert await recording.take_heard() == ["reset", "b 8", "a 10"], "only the last of several seeks is executed"
    assert recording.playback.position_ns == START_NS + 10 * SECOND_NS + 5
    recording.playback.seek(START_NS + 2 * SECOND_NS)
    assert await recording.take_heard() == ["reset", "b 0", "a 2"]
    assert recording.times[-1] == 2 * SECOND_NS
    recording.playback.play()
    await recording.clock.advance(1.1)
    assert await recording.take_heard() == ["a 3"]


async def test_step_moves_between_messages_of_subscribed_topics(recording: PlayedRecording) -> None:
    recording.listen("/b")
    await recording.take_heard()
    recording.playback.step(forward=True)
    recording.playback.step(forward=True)
    assert await recording.take_heard() == ["b 4", "b 8"]
    assert recording.playback.position_ns == START_NS + 8 * SECOND_NS
    recording.playback.step(forward=False)
    assert await recording.take_heard() == ["reset", "b 4"]
    recording.playback.seek(START_NS)
    await recording.take_heard()
    recording.playback.step(forward=False)
    assert await recording.take_heard() == []


async def test_step_by_topic_publishes_messages_between(recording: PlayedRecording) -> None:
    recording.listen("/a")
    await recording.take_heard()
    recording.playback.step(True, "/b")
    assert await recording.take_heard() == ["a 1", "a 2", "a 3", "a 4"], "messages of other topics are published too"
    assert recording.playback.position_ns == START_NS + 4 * SECOND_NS
    recording.playback.step(False, "/tf_static")
    assert await recording.take_heard() == ["reset", "a 0"]
    recording.playback.seek(START_NS + 19 * SECOND_NS)
    await recording.take_heard()
    recording.playback.step(True, "/b")
    assert await recording.take_heard() == [], "there is no later message of the topic"
    assert recording.playback.position_ns == START_NS + 19 * SECOND_NS


async def test_step_over_too_many_messages_becomes_seek(
    recording: PlayedRecording, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("linkwright.bag.playback._MAX_TICK_MESSAGES", 2)
    recording.listen("/a")
    await recording.take_heard()
    recording.playback.step(True, "/b")
    assert (await recording.take_heard())[-2:] == ["reset", "a 4"]
    assert recording.playback.position_ns == START_NS + 4 * SECOND_NS


async def test_step_back_without_subscriptions_keeps_position(recording: PlayedRecording) -> None:
    recording.playback.seek(START_NS + 8 * SECOND_NS)
    await recording.settle()
    recording.playback.step(forward=False)
    await recording.settle()
    assert recording.playback.position_ns == START_NS + 8 * SECOND_NS


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_state_at_keeps_transforms_from_before_a_pause(tmp_path: Path, storage: str) -> None:
    """There is one transform a minute. Between two transforms, the robot has its last pose."""
    with BagWriter(tmp_path / "bag", storage) as writer:
        writer.add_topic("/tf", TF, [DEFAULT_QOS])
        for stamp in (0, 59, 60, 180):
            writer.write("/tf", START_NS + stamp * SECOND_NS, make_transform(f"{stamp}"))
    with BagReader(tmp_path / "bag") as bag:
        for time_ns, stamps in ((0, [0]), (40, [0]), (60, [59, 60]), (100, [59, 60]), (179, [59, 60]), (181, [180])):
            assert [message[1] for message in bag.state_at(["/tf"], START_NS + time_ns * SECOND_NS)] == [
                START_NS + stamp * SECOND_NS for stamp in stamps
            ]


def test_empty_recording_is_reported(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "bag") as writer:
        writer.add_topic("/tf", TF, [DEFAULT_QOS])
    with BagReader(tmp_path / "bag") as bag:
        assert [finding.code for finding in bag.findings] == ["BAG113"]


async def test_playback_stops_at_end_or_loops(recording: PlayedRecording) -> None:
    recording.listen("/b")
    recording.playback.seek(START_NS + 19 * SECOND_NS)
    await recording.take_heard()
    recording.playback.play()
    await recording.clock.advance(2.0)
    assert not recording.playback.playing
    assert recording.playback.position_ns == recording.playback.end_ns
    recording.playback.set_loop(True)
    recording.playback.play()
    await recording.clock.advance(0.1)
    assert (await recording.take_heard())[:2] == ["reset", "b 0"]
    assert recording.playback.playing
    await recording.clock.advance(20.0)
    assert recording.playback.position_ns < START_NS + 2 * SECOND_NS, "playback has started again from the beginning"


async def test_playback_slows_down_when_messages_exceed_tick_limit(tmp_path: Path) -> None:
    path = tmp_path / "dense"
    with BagWriter(path) as writer:
        writer.add_topic("/a", STRING, [DEFAULT_QOS])
        for number in range(5000):
            writer.write("/a", START_NS + number * 1000, string_text(str(number)))
    recording = PlayedRecording(path)
    recording.listen("/a")
    await recording.take_heard()
    recording.playback.play()
    await recording.clock.advance(0.017)
    assert recording.playback.position_ns == START_NS + 1001 * 1000 - 1
    await recording.clock.advance(0.1)
    assert recording.playback.position_ns == START_NS + 4999 * 1000
    recording.playback.close()
    recording.bag.close()
    await recording.graph.close()


async def test_damaged_chunk_pauses_playback_and_is_reported(tmp_path: Path) -> None:
    path = write_recording(tmp_path, compressed=True)
    (file,) = path.glob("*.mcap")
    magic = b"\x28\xb5\x2f\xfd"  # starts each zstd frame
    first, rest = file.read_bytes().split(magic, 1)
    file.write_bytes(first + magic + rest.replace(magic, b"zstd"))
    recording = PlayedRecording(path)
    recording.listen("/a")
    recording.failures.clear()
    recording.playback.play()
    recording.playback.seek(START_NS + 12 * SECOND_NS)
    await recording.settle()
    assert [failure.diagnostics[0].code for failure in recording.failures] == ["BAG102"]
    assert not recording.playback.playing
    recording.playback.close()
    recording.bag.close()
    await recording.graph.close()
