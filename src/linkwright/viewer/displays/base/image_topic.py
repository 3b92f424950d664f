"""What Image and Camera have in common: images of a topic, raw or compressed, as pages are sent them."""

from __future__ import annotations

from functools import partial
from typing import Any, Literal

import numpy as np

from linkwright.graph import QoSProfile
from linkwright.viewer.config.rviz_config import DisplayConfig
from linkwright.viewer.displays.base.data_display import Pose
from linkwright.viewer.displays.base.host import DisplayHost
from linkwright.viewer.displays.base.topic_display import TOPIC, TopicDisplay
from linkwright.viewer.images import (
    COMPRESSED,
    BadImageError,
    ImageCompressor,
    ImageSource,
    RangeFinder,
    Unpacker,
    encoding_of,
    has_range,
    picture_of,
)
from linkwright.viewer.protocol.images import CameraModel, ImageFrame

_ENCODINGS: dict[int, Literal["grey", "rgb", "rgba"]] = {1: "grey", 3: "rgb", 4: "rgba"}
MOST_PIXELS = 2_100_000
"""Pages are sent no more pixels of an image than Full HD has: panels are smaller, and pixels are not compressed."""


class ImageTopicDisplay(TopicDisplay):
    """Shows the images of a topic, whose transport is the one that its name ends with, as in RViz.

    Those of ``/compressed`` are files that browsers read, and go to the page as they are, unless their values have more
    than 8 bits.
    """

    MESSAGE = "sensor_msgs/msg/Image"

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self.ranges = RangeFinder()
        self._compressor = ImageCompressor()
        self._unpacker = Unpacker()

    @classmethod
    def messages_shown(cls) -> tuple[str, ...]:
        """Raw and compressed images."""
        return (cls.MESSAGE, "sensor_msgs/msg/CompressedImage")

    def subscription(self) -> tuple[str, str, QoSProfile]:
        """As the transport of the topic has it."""
        source = self._source()
        return source.message_type, source.topic, super().subscription()[2]

    def take(self, message: Any, pose: Pose | None) -> None:
        """Show an image, or say why it cannot be unpacked."""
        try:
            image = self._image_of(message)
        except BadImageError as error:
            self.say("Image", "error", str(error))
            return
        self.take_image(image, pose)

    def take_image(self, message: Any, pose: Pose | None) -> None:
        """An image to show.

        Args:
            message: with the fields of a sensor_msgs/msg/Image, or a sensor_msgs/msg/CompressedImage for browsers.
            pose: see `take`.
        """
        raise NotImplementedError

    def reset(self) -> None:
        """Forget the image."""
        self.ranges.reset()
        super().reset()

    def show_image(self, message: Any, camera: CameraModel | None = None, pose: Pose | None = None) -> None:
        """Send an image, or say why it cannot be shown."""
        try:
            content = self._frame(message, camera)
        except BadImageError as error:
            self.say("Image", "error", str(error))
            return
        self.unsay("Image")
        frame, stamp_ns = TopicDisplay.frame_of(self, message)
        shrink = partial(self._compressor.compressed, content)
        self.send(content, frame=frame.removeprefix("/"), pose=pose, stamp_ns=stamp_ns, shrink=shrink)

    def _source(self) -> ImageSource:
        return ImageSource.of(self.properties.text(TOPIC))

    def _subscribe(self) -> None:
        source = self._source()
        if source.is_read:
            super()._subscribe()
        else:
            choice = f"choose {source.base} or {source.base}/{COMPRESSED}"
            self.say(TOPIC, "error", f"Images of transport '{source.transport}' are not read: {choice}")

    def _image_of(self, message: Any) -> Any:
        transport = self._source().transport
        if transport == COMPRESSED and not has_range(encoding_of(message)):
            return message
        return self._unpacker.image(message, transport)

    def _frame(self, message: Any, camera: CameraModel | None) -> ImageFrame:
        if not hasattr(message, "encoding"):
            data = np.frombuffer(message.data, np.uint8)
            if not _is_readable(data.tobytes()[:16]):
                raise BadImageError(f"The image is in no format that browsers read: '{message.format}'")
            return ImageFrame(0, 0, 0, 0, "file", data, camera)
        picture = picture_of(message, self.ranges)
        shown = picture.thinned(MOST_PIXELS)
        return ImageFrame(
            width=picture.width,
            height=picture.height,
            columns=shown.width,
            rows=shown.height,
            encoding=_ENCODINGS[shown.channels],
            data=shown.pixels,
            camera=camera,
        )


def _is_readable(start: bytes) -> bool:
    """Whether a file begins as JPEG, PNG, GIF, BMP or WebP do."""
    return start.startswith((b"\xff\xd8\xff", b"\x89PNG", b"GIF8", b"BM")) or start[8:12] == b"WEBP"
