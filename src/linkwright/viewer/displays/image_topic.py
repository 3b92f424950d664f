"""What Image and Camera have in common: images of a topic, raw or compressed, as pages are sent them."""

from __future__ import annotations

from functools import partial
from typing import Any, Literal

import numpy as np

from linkwright.graph import QoSProfile
from linkwright.viewer.displays.base import Stage
from linkwright.viewer.displays.data_display import Pose
from linkwright.viewer.displays.topic_display import TopicDisplay
from linkwright.viewer.images import BadImageError, ImageCompressor, RangeFinder, picture_of
from linkwright.viewer.protocol import CameraModel, ImageFrame
from linkwright.viewer.rviz_config import DisplayConfig

COMPRESSED = "/compressed"
_ENCODINGS: dict[int, Literal["grey", "rgb", "rgba"]] = {1: "grey", 3: "rgb", 4: "rgba"}
MOST_PIXELS = 2_100_000
"""Pages are sent no more pixels of an image than Full HD has: panels are smaller, and pixels are not compressed."""


class ImageTopicDisplay(TopicDisplay):
    """Shows the images of a topic; one whose name ends with ``/compressed`` carries files that browsers read."""

    MESSAGE = "sensor_msgs/msg/Image"

    def __init__(self, stage: Stage, identity: str, config: DisplayConfig) -> None:
        super().__init__(stage, identity, config)
        self.ranges = RangeFinder()
        self._compressor = ImageCompressor()

    @classmethod
    def messages_shown(cls) -> tuple[str, ...]:
        """Raw and compressed images."""
        return (cls.MESSAGE, "sensor_msgs/msg/CompressedImage")

    def subscription(self) -> tuple[str, str, QoSProfile]:
        """As the transport of the topic has it."""
        message, topic, qos = super().subscription()
        return "sensor_msgs/msg/CompressedImage" if topic.endswith(COMPRESSED) else message, topic, qos

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
