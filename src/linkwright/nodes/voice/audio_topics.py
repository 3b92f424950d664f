"""Publishing sound as audio_common's audio_capture does."""

from __future__ import annotations

from typing import Any

from linkwright.graph import DurabilityPolicy, Node, Publisher, QoSProfile
from linkwright.messages import get_message
from linkwright.speech.sound.samples import RATE, Samples

NAMESPACE = "/audio"
_DEPTH = 10
_BITS = 16


class AudioTopics:
    """The topics ``audio``, ``audio_stamped`` and ``audio_info`` of a source of sound.

    Sound is mono PCM of 16 bits at 16 kHz, which ``audio_info`` says once to whoever comes, format ``wave``.

    Args:
        node: who publishes.
        namespace: of the topics.
    """

    def __init__(self, node: Node, namespace: str = NAMESPACE) -> None:
        self._node = node
        self._plain: Publisher[Any] = node.create_publisher(
            "audio_common_msgs/msg/AudioData", f"{namespace}/audio", _DEPTH
        )
        self._stamped: Publisher[Any] = node.create_publisher(
            "audio_common_msgs/msg/AudioDataStamped", f"{namespace}/audio_stamped", _DEPTH
        )
        latched = QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        info = get_message("audio_common_msgs/msg/AudioInfo")
        self._info = node.create_publisher(info, f"{namespace}/audio_info", latched)
        self._info.publish(
            info(
                channels=1, sample_rate=RATE, sample_format="S16LE", bitrate=_BITS * RATE // 1000, coding_format="wave"
            )
        )

    def publish(self, samples: Samples) -> None:
        """Publish a block that ends now."""
        message = self._stamped.msg_type()
        message.header.stamp = self._node.get_clock().now().to_msg()
        message.audio.data = samples.astype("<i2").tobytes()
        self._stamped.publish(message)
        self._plain.publish(message.audio)

    def close(self) -> None:
        """Leave the topics."""
        for publisher in (self._plain, self._stamped, self._info):
            self._node.destroy_publisher(publisher)
