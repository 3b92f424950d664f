"""image_proc's node that converts the images of a color sensor, such as Bayer mosaics, to gray and to colors.

Source: image_proc for ROS 2 (parameters, topics, defaults). All algorithms of ``debayer`` are the bilinear one.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import phrase
from linkwright.graph import Node
from linkwright.images.decoding import RangeFinder, decode_image, demosaic
from linkwright.messages import get_message
from linkwright.perception.nodes.image_arrays import to_array, to_image
from linkwright.perception.nodes.image_node import ImageNode

_IMAGE_TYPE = "sensor_msgs/msg/Image"
_DEFAULT_ALGORITHM = 3
_WARNING_PERIOD_S = 5.0
_LUMA = np.array((0.299, 0.587, 0.114))
"""The shares of red, green and blue in gray, as in OpenCV."""


class DebayerNode(ImageNode):
    """The running node.

    Raises:
        LinkwrightError: a parameter has an invalid type (GRAPH201).
    """

    DEFAULT_NAME, OUTPUTS = "DebayerNode", ("image_mono", "image_color")

    def declare_parameters(self, node: Node) -> None:
        """Declare the algorithm."""
        node.declare_parameter("debayer", _DEFAULT_ALGORITHM)

    def convert(self, image: Any) -> None:
        """Publish the gray and the color image, those with a subscription."""
        mono, color = self._publishers
        if mono.get_subscription_count():
            mono.publish(image if _is_gray(image) else _make_image(_to_gray(_read_colors(image)), image))
        if color.get_subscription_count():
            color.publish(image if _has_colors(image) else _make_image(_read_colors(image)[..., ::-1], image))
            if _is_gray(image):
                self._node.get_logger().warning(
                    f"Color topic '{color.topic_name}' requested, but raw image data from topic "
                    f"'{self._source.topic}' is grayscale",
                    throttle_duration_sec=_WARNING_PERIOD_S,
                )

    def log_failure(self, error: Exception) -> None:
        """Log that an image is left out."""
        self._node.get_logger().warning(
            phrase("the image on '{topic}' is left out: {reason}", topic=self._source.topic, reason=str(error)),
            throttle_duration_sec=_WARNING_PERIOD_S,
        )


def _is_gray(image: Any) -> bool:
    return bool(image.encoding in ("mono8", "mono16"))


def _has_colors(image: Any) -> bool:
    """Return whether an image needs no conversion: it is gray, or its pixels have all colors."""
    return _is_gray(image) or image.encoding.startswith(("rgb", "bgr"))


def _read_colors(image: Any) -> NDArray[Any]:
    """Return the red, green and blue of the pixels of an image, shape (height, width, 3).

    Raises:
        ValueError: the encoding does not tell the colors.
        BadImageError: the encoding is not supported, or there are too few bytes.
    """
    encoding = image.encoding
    if encoding.startswith("bayer_"):
        return demosaic(to_array(image)[..., 0], encoding[6:10])
    if encoding.startswith(("rgb", "bgr")):
        pixels = to_array(image)[..., :3]
        return pixels if encoding.startswith("rgb") else pixels[..., ::-1]
    if encoding.startswith(("8", "16", "32", "64")):
        raise ValueError(f"the encoding '{encoding}' does not tell the colors; the source should set 'bgr8' or 'rgb8'")
    return decode_image(image, RangeFinder()).rgb()


def _to_gray(colors: NDArray[Any]) -> NDArray[Any]:
    gray: NDArray[Any] = np.rint(colors @ _LUMA)[..., None].astype(colors.dtype)
    return gray


def _make_image(pixels: NDArray[Any], source: Any) -> Any:
    name = "mono" if pixels.shape[2] == 1 else "bgr"
    encoding = f"{name}{8 * pixels.dtype.itemsize}"
    return to_image(pixels, get_message(_IMAGE_TYPE)(header=source.header, encoding=encoding))
