"""Publish sound on the topics of audio_common's audio_capture."""

from __future__ import annotations

from typing import Any

from linkwright.graph import LATCHED_QOS, Node, Publisher, Time
from linkwright.speech.nodes.audio_messages import (
    AUDIO,
    AUDIO_DEPTH,
    AUDIO_INFO,
    AUDIO_STAMPED,
    AudioForm,
    audio_data,
    audio_info,
    audio_stamped,
)
from linkwright.speech.nodes.sound_gaps import SampleStamps
from linkwright.speech.sound.samples import Samples

NAMESPACE = "/audio"


class AudioTopics:
    """The topics ``audio``, ``audio_stamped`` and ``audio_info`` of an audio source: mono 16-bit PCM at 16 kHz.

    Args:
        node: the node that publishes.
        namespace: the namespace of the topics.
    """

    def __init__(self, node: Node, namespace: str = NAMESPACE) -> None:
        self._node = node
        self._plain: Publisher[Any] = node.create_publisher(AUDIO, f"{namespace}/audio", AUDIO_DEPTH)
        self._stamped: Publisher[Any] = node.create_publisher(AUDIO_STAMPED, f"{namespace}/audio_stamped", AUDIO_DEPTH)
        self._info: Publisher[Any] = node.create_publisher(AUDIO_INFO, f"{namespace}/audio_info", LATCHED_QOS)
        self._info.publish(audio_info(AudioForm()))
        self._stamps = SampleStamps()

    def restart(self) -> None:
        """Start a new stream, unrelated to the previous one."""
        self._stamps.restart()

    def publish(self, samples: Samples, lost: float = 0.0) -> None:
        """Publish the next block of the stream, whose last sample was recorded now or earlier.

        Args:
            samples: the block.
            lost: seconds of sound that are missing in the block or before it.
        """
        data = samples.astype("<i2").tobytes()
        now = self._node.get_clock().now()
        began = Time(nanoseconds=self._stamps.stamp(samples.size, now.nanoseconds, lost), clock_type=now.clock_type)
        self._stamped.publish(audio_stamped(data, began.to_msg()))
        self._plain.publish(audio_data(data))

    def close(self) -> None:
        """Remove the topics."""
        for publisher in (self._plain, self._stamped, self._info):
            self._node.destroy_publisher(publisher)
