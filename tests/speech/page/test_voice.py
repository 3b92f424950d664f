"""The sound of pages' microphones on topics, and the conversation in pages."""

from __future__ import annotations

import struct
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import numpy as np
import pytest

from linkwright.graph import DurabilityPolicy, QoSProfile
from linkwright.page.protocol.voice import MAX_LOST_SAMPLES, unpack_sound
from linkwright.speech.page import floor
from tests.viewer.scene import Client, World, open_page, open_world
from tests.waiting import eventually

BLOCK = np.arange(1600, dtype=np.int16)
LATCHED = QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
AUDIO = ("/audio/audio", "/audio/audio_stamped", "/audio/audio_info")


def frame(samples: np.ndarray, *, message_kind: int = 5, count: int | None = None, lost_samples: int = 0) -> bytes:
    header = struct.pack("<IIII", message_kind, samples.size if count is None else count, lost_samples, 0)
    return header + samples.astype("<i2").tobytes()


class SoundRecorder:
    """A node that records the topics of sound, and publishes the conversation's topics."""

    def __init__(self, world: World) -> None:
        self.world = world
        self.node = world.graph.create_node("ears")
        self.blocks: list[list[int]] = []
        self.stamps: list[float] = []
        self.button_states: list[bool] = []
        self.commands: list[str] = []
        self.node.create_subscription(
            "audio_common_msgs/msg/AudioDataStamped", "/audio/audio_stamped", self._on_sound, 100
        )
        self.node.create_subscription(
            "std_msgs/msg/Bool", "/voice/listen", lambda m: self.button_states.append(m.data), 100
        )
        self.node.create_subscription(
            "std_msgs/msg/String", "/voice/text_input", lambda m: self.commands.append(m.data), 100
        )

    def _on_sound(self, message) -> None:
        assert message.header.stamp.sec > 0
        self.stamps.append(message.header.stamp.sec + message.header.stamp.nanosec * 1e-9)
        self.blocks.append(np.frombuffer(bytes(message.audio.data), "<i2").tolist())

    def publish_text(self, topic: str, text: str) -> None:
        publisher = self.node.create_publisher("std_msgs/msg/String", topic, 10)
        publisher.publish(publisher.msg_type(data=text))


@asynccontextmanager
async def sound_session() -> AsyncIterator[tuple[World, Client, SoundRecorder]]:
    async with open_world() as world, open_page(world.viewer) as client:
        await client.opened()
        yield world, client, SoundRecorder(world)


def publishers(world: World) -> list[int]:
    return [world.graph.count_publishers(topic) for topic in (*AUDIO, "/voice/listen")]


@pytest.mark.parametrize(("topic", "present"), [("/voice/command", True), ("/voice/response", False)])
async def test_voice_requires_node_that_understands_commands(topic, present):
    async with open_world() as world:
        world.graph.create_node("other").create_publisher("std_msgs/msg/String", topic, 10)
        async with open_page(world.viewer) as client:
            await client.send("watch_voice", watched=True)
            assert (await client.until("voice_node"))["present"] is present


async def test_sound_is_published_while_button_is_held():
    async with sound_session() as (world, client, ears):
        await client.send("talk", mode="ready")
        await client.socket.send_bytes(frame(BLOCK))
        await client.send("talk", mode="held")
        await client.socket.send_bytes(frame(BLOCK))
        await client.socket.send_bytes(frame(BLOCK[:30]))
        await client.send("talk", mode="ready")
        await client.socket.send_bytes(frame(BLOCK))
        await eventually(lambda: ears.button_states == [True, False])
        await world.settle()
        assert ears.blocks == [BLOCK.tolist(), BLOCK[:30].tolist()]


async def test_stamps_skip_samples_lost_by_browser():
    async with sound_session() as (_, client, ears):
        await client.send("talk", mode="held")
        for lost_samples in (0, 0, 4000, 0):
            await client.socket.send_bytes(frame(BLOCK, lost_samples=lost_samples))
        await eventually(lambda: len(ears.stamps) == 4)
        assert np.diff(ears.stamps) == pytest.approx([0.1, 0.35, 0.1], abs=0.002)


async def test_sound_topics_exist_while_microphone_is_open():
    async with sound_session() as (world, client, _):
        await client.send("watch_voice", watched=True)
        await client.until("voice_state", talking="nobody")
        assert publishers(world) == [0, 0, 0, 0]
        await client.send("talk", mode="ready")
        await eventually(lambda: publishers(world) == [1, 1, 1, 1])
        infos: list = []
        world.graph.create_node("late").create_subscription(
            "audio_common_msgs/msg/AudioInfo",
            "/audio/audio_info",
            infos.append,
            QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL),
        )
        await eventually(lambda: len(infos) == 1)
        assert (infos[0].channels, infos[0].sample_rate, infos[0].sample_format) == (1, 16000, "S16LE")
        assert (infos[0].bitrate, infos[0].coding_format) == (256, "wave")
        await client.send("talk", mode="off")
        await eventually(lambda: publishers(world) == [0, 0, 0, 0])


async def test_closed_page_releases_button():
    async with open_world() as world:
        ears = SoundRecorder(world)
        async with open_page(world.viewer) as client:
            await client.opened()
            await client.send("talk", mode="held")
            await eventually(lambda: ears.button_states == [True])
        await eventually(lambda: ears.button_states == [True, False])
        assert publishers(world) == [0, 0, 0, 0]


async def test_late_subscriber_gets_button_state():
    async with sound_session() as (world, client, ears):
        await client.send("talk", mode="held")
        await eventually(lambda: ears.button_states == [True])
        late_recorder = SoundRecorder(world)
        await eventually(lambda: late_recorder.button_states == [True])
        await client.send("talk", mode="ready")
        await eventually(lambda: late_recorder.button_states == [True, False])
        assert ears.button_states == [True, True, False]


