"""Images as messages of image_transport's plugins ``compressed`` and ``compressedDepth``, and back.

Sources: compressed_image_transport (the format's text), compressed_depth_image_transport (the header, the quantization
of depths in metres by ``depth_max`` 10 and ``depth_quantization`` 100).
"""

from __future__ import annotations

import struct
from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.messages import get_message
from linkwright.nodes.depthimage_to_laserscan import depths_of
from linkwright.nodes.gazebo.compressed import compressed as compressed_image

_HEADER = struct.Struct("<iff")
_DEPTH_MAX, _QUANTIZATION = 10.0, 100.0
_MOST_PIXELS = 1 << 24
"""No image with more pixels is unpacked: a small file can claim any size."""
_WHOLE = ("16UC1", "mono16")

__all__ = ["BadImageError", "compressed_depth", "compressed_image", "plain_depth", "plain_image"]


class BadImageError(ValueError):
    """An image that cannot be packed or unpacked; the text says why."""


def plain_image(message: Any) -> Any:
    """A sensor_msgs/msg/CompressedImage of the transport ``compressed`` as sensor_msgs/msg/Image.

    Raises:
        BadImageError: it is no JPEG or PNG.
        ModuleNotFoundError: Pillow is not installed.
    """
    pixels = _unpacked(bytes(message.data))
    wanted = message.format.partition(";")[0].strip()
    if pixels.ndim == 2:
        encoding = wanted if pixels.dtype == np.uint16 and wanted in _WHOLE else f"mono{8 * pixels.itemsize}"
    elif wanted.startswith("bgr"):
        encoding, pixels = f"bgr{'a' if pixels.shape[2] == 4 else ''}8", pixels[:, :, [2, 1, 0, 3][: pixels.shape[2]]]
    else:
        encoding = f"rgb{'a' if pixels.shape[2] == 4 else ''}8"
    return _image(message.header, encoding, pixels)


def compressed_depth(image: Any) -> Any | None:
    """A depth image as sensor_msgs/msg/CompressedImage of the transport ``compressedDepth``; None for any other image.

    Raises:
        BadImageError: it has less data than it says.
        ModuleNotFoundError: Pillow is not installed.
    """
    if image.encoding not in (*_WHOLE, "32FC1"):
        return None
    from PIL import Image  # not above: an extra

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
    """A sensor_msgs/msg/CompressedImage of the transport ``compressedDepth`` as sensor_msgs/msg/Image.

    Raises:
        BadImageError: it is none, or not packed as PNG.
        ModuleNotFoundError: Pillow is not installed.
    """
    data, encoding = bytes(message.data), message.format.partition(";")[0].strip()
    if len(data) <= _HEADER.size or encoding not in (*_WHOLE, "32FC1"):
        raise BadImageError(f"the format of the depth image is '{message.format}'")
    _, first, second = _HEADER.unpack_from(data)
    numbers = _unpacked(data[_HEADER.size :])
    if numbers.dtype != np.uint16 or numbers.ndim != 2:
        raise BadImageError("the depths are no PNG of 16 bits")
    if encoding == "32FC1":
        with np.errstate(divide="ignore"):
            depths = np.where(numbers > 0, first / (numbers.astype(np.float64) - second), np.nan)
        return _image(message.header, encoding, depths.astype(np.float32))
    return _image(message.header, encoding, numbers)


def _unpacked(data: bytes) -> NDArray[Any]:
    """The pixels of a JPEG or PNG: shape (height, width), or (height, width, 3 or 4)."""
    from PIL import Image  # not above: an extra

    try:
        with Image.open(BytesIO(data), formats=("JPEG", "PNG")) as file:
            if file.width * file.height <= _MOST_PIXELS:
                if file.mode.startswith("I"):
                    return np.asarray(file).astype(np.uint16)
                return np.asarray(file if file.mode in ("L", "RGB", "RGBA") else file.convert("RGB"))
    except Exception as error:  # noqa: BLE001 - a file from a message may be broken in any way
        raise BadImageError(f"{error or type(error).__name__}") from None
    raise BadImageError(f"it has more than {_MOST_PIXELS} pixels, which are not unpacked")


def _image(header: Any, encoding: str, pixels: NDArray[Any]) -> Any:
    rows = np.ascontiguousarray(pixels, pixels.dtype.newbyteorder("<"))
    message = get_message("sensor_msgs/msg/Image")(header=header)
    message.height, message.width = rows.shape[:2]
    message.encoding, message.is_bigendian = encoding, 0
    message.step = rows.nbytes // max(1, message.height)
    message.data = rows.view(np.uint8).reshape(-1)
    return message
