"""Convert images to and from ``compressed`` and ``compressedDepth`` messages.

Sources: compressed_image_transport (the format string), compressed_depth_image_transport (the header, and the
quantization of depths in meters with ``depth_max`` 10 and ``depth_quantization`` 100).
"""

from __future__ import annotations

import struct
from dataclasses import fields
from io import BytesIO
from typing import Any

import numpy as np

from linkwright.images import BadImageError
from linkwright.images.compressed_depth import decode_depth
from linkwright.images.image_files import RawImage, decode_compressed, encoding_of
from linkwright.messages import get_message
from linkwright.perception.nodes.compressed import compress_image
from linkwright.perception.nodes.depthimage_to_laserscan import read_depths

_DEPTH_HEADER = struct.Struct("<iff")
_DEPTH_MAX_M, _QUANTIZATION = 10.0, 100.0
_INTEGER_ENCODINGS = ("16UC1", "mono16")

__all__ = ["BadImageError", "compress_depth", "compress_image", "decompress_depth", "decompress_image"]


def decompress_image(message: Any) -> Any:
    """Decode a CompressedImage of the transport ``compressed`` to an Image.

    Raises:
        BadImageError: the data is neither a JPEG nor a PNG.
    """
    image = decode_compressed(message)
    if encoding_of(message).startswith("bgr") and image.encoding in ("rgb8", "rgba8"):
        channels = len(image.encoding) - 1
        rows = image.data.reshape(image.height, image.width, channels)[:, :, [2, 1, 0, 3][:channels]]
        image = RawImage.of(image.header, image.encoding.replace("rgb", "bgr"), rows)
    return _to_message(image)


def compress_depth(image: Any) -> Any | None:
    """Encode a depth image for the transport ``compressedDepth``, or return None for others.

    Raises:
        BadImageError: the image has too little data.
        ModuleNotFoundError: Pillow is not installed.
    """
    if image.encoding not in (*_INTEGER_ENCODINGS, "32FC1"):
        return None
    from PIL import Image  # imported here because Pillow is an optional extra

    try:
        depths = read_depths(image)
    except ValueError as error:
        raise BadImageError(str(error)) from None
    scale = offset = 0.0
    if image.encoding == "32FC1":
        scale = _QUANTIZATION * (_QUANTIZATION + 1.0)
        offset = 1.0 - scale / _DEPTH_MAX_M
        with np.errstate(invalid="ignore", divide="ignore"):
            values = np.where((depths > 0.0) & (depths < _DEPTH_MAX_M), scale / depths + offset, 0.0)
    else:
        values = np.nan_to_num(depths) * 1000.0
    file = BytesIO()
    Image.fromarray(values.round().clip(0, 65535).astype(np.uint16)).save(file, "PNG")
    message = get_message("sensor_msgs/msg/CompressedImage")(header=image.header)
    message.format = f"{image.encoding}; compressedDepth png"
    message.data = _DEPTH_HEADER.pack(0, scale, offset) + file.getvalue()
    return message


def decompress_depth(message: Any) -> Any:
    """Decode a CompressedImage of the transport ``compressedDepth`` to a sensor_msgs/msg/Image.

    Raises:
        BadImageError: the message is not such an image, or its data is damaged or missing.
    """
    return _to_message(decode_depth(message))


def _to_message(image: RawImage) -> Any:
    message = get_message("sensor_msgs/msg/Image")()
    for field in fields(image):
        setattr(message, field.name, getattr(image, field.name))
    return message
