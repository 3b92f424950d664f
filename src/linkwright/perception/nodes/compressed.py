"""Compress images as JPEG for image_bridge.

Source: the plugin ``compressed`` of image_transport (the topic, the format string, the quality).
"""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np

from linkwright.messages import get_message

_JPEG_QUALITY = 95
_CHANNELS = {"rgb8": 3, "bgr8": 3, "mono8": 1}


def compress_image(image: Any) -> Any | None:
    """Compress an image to a CompressedImage, or return None if its encoding is not supported.

    Supported are non-empty images with the encodings rgb8, bgr8 and mono8.

    Raises:
        ModuleNotFoundError: Pillow is not installed.
    """
    channels = _CHANNELS.get(image.encoding)
    if channels is None or not image.width or not image.height:
        return None
    from PIL import Image  # imported here because Pillow is an optional extra

    rows = np.frombuffer(bytes(image.data), np.uint8).reshape(image.height, image.step)
    channels_last = rows[:, : image.width * channels].reshape(image.height, image.width, channels)
    pixels = channels_last[:, :, ::-1] if image.encoding == "bgr8" else channels_last
    file = BytesIO()
    Image.fromarray(np.ascontiguousarray(pixels[:, :, 0] if channels == 1 else pixels)).save(
        file, "JPEG", quality=_JPEG_QUALITY
    )
    message = get_message("sensor_msgs/msg/CompressedImage")(header=image.header)
    message.format = f"{image.encoding}; jpeg compressed {'mono8' if channels == 1 else 'bgr8'}"
    message.data = file.getvalue()
    return message
