"""Where the images of a topic come from: image_transport's transports, by their names.

A transport other than raw has a topic of its own below the image's, `/camera/image/compressed`. RViz takes the name of
the transport from the end of a topic where there is no property for it.
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
    """The images of a topic as one of the transports brings them.

    Attributes:
        base: the topic of the raw images.
        transport: the name of the transport.
        is_renamed: its messages come on `base` itself, as drivers have it that use no image_transport.
    """

    base: str
    transport: str = RAW
    is_renamed: bool = False

    @classmethod
    def of(cls, topic: str, hint: str = RAW) -> ImageSource:
        """The source that a topic and a hint name; a transport at the end of the topic counts more than the hint."""
        topic = topic.strip()
        base, slash, last = topic.rpartition("/")
        if slash and last in TRANSPORTS[1:]:
            return cls(base, last)
        return cls(topic, hint if topic and hint else RAW)

    def carrying(self, types: Collection[str]) -> ImageSource:
        """The same, for a topic that carries messages of these types and is not named as those of transports are."""
        if self.transport == RAW and _COMPRESSED_IMAGE in types and _IMAGE not in types:
            return ImageSource(self.base, COMPRESSED, is_renamed=True)
        return self

    @property
    def topic(self) -> str:
        """The topic that the messages come on; empty when there is none."""
        return self.base if self.transport == RAW or self.is_renamed else f"{self.base}/{self.transport}"

    def transport_of(self, message: Any) -> str:
        """The transport of a message: `format` names it for a CompressedImage on a topic whose name does not."""
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
    """Makes raw images of the messages of a transport; remembers the last, which may be shown more than once."""

    def __init__(self) -> None:
        self._message: Any = None
        self._image: Any = None

    def image(self, message: Any, transport: str) -> Any:
        """The image of a message, with the fields of a sensor_msgs/msg/Image.

        Raises:
            BadImageError: it cannot be unpacked.
        """
        if transport == RAW:
            return message
        if message is not self._message:
            self._message = None
            self._image = unpacked_depth(message) if transport == COMPRESSED_DEPTH else unpacked(message)
            self._message = message
        return self._image
