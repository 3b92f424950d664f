"""The queries of requests for images, such as ``topic=/camera/image_raw&type=png&width=320``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from linkwright.graph import DEFAULT_QOS, SENSOR_DATA_QOS, SYSTEM_DEFAULT_QOS
from linkwright.images import RAW, TRANSPORTS

MJPEG, PNG, ROS_COMPRESSED = "mjpeg", "png", "ros_compressed"
STREAM_TYPES = (MJPEG, PNG, ROS_COMPRESSED)
MISSING_STREAM_TYPES = ("vp8", "vp9", "h264")
"""The stream types of the ROS node that need a video encoder."""
QOS_PROFILES = {"default": DEFAULT_QOS, "system_default": SYSTEM_DEFAULT_QOS, "sensor_data": SENSOR_DATA_QOS}
_QUALITIES = {MJPEG: (95, 100), PNG: (3, 9), ROS_COMPRESSED: (95, 100)}
"""The default and the maximum of ``quality`` by stream type: of JPEGs, also instead of missing compressed images, and
the compression level of PNGs."""
_MAX_LENGTH = 8192
"""The maximum width and height of an image, in pixels."""


class BadQueryError(ValueError):
    """Raised for a query that cannot be answered. The message is the text of the response."""


@dataclass(frozen=True, slots=True)
class ImageRequest:
    """A request for the images of a topic.

    Attributes:
        topic: the absolute name of the topic.
        type: one of `STREAM_TYPES`.
        width, height: the size of the images in pixels; None for that of the topic's images.
        quality: the quality of a JPEG from 0 to 100, or the compression level of a PNG from 0 to 9.
        is_inverted: whether the images are rotated by 180 degrees.
        transport: the transport of the topic's images, one of `TRANSPORTS`.
        qos_name: the name of the QoS profile of the subscription, which may be unknown.
    """

    topic: str
    type: str = MJPEG
    width: int | None = None
    height: int | None = None
    quality: int = 95
    is_inverted: bool = False
    transport: str = RAW
    qos_name: str = "default"

    @classmethod
    def of(cls, query: Mapping[str, str], default_type: str) -> ImageRequest:
        """Return the request of a query.

        Raises:
            BadQueryError: a value is missing, is unknown, or out of range.
        """
        topic = query.get("topic", "").strip()
        if not topic:
            raise BadQueryError("Name a topic with images: ?topic=/camera/image_raw")
        stream_type = query.get("type", default_type)
        check_type(stream_type)
        transport = query.get("default_transport", RAW)
        if transport not in TRANSPORTS:
            raise BadQueryError(f"default_transport cannot be '{transport}': choose from {', '.join(TRANSPORTS)}")
        default_quality, max_quality = _QUALITIES[stream_type]
        quality = _parse_integer(query, "quality", 0, max_quality)
        return cls(
            topic if topic.startswith("/") else f"/{topic}",
            stream_type,
            _parse_integer(query, "width", 1, _MAX_LENGTH),
            _parse_integer(query, "height", 1, _MAX_LENGTH),
            default_quality if quality is None else quality,
            "invert" in query,
            transport,
            query.get("qos_profile", "default"),
        )


def check_type(stream_type: str) -> None:
    """Check a stream type.

    Raises:
        BadQueryError: the type is not supported.
    """
    if stream_type in STREAM_TYPES:
        return
    choices = ", ".join(STREAM_TYPES)
    if stream_type in MISSING_STREAM_TYPES:
        raise BadQueryError(f"The stream type '{stream_type}' is not supported here: choose from {choices}")
    raise BadQueryError(f"There is no stream type '{stream_type}': choose from {choices}")


def _parse_integer(query: Mapping[str, str], name: str, minimum: int, maximum: int) -> int | None:
    text = query.get(name)
    if text is None or text == "-1":  # the ROS node's value for the default
        return None
    try:
        value = int(text)
    except ValueError:
        value = minimum - 1
    if not minimum <= value <= maximum:
        raise BadQueryError(f"{name} cannot be '{text}': it is an integer from {minimum} to {maximum}")
    return value
