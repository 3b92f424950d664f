"""Conversion between images and messages of image_transport's plugins ``compressed`` and ``compressedDepth``.

Sources: compressed_image_transport (the format's text), compressed_depth_image_transport (the header, the quantization
of depths in metres by ``depth_max`` 10 and ``depth_quantization`` 100).
"""

from __future__ import annotations

import struct
from dataclasses import fields
from io import BytesIO
from typing import Any

import numpy as np

from linkwright.images import BadImageError
from linkwright.images.compressed_depth import unpacked_depth
from linkwright.images.image_files import RawImage, encoding_of, unpacked
from linkwright.messages import get_message
from linkwright.perception.nodes.compressed import compressed as compressed_image
from linkwright.perception.nodes.depthimage_to_laserscan import depths_of

_HEADER = struct.Struct("<iff")
_DEPTH_MAX, _QUANTIZATION = 10.0, 100.0
_WHOLE = ("16UC1", "mono16")

__all__ = ["BadImageError", "compressed_depth", "compressed_image", "plain_depth", "plain_image"]


def plain_image(message: Any) -> Any:
    """Decode a sensor_msgs/msg/CompressedImage of the transport ``compressed`` to a sensor_msgs/msg/Image.

    Raises:
        BadImageError: the data is neither JPEG nor PNG.
    """
    image = unpacked(message)
    if encoding_of(message).startswith("bgr") and image.encoding in ("rgb8", "rgba8"):
        channels = len(image.encoding) - 1
        rows = image.data.reshape(image.height, image.width, channels)[:, :, [2, 1, 0, 3][:channels]]
        image = RawImage.of(image.header, image.encoding.replace("rgb", "bgr"), rows)
    return _message(image)


def compressed_depth(image: Any) -> Any | None:
    """Encode a depth image for the transport ``compressedDepth``; return None for other images.

    Raises:
        BadImageError: the image has too little data.
        ModuleNotFoundError: Pillow is not installed.
    """
    if image.encoding not in (*_WHOLE, "32FC1"):
        return None
    from PIL import Image  # Imported here because Pillow is an optional extra.

    try:
        depths = depths_of(image)
    except ValueError as error:
        raise BadImageError(str(error)) from None
    first = second = 0.0
    if image.encoding == "32FC1":
        first = _QUANTIZATION * (_QUANTIZATION + 1.0)
        second = 1.0 - first / _DEPTH_MAX
        with np.errstate(invalid="ignore", divide="ignore"):
            numbers = np.where((depths > 0.0) & (depths < _DEPTH_MAX), first / depths + second, 0.0)
    else:
        numbers = np.nan_to_num(depths) * 1000.0
    file = BytesIO()
    Image.fromarray(numbers.round().clip(0, 65535).astype(np.uint16)).save(file, "PNG")
    message = get_message("sensor_msgs/msg/CompressedImage")(header=image.header)
    message.format = f"{image.encoding}; compressedDepth png"
    message.data = _HEADER.pack(0, first, second) + file.getvalue()
    return message


def plain_depth(message: Any) -> Any:
    """Decode a sensor_msgs/msg/CompressedImage of the transport ``compressedDepth`` to a sensor_msgs/msg/Image.

    Raises:
        BadImageError: the message is not such an image, or has no data.
    """
    return _message(unpacked_depth(message))


def _message(image: RawImage) -> Any:
    message = get_message("sensor_msgs/msg/Image")()
    for field in fields(image):
        setattr(message, field.name, getattr(image, field.name))
    return message