async def test_page_that_holds_button_talks():
    async with sound_session() as (world, first, ears), open_page(world.viewer) as second:
        for client in (first, second):
            await client.send("watch_voice", watched=True)
            await client.until("voice_state", talking="nobody")
        await first.send("talk", mode="open")
        await second.until("voice_state", talking="another")
        await second.send("talk", mode="held")
        await first.until("voice_state", talking="another")
        await second.until("voice_state", talking="you")
        await first.socket.send_bytes(frame(BLOCK[:5]))
        await second.socket.send_bytes(frame(BLOCK[:7]))
        await eventually(lambda: len(ears.blocks) == 1)
        await second.send("talk", mode="off")
        await first.until("voice_state", talking="you")
        await first.socket.send_bytes(frame(BLOCK[:9]))
        await eventually(lambda: len(ears.blocks) == 2)
        assert [len(block) for block in ears.blocks] == [7, 9]
        assert ears.button_states == [True, False]


async def test_second_page_waits_for_button():
    async with sound_session() as (world, first, ears), open_page(world.viewer) as second:
        await second.send("watch_voice", watched=True)
        await first.send("talk", mode="held")
        await second.until("voice_state", talking="another")
        await second.send("talk", mode="held")
        await second.socket.send_bytes(frame(BLOCK))
        await first.send("talk", mode="ready")
        await second.until("voice_state", talking="you")
        await world.settle()
        assert ears.button_states == [True, False, True]
        assert ears.blocks == []


async def test_flooding_page_is_cut_off_until_next_press(monkeypatch):
    monkeypatch.setattr(floor, "_RESERVE_S", 0.05)
    async with sound_session() as (_, client, ears):
        await client.send("watch_voice", watched=True)
        await client.send("talk", mode="held")
        await client.until("voice_state", talking="you")
        await client.socket.send_bytes(frame(BLOCK))
        await client.until("voice_state", talking="nobody", cut=True)
        await eventually(lambda: ears.button_states == [True, False])
        assert ears.blocks == []
        await client.send("talk", mode="held")
        await client.until("voice_state", talking="you", cut=False)


def test_sound_budget_grows_with_time():
    time = 0.0
    budget = floor.SoundBudget(lambda: time)
    for _ in range(10_000):
        time += 0.1
        assert budget.spend(0.1, 0.1)  # the sound is all silence, as on a very busy machine
    assert all(budget.spend(0.1, 0.0) for _ in range(99))
    assert not budget.spend(0.2, 0.0)


async def test_page_reporting_impossible_loss_is_cut_off():
    async with sound_session() as (_, client, ears):
        await client.send("watch_voice", watched=True)
        await client.send("talk", mode="held")
        for lost_samples in (0, MAX_LOST_SAMPLES, MAX_LOST_SAMPLES, MAX_LOST_SAMPLES):
            await client.socket.send_bytes(frame(BLOCK, lost_samples=lost_samples))
        await client.until("voice_state", talking="nobody", cut=True)
        await eventually(lambda: ears.button_states == [True, False])
        assert len(ears.stamps) == 3
        assert max(ears.stamps) - ears.stamps[0] < 3.0


async def test_page_reporting_excessive_loss_is_closed():
    async with sound_session() as (_, client, ears):
        await client.send("talk", mode="held")
        await client.socket.send_bytes(frame(BLOCK, lost_samples=MAX_LOST_SAMPLES + 1))
        with pytest.raises(ConnectionError):
            await client.until("nothing of this kind")
        assert client.socket.close_code == 1003
        assert ears.stamps == []


async def test_pages_receive_conversation():
    async with sound_session() as (world, client, ears):
        await client.send("watch_voice", watched=True)
        await client.until("voice_state")
        for topic in ("partial_text", "text", "command", "response"):
            name = topic.removesuffix("_text")
            ears.publish_text(f"/voice/{topic}", f"turn left: {name}")
            assert (await client.until("conversation_text", part=name))["text"] == f"turn left: {name}"
        await client.send("watch_voice", watched=False)
        await eventually(lambda: world.graph.count_subscribers("/voice/text") == 0)


async def test_text_commands_are_published_and_subscribers_counted():
    async with sound_session() as (world, client, ears):
        await client.send("watch_voice", watched=True)
        await client.until("voice_state", sound_listeners=1, text_listeners=1)
        await client.send("say_command", text="前进")
        await eventually(lambda: ears.commands == ["前进"])
        ears.node.destroy_node()
        await client.until("voice_state", sound_listeners=0, text_listeners=0)
        await client.send("watch_voice", watched=False)
        await eventually(lambda: world.graph.count_publishers("/voice/text_input") == 0)


async def test_enrolling_proposal_is_withdrawn_with_its_node():
    async with sound_session() as (_, client, ears):
        await client.send("watch_voice", watched=True)
        await client.until("voice_state", proposes_enrolling=False)
        proposal = ears.node.create_publisher("std_msgs/msg/Bool", "/voice/propose_enrolling", 10)
        proposal.publish(proposal.msg_type(data=True))
        await client.until("voice_state", proposes_enrolling=True)
        ears.node.destroy_node()
        await client.until("voice_state", proposes_enrolling=False)


@pytest.mark.parametrize(
    "invalid_frame",
    [
        b"",
        b"\5",
        frame(BLOCK, message_kind=4),
        frame(BLOCK, count=1599),
        frame(BLOCK[:0]),
        frame(np.zeros(1601, np.int16)),
        frame(BLOCK, lost_samples=2**32 - 1),
    ],
)
def test_other_binary_frames_are_not_sound(invalid_frame):
    assert unpack_sound(invalid_frame) is None
