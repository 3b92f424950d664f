"""An engine that hears what a test tells it to, and a graph around a voice_commander."""

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
from linkwright.speech.nodes.audio_messages import AUDIO_STAMPED, audio_stamped
from linkwright.speech.nodes.voice_commander import VoiceCommander
from linkwright.speech.sound.samples import BLOCK
from tests.nodes.stage import Stage
from tests.waiting import eventually

STRING, BOOL = get_message("std_msgs/msg/String"), get_message("std_msgs/msg/Bool")
TWIST = get_message("geometry_msgs/msg/Twist")
ENTRY = extensions.EntryPoint("told", f"{__name__}:ToldEngine", "tests")


class ToldEngine(SpeechEngine):
    """For each block of sound it hears what `says` has for the value of its samples.

    Attributes:
        used_options: the options of the engines that were created.
        says: value of samples -> what is heard.
        says_at_end: what is heard when the sound ends.
        finished: how often the sound ended.
        trouble: why it hears nothing.
    """

    used_options: ClassVar[list[EngineOptions]] = []
    says: ClassVar[dict[int, list[Heard]]] = {}
    says_at_end: ClassVar[list[Heard]] = []
    finished: ClassVar[list[int]] = []
    trouble: ClassVar[list[Diagnostic]] = []

    def __init__(self, options: EngineOptions) -> None:
        self.used_options.append(options)

    @property
    def problem(self) -> Diagnostic | None:
        return self.trouble[0] if self.trouble else None

    def hear(self, samples: Any) -> Sequence[Heard]:
        return self.says[int(samples[0])]

    def finish(self) -> Sequence[Heard]:
        self.finished.append(1)
        return tuple(self.says_at_end)


def final(text: str, confidence: float = 1.0, start: float = 0.0, nearest: str = "") -> Heard:
    return Heard(text, confidence, True, start, start + 1.0, nearest)


def partial(text: str, start: float = 0.0) -> Heard:
    return Heard(text, 0.0, False, start, start + 0.5)


class Talk:
    """A voice_commander, who speaks to it, and what it publishes."""

    def __init__(self, stage: Stage, **parameters: Any) -> None:
        self.stage = stage
        self.velocities: list[Any] = []
        self.said: dict[str, list[str]] = {}
        node = stage.node
        node.create_subscription(TWIST, "/cmd_vel", self.velocities.append, 100)
        for name in ("text", "partial_text", "command", "response"):
            texts = self.said[name] = []
            node.create_subscription(STRING, f"/voice/{name}", lambda message, to=texts: to.append(message.data), 100)
        self.text = node.create_publisher(STRING, "/voice/text_input", 10)
        self.button = node.create_publisher(BOOL, "/voice/listen", 10)
        self.mouth = stage.graph.create_node("mouth")
        self.sound = self.mouth.create_publisher(AUDIO_STAMPED, "/audio/audio_stamped", 10)
        self.running = VoiceCommander(stage.graph, NodeOptions(parameters={"engine": "", **parameters}))

    @property
    def speed(self) -> tuple[float, float, float]:
        """What the robot was told last: x, y, and turning."""
        last = self.velocities[-1]
        return last.linear.x, last.linear.y, last.angular.z

    async def type(self, text: str) -> str:
        """Give a command as text; what is answered last."""
        self.text.publish(STRING(data=text))
        await self.stage.graph.settle()
        return self.said["response"][-1]

    async def hold(self, held: bool) -> None:
        self.button.publish(BOOL(data=held))
        await self.stage.graph.settle()

    async def say_nothing_more(self) -> None:
        """Wait until all that was heard was dealt with: press once more, and hear nothing that counts."""
        ToldEngine.says_at_end[:] = [partial("the end")]
        text = len(self.said["partial_text"])
        await self.hold(True)
        await self.hold(False)
        await eventually(lambda: len(self.said["partial_text"]) > text)
        ToldEngine.says_at_end.clear()
        await self.stage.graph.settle()

    async def say(self, *results: Heard, stamp: float | None = None) -> None:
        """Have the engine hear something, and wait until it was told; its thread takes its time.

        Args:
            heard: what it makes of a tenth of a second of sound.
            stamp: of that sound, seconds; now where it is not given.
        """
        ToldEngine.says[len(ToldEngine.says) + 1] = list(results)
        block = np.full(BLOCK, len(ToldEngine.says), np.int16)
        before = len(self.said["text"]) + len(self.said["partial_text"])
        now = self.stage.node.get_clock().now() if stamp is None else Time(nanoseconds=round(stamp * 1e9))
        self.sound.publish(audio_stamped(block.tobytes(), now.to_msg()))
        await self.stage.graph.settle()
        if results:
            result = len(results) + before
            await eventually(lambda: len(self.said["text"]) + len(self.said["partial_text"]) >= result)
        await self.stage.graph.settle()
