"""The publishers for the topics of audio_common's audio_capture."""

from __future__ import annotations

from typing import Any

from linkwright.graph import LATCHED_QOS, Node, Publisher, Time
from linkwright.speech.nodes.audio_messages import (
    AUDIO_INFO_TYPE,
    AUDIO_QUEUE_DEPTH,
    AUDIO_STAMPED_TYPE,
    AUDIO_TYPE,
    AudioFormat,
    make_audio_data,
    make_audio_info,
    make_audio_stamped,
)
from linkwright.speech.nodes.sound_gaps import SampleStamps
from linkwright.speech.sound.samples import Samples

NAMESPACE = "/audio"


class AudioTopics:
    """The publishers of ``audio``, ``make_audio_stamped`` and ``make_audio_info``.

    The format is mono 16-bit PCM at 16 kHz.

    Args:
        node: the node that publishes.
        namespace: the namespace of the topics.
    """

    def __init__(self, node: Node, namespace: str = NAMESPACE) -> None:
        self._node = node
        self._data_publisher: Publisher[Any] = node.create_publisher(
            AUDIO_TYPE, f"{namespace}/audio", AUDIO_QUEUE_DEPTH
        )
        self._stamped_publisher: Publisher[Any] = node.create_publisher(
            AUDIO_STAMPED_TYPE, f"{namespace}/audio_stamped", AUDIO_QUEUE_DEPTH
        )
        self._info_publisher: Publisher[Any] = node.create_publisher(
            AUDIO_INFO_TYPE, f"{namespace}/audio_info", LATCHED_QOS
        )
        self._info_publisher.publish(make_audio_info(AudioFormat()))
        self._stamps = SampleStamps()

    def restart(self) -> None:
        """Start a new stream, whose stamps are independent of the previous stream."""
        self._stamps.restart()

    def publish(self, samples: Samples, lost: float = 0.0) -> None:
        """Publish the next block of the stream, stamped with the time of its first sample.

        Args:
            samples: the block.
            lost: the seconds of sound that are missing in the block or before it.
        """
        data = samples.astype("<i2").tobytes()
        now = self._node.get_clock().now()
        start = Time(
            nanoseconds=self._stamps.compute_stamp(samples.size, now.nanoseconds, lost), clock_type=now.clock_type
        )
        self._stamped_publisher.publish(make_audio_stamped(data, start.to_msg()))
        self._data_publisher.publish(make_audio_data(data))

    def close(self) -> None:
        """Remove the topics."""
        for publisher in (self._data_publisher, self._stamped_publisher, self._info_publisher):
            self._node.destroy_publisher(publisher)
