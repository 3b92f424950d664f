"""The sources of a topic's images: image_transport's transports, by name.

A transport other than raw has a separate topic below the image's, such as `/camera/image/compressed`. RViz derives the
transport from the last part of a topic if there is no property for it.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

from linkwright.images.compressed_depth import unpacked_depth
from linkwright.images.image_files import unpacked

RAW, COMPRESSED, COMPRESSED_DEPTH, _THEORA = "raw", "compressed", "compressedDepth", "theora"
TRANSPORTS = (RAW, COMPRESSED, COMPRESSED_DEPTH, _THEORA)
_IMAGE, _COMPRESSED_IMAGE = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"


@dataclass(frozen=True, slots=True)
class ImageSource:
    """The images of a topic in one of the transports.

    Attributes:
        base: the topic of the raw images.
        transport: the name of the transport.
        is_renamed: whether the messages are published on `base` itself, as by drivers that do not use image_transport.
    """

    base: str
    transport: str = RAW
    is_renamed: bool = False

    @classmethod
    def of(cls, topic: str, hint: str = RAW) -> ImageSource:
        """Return the source for a topic and a hint.

        A transport at the end of the topic has priority over the hint.
        """
        topic = topic.strip()
        base, slash, last = topic.rpartition("/")
        if slash and last in TRANSPORTS[1:]:
            return cls(base, last)
        return cls(topic, hint if topic and hint else RAW)

    def carrying(self, types: Collection[str]) -> ImageSource:
        """Return the source for the message types of the topic, whose name may not indicate its transport."""
        if self.transport == RAW and _COMPRESSED_IMAGE in types and _IMAGE not in types:
            return ImageSource(self.base, COMPRESSED, is_renamed=True)
        return self

    @property
    def topic(self) -> str:
        """The topic of the messages; empty if there is none."""
        return self.base if self.transport == RAW or self.is_renamed else f"{self.base}/{self.transport}"

    def transport_of(self, message: Any) -> str:
        """Return the transport of a message.

        If the topic of a CompressedImage does not name the transport, its field `format` does.
        """
        if self.is_renamed and COMPRESSED_DEPTH in message.format:
            return COMPRESSED_DEPTH
        return self.transport

    @property
    def message_type(self) -> str:
        """The type of the messages."""
        return _IMAGE if self.transport == RAW else _COMPRESSED_IMAGE

    @property
    def is_read(self) -> bool:
        """Whether images of this transport can be unpacked here."""
        return self.transport in (RAW, COMPRESSED, COMPRESSED_DEPTH)


class Unpacker:
    """Converts the messages of a transport to raw images.

    Stores the last one, which may be shown more than once.
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
            self._image = unpacked_depth(message) if transport == COMPRESSED_DEPTH else unpacked(message)
            self._message = message
        return self._image
