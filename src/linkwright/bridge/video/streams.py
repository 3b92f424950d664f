"""The images of one topic for one client: the latest only, so that a slow client gets fewer images."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import Any

from linkwright.bridge.video.frames import Frame, encode_frame
from linkwright.bridge.video.requests import QOS_PROFILES, ROS_COMPRESSED, ImageRequest
from linkwright.graph import Node
from linkwright.images import COMPRESSED, ImageSource, Unpacker
from linkwright.messages import get_message

_IMAGE, _CAMERA_INFO = "sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo"


class ImageStream:
    """The images of a topic, as they arrive.

    Args:
        node: the node that subscribes to the topic.
        source: the topic.
        request: the request of the client.
    """

    def __init__(self, node: Node, source: ImageSource, request: ImageRequest) -> None:
        self._request = request
        self._source = source
        self._unpacker = Unpacker()
        self._message: Any = None
        self._arrived = asyncio.Event()
        self._node = node
        self._subscription = node.create_subscription(
            get_message(source.message_type),
            source.topic,
            self._receive,
            QOS_PROFILES.get(request.qos_name, QOS_PROFILES["default"]),
        )

    def close(self) -> None:
        """Close the subscription."""
        self._node.destroy_subscription(self._subscription)

    async def next(self, timeout_s: float | None = None) -> tuple[Frame, float]:
        """Wait for the next image.

        Args:
            timeout_s: after this time without an image, the last one is returned again; None to wait for a new one.

        Returns:
            The file, and the time of the message in s.

        Raises:
            BadImageError: the image cannot be shown.
            ModuleNotFoundError: Pillow is not installed.
        """
        with suppress(asyncio.TimeoutError):
            await asyncio.wait_for(self._arrived.wait(), timeout_s if self._message is not None else None)
        self._arrived.clear()
        message = self._message
        stamp = message.header.stamp
        frame = await asyncio.get_running_loop().run_in_executor(None, self._encode, message)
        return frame, stamp.sec + stamp.nanosec * 1e-9

    def skip(self) -> None:
        """Forget the last image, so that it is not returned again."""
        self._message = None

    def _receive(self, message: Any) -> None:
        self._message = message
        self._arrived.set()

    def _encode(self, message: Any) -> Frame:
        if self._request.type != ROS_COMPRESSED:
            message = self._unpacker.image(message, self._source.transport_of(message))
        return encode_frame(message, self._request)


def find_source(node: Node, request: ImageRequest) -> ImageSource | None:
    """Return the topic that has the images of a request, or None if there is none."""
    types = dict(node.get_topic_names_and_types())
    if request.type == ROS_COMPRESSED:
        source = ImageSource(request.topic.removesuffix(f"/{COMPRESSED}"), COMPRESSED)
    else:
        source = ImageSource.of(request.topic, request.transport)
        source = source.with_types(types.get(source.topic, ()))
    return source if source.is_supported and source.message_type in types.get(source.topic, ()) else None


def find_image_topics(node: Node) -> dict[str, list[str]]:
    """Return the topics with images by their cameras.

    Returns:
        For each name before ``camera_info``, such as ``/camera/``, the topics below it; for an empty name, the topics
        without a camera.
    """
    types = dict(node.get_topic_names_and_types())
    images = [topic for topic, names in types.items() if _IMAGE in names]
    bases = [
        topic.removesuffix("camera_info")
        for topic, names in types.items()
        if topic.endswith("/camera_info") and _CAMERA_INFO in names
    ]
    cameras: dict[str, list[str]] = {base: [] for base in sorted(bases)}
    cameras[""] = []
    for topic in sorted(images):
        cameras[max((base for base in cameras if topic.startswith(base)), key=len)].append(topic)
    return {base: topics for base, topics in cameras.items() if topics}
