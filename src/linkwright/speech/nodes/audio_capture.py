"""audio_capture: publishes a WAV file or the microphone on the topics of audio_common.

Topics and parameters are those of the node in ros-drivers' audio_common: ``audio``, ``audio_stamped`` and, latched,
``audio_info``. Deliberate difference: the format is always 16 kHz, mono, S16LE, the default of that node, and never
MP3.
"""

from __future__ import annotations

from collections import deque
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.diagnostics.translation import localized
from linkwright.graph import Graph
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.speech.nodes.audio_topics import NAMESPACE, AudioTopics
from linkwright.speech.sound.microphone import Microphone
from linkwright.speech.sound.samples import BLOCK_LENGTH, RATE, Samples
from linkwright.speech.sound.wav import read_wav

_FORMAT_PARAMETERS = {"channels": 1, "depth": 16, "sample_rate": RATE, "sample_format": "S16LE", "format": "wave"}
"""The parameters of the format, with the only value that is supported for each."""

_MAX_CHUNK_SAMPLES = 10 * RATE


class AudioCapture(SingleNode):
    """The node that publishes the sound of a microphone or of a WAV file.

    Parameters:

    - ``device``: a microphone by number or part of its name.
    - ``file``: a WAV file to publish instead, paced by the node's clock. It starts when the first subscriber arrives
    and is followed by silence, or with ``loop`` by the file again.
    - ``chunk``: the number of samples in a message.

    Raises:
        LinkwrightError: VOICE401 or VOICE402, the file cannot be read; VOICE412 or VOICE413, there is no microphone;
            VOICE414, a parameter is invalid.
    """

    DEFAULT_NAME = "audio_capture_node"
    NAMESPACE: ClassVar[str] = ""
    """The namespace of the topics if the node is in the root namespace."""

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._microphone: Microphone | None = None
        with handle_start_errors(self._node):
            self._start()

    def close(self) -> None:
        """Close the microphone and the node."""
        if self._microphone is not None:
            self._microphone.close()
            self._microphone = None
        super().close()

    def _start(self) -> None:
        node = self._node
        device: str = node.declare_parameter("device", "").value
        file: str = node.declare_parameter("file", "").value
        self._loop: bool = node.declare_parameter("loop", False).value
        chunk: int = node.declare_parameter("chunk", BLOCK_LENGTH).value
        for name, value in {"src": "alsasrc", "dst": "appsink", "bitrate": 192, "diagnostic_tolerance": 0.1}.items():
            node.declare_parameter(name, value)
        self._warn_about_format()
        if not 0 < chunk <= _MAX_CHUNK_SAMPLES:
            message = phrase(
                "parameter '{name}' must be {minimum} to {maximum}, but it is {value}",
                name="chunk",
                minimum=1,
                maximum=_MAX_CHUNK_SAMPLES,
                value=chunk,
            )
            raise LinkwrightError(Diagnostic("VOICE414", message))
        sound = read_wav(Path(file).expanduser()) if file else None
        namespace = node.get_namespace().rstrip("/") or self.NAMESPACE
        self._topic_names = (f"{namespace}/audio", f"{namespace}/audio_stamped")
        self._topics = AudioTopics(node, namespace)
        if sound is None:
            self._open_microphone(device, chunk)
        else:
            self._start_playing(sound, chunk)

    def _warn_about_format(self) -> None:
        for name, supported in _FORMAT_PARAMETERS.items():
            value: Any = self._node.declare_parameter(name, supported).value
            if value != supported:
                warning = phrase(
                    "parameter '{name}' cannot be '{value}': sound is published with '{supported}'",
                    name=name,
                    supported=supported,
                    value=value,
                )
                self._node.get_logger().warning(localized(warning))

    def _open_microphone(self, device: str, chunk: int) -> None:
        pending: deque[Samples] = deque()

        def publish() -> None:
            while pending:
                self._topics.publish(pending.popleft())

        condition = self._node.create_guard_condition(publish)

        def on_samples(samples: Samples) -> None:
            pending.append(samples)
            condition.trigger()

        self._microphone = Microphone(device, chunk, on_samples)

    def _start_playing(self, sound: Samples, chunk: int) -> None:
        self._sound, self._chunk, self._position = sound, chunk, -1
        self._node.create_timer(chunk / RATE, self._publish_next)

    def _publish_next(self) -> None:
        if self._position < 0:
            if not any(map(self._node.count_subscribers, self._topic_names)):
                return
            self._position = 0
        block: Samples = self._sound[self._position : self._position + self._chunk]
        self._position += self._chunk
        if self._loop and self._position >= len(self._sound):
            self._position = 0
        if len(block) < self._chunk:
            block = np.concatenate((block, np.zeros(self._chunk - len(block), np.int16)))
        self._topics.publish(block)


class RobotAudioCapture(AudioCapture):
    """The node audio_capture for Linkwright's robots, with topics in the namespace ``/audio``."""

    DEFAULT_NAME = "audio_capture"
    NAMESPACE = NAMESPACE
