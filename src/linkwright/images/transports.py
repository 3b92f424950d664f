"""The sources of a topic's images, by the transports of image_transport.

A transport other than raw has its own topic below the topic of the image, such as `/camera/image/compressed`. RViz
derives the transport from the last part of a topic if there is no property for it.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

from linkwright.images.compressed_depth import decode_depth
from linkwright.images.image_files import decode_compressed

RAW, COMPRESSED, COMPRESSED_DEPTH, _THEORA = "raw", "compressed", "compressedDepth", "theora"
TRANSPORTS = (RAW, COMPRESSED, COMPRESSED_DEPTH, _THEORA)
_IMAGE, _COMPRESSED_IMAGE = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"


@dataclass(frozen=True, slots=True)
class ImageSource:
    """Images of a topic that are published with one of the transports.

    Attributes:
        base: the topic of the raw images.
        transport: the name of the transport.
        is_renamed: whether the messages are published on `base` itself, as some drivers do without image_transport.
    """

    base: str
    transport: str = RAW
    is_renamed: bool = False

    @classmethod
    def of(cls, topic: str, hint: str = RAW) -> ImageSource:
        """Return the source for a topic, with a transport as a hint.

        A transport at the end of the topic takes precedence over the hint.
        """
        topic = topic.strip()
        base, slash, suffix = topic.rpartition("/")
        if slash and suffix in TRANSPORTS[1:]:
            return cls(base, suffix)
        return cls(topic, hint if topic and hint else RAW)

    def with_types(self, types: Collection[str]) -> ImageSource:
        """Return the source with the transport that message types imply, unless the topic names it."""
        if self.transport == RAW and _COMPRESSED_IMAGE in types and _IMAGE not in types:
            return ImageSource(self.base, COMPRESSED, is_renamed=True)
        return self

    @property
    def topic(self) -> str:
        """The topic of the messages, or an empty string if no topic is set."""
        return self.base if self.transport == RAW or self.is_renamed else f"{self.base}/{self.transport}"

    def transport_of(self, message: Any) -> str:
        """Return the transport of a message.

        For a CompressedImage on a topic that does not name the transport, the field `format` decides.
        """
        if self.is_renamed and COMPRESSED_DEPTH in message.format:
            return COMPRESSED_DEPTH
        return self.transport

    @property
    def message_type(self) -> str:
        """The type of the messages."""
        return _IMAGE if self.transport == RAW else _COMPRESSED_IMAGE

    @property
    def is_supported(self) -> bool:
        """Whether Linkwright can decode images of this transport."""
        return self.transport in (RAW, COMPRESSED, COMPRESSED_DEPTH)


class Unpacker:
    """A converter of the messages of a transport to raw images.

    It keeps the latest image, so that it can be shown more than once.
    """

    def __init__(self) -> None:
        self._message: Any = None
        self._image: Any = None

    def image(self, message: Any, transport: str) -> Any:
        """Return the image of a message, with the fields of a sensor_msgs/msg/Image.

        Raises:
            BadImageError: the message cannot be unpacked.
        """
        if transport == RAW:
            return message
        if message is not self._message:
            self._message = None
            self._image = decode_depth(message) if transport == COMPRESSED_DEPTH else decode_compressed(message)
            self._message = message
        return self._image
