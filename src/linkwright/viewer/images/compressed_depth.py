"""The transport `compressedDepth`: a header, and the depths as a PNG of 16 bits or packed with RVL.

As compressed_depth_image_transport reads it. The header has an int32 that nothing depends on, and two float32. Depths
that were float32 are there as whole numbers that grow with nearness: ``depth = first / (number - second)``, and 0 where
there is none. Before an RVL stream stand its columns and rows, each a uint32.
"""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.viewer.images.decoding import BadImageError
from linkwright.viewer.images.image_files import MOST_PIXELS, RawImage, encoding_of, file_pixels
from linkwright.viewer.images.rvl import BadRvlError, decoded

_HEADER = struct.Struct("<iff")
_RVL_SIZE = struct.Struct("<II")
_WHOLE, _FLOAT = ("16UC1", "mono16"), "32FC1"
_PACKINGS = {"": "png", "compressedDepth": "png", "compressedDepth png": "png", "compressedDepth rvl": "rvl"}
"""How the depths are packed, by what follows on the encoding in the format; older publishers know of PNG alone."""


def unpacked_depth(message: Any) -> RawImage:
    """The depth image of a message.

    Args:
        message: sensor_msgs/msg/CompressedImage with a format such as ``16UC1; compressedDepth png``.

    Raises:
        BadImageError: the format is another, or the data are not what it says.
    """
    encoding = encoding_of(message)
    packing = _PACKINGS.get(message.format.partition(";")[2].strip())
    if packing is None or encoding not in (*_WHOLE, _FLOAT):
        raise BadImageError(
            f"The format of the depth image is '{message.format}'; read are 16UC1, mono16 and 32FC1, "
            "each with 'compressedDepth png' or 'compressedDepth rvl'"
        )
    data = np.frombuffer(message.data, np.uint8)
    if data.size <= _HEADER.size:
        raise BadImageError(f"The depth image has {data.size} bytes, no more than its header")
    _, first, second = _HEADER.unpack(data[: _HEADER.size].tobytes())
    rest = data[_HEADER.size :]
    numbers = _of_png(rest) if packing == "png" else _of_rvl(rest)
    if encoding == _FLOAT:
        return RawImage.of(message.header, _FLOAT, _depths(numbers, first, second))
    return RawImage.of(message.header, encoding, numbers)


def _of_png(data: NDArray[np.uint8]) -> NDArray[np.uint16]:
    pixels = file_pixels(data)
    if pixels.dtype != np.uint16:
        raise BadImageError("The depth image is not a PNG of 16 bits and one channel")
    return pixels


def _of_rvl(data: NDArray[np.uint8]) -> NDArray[np.uint16]:
    if data.size < _RVL_SIZE.size:
        raise BadImageError("The RVL depth image ends before its size")
    columns, rows = _RVL_SIZE.unpack(data[: _RVL_SIZE.size].tobytes())
    if not 0 < columns * rows <= MOST_PIXELS:
        raise BadImageError(
            f"The RVL depth image says that it has {columns} x {rows} pixels; 1 to {MOST_PIXELS} are unpacked"
        )
    try:
        return decoded(data[_RVL_SIZE.size :], columns * rows).reshape(rows, columns)
    except BadRvlError as error:
        raise BadImageError(f"The RVL depth image of {columns} x {rows} pixels cannot be read: {error}") from None


def _depths(numbers: NDArray[np.uint16], first: float, second: float) -> NDArray[np.float32]:
    """Metres, shape (height, width); NaN where there is no depth."""
    if not (np.isfinite(first) and np.isfinite(second) and first > 0.0):
        raise BadImageError(f"The header of the depth image has no scale for its depths: {first:g}, {second:g}")
    every = np.arange(65536, dtype=np.float32)
    with np.errstate(divide="ignore"):
        metres = np.float32(first) / (every - np.float32(second))
    metres[0] = np.nan
    table: NDArray[np.float32] = metres[numbers]
    return table
