"""Conversion of image messages (API of ``ros2_numpy.image``)."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.messages import get_message
from linkwright.standins.image_encodings import DEPTHS, NUMPY_NAMES, ConversionError, parse_encoding
from linkwright.standins.numpy_api.registry import converts_from_numpy, converts_to_numpy

_Image = get_message("sensor_msgs/msg/Image")


@converts_to_numpy(_Image)
def image_to_numpy(msg: Any) -> NDArray[Any]:
    """Return the pixels of a sensor_msgs/msg/Image.

    Returns:
        array, shape (height, width), or (height, width, channels) for several channels, in the byte order of the
        message. Its data are those of the message.

    Raises:
        TypeError: the encoding is unknown.
    """
    dtype, channels = _parse_encoding(msg.encoding)
    dtype = dtype.newbyteorder(">" if msg.is_bigendian else "<")
    shape: tuple[int, ...] = (msg.height, msg.width, channels)
    strides: tuple[int, ...] = (msg.step, dtype.itemsize * channels, dtype.itemsize)
    if channels == 1:
        shape, strides = shape[:2], strides[:2]
    return np.ndarray(shape, dtype, msg.data, strides=strides)


@converts_from_numpy(_Image)
def numpy_to_image(arr: NDArray[Any], encoding: str) -> Any:
    """Return a sensor_msgs/msg/Image.

    Args:
        arr: array, shape (height, width), or (height, width, channels).
        encoding: the encoding of the pixels, such as ``rgb8``.

    Raises:
        TypeError: the encoding is unknown, or the array does not have its type or its number of channels.
    """
    dtype, expected_channels = _parse_encoding(encoding)
    if arr.ndim not in (2, 3):
        raise TypeError("Array must be two or three dimensional")
    height, width, channels = (*arr.shape, 1)[:3]
    if channels != expected_channels:
        raise TypeError(f"Array has {channels} channels, {encoding} requires {expected_channels}")
    if arr.dtype.type is not dtype.type:
        raise TypeError(f"Array is {arr.dtype.type}, {encoding} requires {dtype.type}")
    image = _Image(height=height, width=width, encoding=encoding, step=width * channels * dtype.itemsize)
    order = arr.dtype.byteorder
    image.is_bigendian = int(order == ">" or (order == "=" and sys.byteorder == "big"))
    image.data = arr.tobytes()
    return image


def _parse_encoding(name: str) -> tuple[np.dtype[Any], int]:
    """Return the numpy type and the number of channels of an encoding.

    Raises:
        TypeError: the encoding is unknown.
    """
    try:
        encoding = parse_encoding(name)
    except ConversionError as error:
        raise TypeError(f"Unrecognized encoding {name}") from error
    return np.dtype(NUMPY_NAMES[DEPTHS.index(encoding.depth)]), encoding.channels
