"""A scripted speech engine, and a harness of a voice_commander."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np

from linkwright.diagnostics import Diagnostic
from linkwright.graph import Time
from linkwright.loading import extensions
from linkwright.messages import get_message
from linkwright.nodes import NodeOptions
from linkwright.speech.engine import EngineOptions, Heard, SpeechEngine
from linkwright.speech.nodes.audio_messages import AUDIO_STAMPED_TYPE, make_audio_stamped
from linkwright.speech.nodes.voice_commander import VoiceCommander
from linkwright.speech.sound.samples import BLOCK_LENGTH
from tests.nodes.harness import NodeHarness
from tests.waiting import eventually

STRING, BOOL = get_message("std_msgs/msg/String"), get_message("std_msgs/msg/Bool")
TWIST = get_message("geometry_msgs/msg/Twist")
ENGINE_ENTRY = extensions.EntryPoint("told", f"{__name__}:ScriptedEngine", "tests")


class ScriptedEngine(SpeechEngine):
    """An engine with scripted results: the samples' value selects the results of a block.

    Attributes:
        used_options: the options of the created engines.
        results_by_value: the results for each value of samples.
        results_at_end: the results when the sound ends.
        finished: one entry for each end of the sound.
        problems: the reason for no results, if any.
    """

    used_options: ClassVar[list[EngineOptions]] = []
    results_by_value: ClassVar[dict[int, list[Heard]]] = {}
    results_at_end: ClassVar[list[Heard]] = []
    finished: ClassVar[list[int]] = []
    problems: ClassVar[list[Diagnostic]] = []

    def __init__(self, options: EngineOptions) -> None:
        self.used_options.append(options)

    @property
    def problem(self) -> Diagnostic | None:
        return self.problems[0] if self.problems else None

    def hear(self, samples: Any) -> Sequence[Heard]:
        return self.results_by_value[int(samples[0])]

    def finish(self) -> Sequence[Heard]:
        self.finished.append(1)
        return tuple(self.results_at_end)


def final_result(text: str, confidence: float = 1.0, start: float = 0.0, nearest: str = "") -> Heard:
    return Heard(text, confidence, True, start, start + 1.0, nearest)


def partial_result(text: str, start: float = 0.0) -> Heard:
    return Heard(text, 0.0, False, start, start + 0.5)


class CommanderHarness:
    """A voice_commander with publishers of its inputs, and the messages that it publishes."""

    def __init__(self, harness: NodeHarness, **parameters: Any) -> None:
        self.harness = harness
        self.velocities: list[Any] = []
        self.texts_by_topic: dict[str, list[str]] = {}
        node = harness.node
        node.create_subscription(TWIST, "/cmd_vel", self.velocities.append, 100)
        for name in ("text", "partial_text", "command", "response"):
            texts = self.texts_by_topic[name] = []
            node.create_subscription(
                STRING, f"/voice/{name}", lambda message, target=texts: target.append(message.data), 100
            )
        self.text = node.create_publisher(STRING, "/voice/text_input", 10)
        self.button = node.create_publisher(BOOL, "/voice/listen", 10)
        self.microphone_node = harness.graph.create_node("mouth")
        self.sound = self.microphone_node.create_publisher(AUDIO_STAMPED_TYPE, "/audio/audio_stamped", 10)
        self.commander = VoiceCommander(harness.graph, NodeOptions(parameters={"engine": "", **parameters}))

    @property
    def speed(self) -> tuple[float, float, float]:
        """Return the last commanded velocity: x, y, and yaw rate."""
        velocity = self.velocities[-1]
        return velocity.linear.x, velocity.linear.y, velocity.angular.z

    async def send_text(self, text: str) -> str:
        """Publish a command as text, and return the last response."""
        self.text.publish(STRING(data=text))
        await self.harness.graph.settle()
        return self.texts_by_topic["response"][-1]

    async def hold(self, is_pressed: bool) -> None:
        self.button.publish(BOOL(data=is_pressed))
        await self.harness.graph.settle()

    async def finish_results(self) -> None:
        """Press the button once more, and wait until all results are processed."""
        ScriptedEngine.results_at_end[:] = [partial_result("the end")]
        count = len(self.texts_by_topic["partial_text"])
        await self.hold(True)
        await self.hold(False)
        await eventually(lambda: len(self.texts_by_topic["partial_text"]) > count)
        ScriptedEngine.results_at_end.clear()
        await self.harness.graph.settle()

    async def process(self, *results: Heard, stamp: float | None = None) -> None:
        """Let the engine return some results for a block of sound.

        Wait until they are processed in its thread.

        Args:
            results: the engine's results for a tenth of a second of sound.
            stamp: the stamp of the sound in seconds; now by default.
        """
        ScriptedEngine.results_by_value[len(ScriptedEngine.results_by_value) + 1] = list(results)
        block = np.full(BLOCK_LENGTH, len(ScriptedEngine.results_by_value), np.int16)
        count_before = len(self.texts_by_topic["text"]) + len(self.texts_by_topic["partial_text"])
        sound_time = self.harness.node.get_clock().now() if stamp is None else Time(nanoseconds=round(stamp * 1e9))
        self.sound.publish(make_audio_stamped(block.tobytes(), sound_time.to_msg()))
        await self.harness.graph.settle()
        if results:
            expected_count = len(results) + count_before
            await eventually(
                lambda: len(self.texts_by_topic["text"]) + len(self.texts_by_topic["partial_text"]) >= expected_count
            )
        await self.harness.graph.settle()
