"""Image messages as files for browsers: JPEG and PNG."""

from __future__ import annotations

from dataclasses import dataclass
from io import BytesIO
from typing import Any

import numpy as np

from linkwright.bridge.video.requests import PNG, ROS_COMPRESSED, ImageRequest
from linkwright.images import BadImageError, RangeFinder, decode_image


@dataclass(frozen=True, slots=True)
class Frame:
    """A file with an image.

    Attributes:
        content_type: the type of the file, such as ``image/jpeg``.
        data: the bytes of the file.
    """

    content_type: str
    data: bytes


def encode_frame(message: Any, request: ImageRequest) -> Frame:
    """Return the image of a message as a file of the type, size and quality of a request.

    Values of more than 8 bits, such as depths, are shown from black for the minimum to white for the maximum of the
    image.

    Args:
        message: a sensor_msgs/msg/Image, or for `ROS_COMPRESSED` a sensor_msgs/msg/CompressedImage.
        request: the request.

    Raises:
        BadImageError: the image is damaged, or has an unsupported encoding or format.
        ModuleNotFoundError: Pillow is not installed.
    """
    if request.type == ROS_COMPRESSED:
        return _pass_file(message)
    ranges = RangeFinder()
    ranges.window = 1  # an image does not depend on earlier ones
    decoded = decode_image(message, ranges)
    from PIL import Image  # imported here because Pillow is an optional extra

    has_alpha = decoded.channels == 4 and request.type == PNG
    pixels = decoded.pixels if has_alpha or decoded.channels == 1 else decoded.rgb()
    if request.is_inverted:
        pixels = pixels[::-1, ::-1]
    image = Image.fromarray(np.ascontiguousarray(pixels))
    size = request.width or image.width, request.height or image.height
    if size != image.size:
        image = image.resize(size, Image.Resampling.BILINEAR)
    file = BytesIO()
    if request.type == PNG:
        image.save(file, "PNG", compress_level=request.quality)
        return Frame("image/png", file.getvalue())
    image.save(file, "JPEG", quality=request.quality)
    return Frame("image/jpeg", file.getvalue())


def _pass_file(message: Any) -> Frame:
    name = message.format.lower()
    if "jpeg" in name or "jpg" in name:
        return Frame("image/jpeg", bytes(message.data))
    if "png" in name:
        return Frame("image/png", bytes(message.data))
    raise BadImageError(f"The compressed image has the format '{message.format}', which is neither JPEG nor PNG")
