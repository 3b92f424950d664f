"""The encodings of ``sensor_msgs/image_encodings``, and conversions as in OpenCV."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.images.decoding import demosaic, packed_to_rgb

DEPTHS = ("8U", "8S", "16U", "16S", "32S", "32F", "64F")
"""OpenCV's names of depths. The index of a name is OpenCV's depth number."""
NUMPY_NAMES = ("uint8", "int8", "uint16", "int16", "int32", "float32", "float64")
_CHANNEL_SHIFT = 3

_TYPE_NAME = re.compile(r"(8U|8S|16U|16S|32S|32F|64F)C(\d*)")
_COLOR_NAME = re.compile(r"(mono|rgb|bgr|rgba|bgra)(8|16)|bayer_(rggb|bggr|gbrg|grbg)(8|16)")
_PACKED_YUV = {"yuv422": "uyvy", "uyvy": "uyvy", "yuv422_yuy2": "yuyv", "yuyv": "yuyv"}
_CHANNEL_COUNTS = {"mono": 1, "rgb": 3, "bgr": 3, "rgba": 4, "bgra": 4}

# The weights of red, green and blue in a gray value, as in OpenCV: ITU-R BT.601 in units of 1/32768.
_GRAY_SHIFT = 15
_RED_WEIGHT, _GREEN_WEIGHT, _BLUE_WEIGHT = 9798, 19235, 3735


class ConversionError(RuntimeError):
    """Raised when an encoding does not exist or a conversion is not possible.

    The message states the reason.
    """


@dataclass(frozen=True, slots=True)
class Encoding:
    """The encoding of the pixels of an image message.

    Attributes:
        name: the name of the encoding in messages.
        depth: OpenCV's name of the depth.
        channels: the number of channels.
        order: the order of the channels, such as ``mono``, ``bgra``, ``bayer_rggb`` or ``yuyv``; empty for numbers that
            are not colors, as in ``32FC1``.
    """

    name: str
    depth: str
    channels: int
    order: str

    @property
    def cv_type(self) -> int:
        """OpenCV's type number, such as 16 for ``CV_8UC3``."""
        return DEPTHS.index(self.depth) + ((self.channels - 1) << _CHANNEL_SHIFT)


def parse_encoding(name: str) -> Encoding:
    """Return the encoding with a name that messages use.

    Raises:
        ConversionError: there is no such encoding.
    """
    if type_match := _TYPE_NAME.fullmatch(name):
        return Encoding(name, type_match[1], int(type_match[2] or 1), "")
    if name in _PACKED_YUV:
        return Encoding(name, "8U", 2, _PACKED_YUV[name])
    color_match = _COLOR_NAME.fullmatch(name)
    if color_match is None:
        raise ConversionError(f"Unrecognized image encoding [{name}]")
    if color_match[3]:
        return Encoding(name, f"{color_match[4]}U", 1, f"bayer_{color_match[3]}")
    return Encoding(name, f"{color_match[2]}U", _CHANNEL_COUNTS[color_match[1]], color_match[1])


def split_cv_type(cv_type: int) -> tuple[str, int]:
    """Return OpenCV's name of the depth and the number of channels for a type number."""
    return DEPTHS[cv_type & ((1 << _CHANNEL_SHIFT) - 1)], (cv_type >> _CHANNEL_SHIFT) + 1


def convert_image(image: NDArray[Any], source: str, target: str) -> NDArray[Any]:
    """Return a copy of an image in another encoding.

    Args:
        image: the pixels, of shape (height, width), or (height, width, channels) for several channels.
        source: the name of the image's encoding.
        target: the name of the target encoding.

    Raises:
        ConversionError: an encoding does not exist, or the conversion is not possible.
    """
    source_encoding, target_encoding = parse_encoding(source), parse_encoding(target)
    if source == target or not target:
        return np.array(image, order="C")
    if not source_encoding.order and target_encoding.order:
        raise ConversionError(f"[{source}] is not a color format, and [{target}] is: that conversion makes no sense")
    if not target_encoding.order:
        if source_encoding.channels != target_encoding.channels:
            raise ConversionError(f"[{source}] and [{target}] do not have the same number of channels")
        return _convert_depth(image, source_encoding, target_encoding)
    if target_encoding.order not in _CHANNEL_COUNTS:
        raise ConversionError(f"Unsupported conversion from [{source}] to [{target}]")
    return _convert_depth(
        _reorder_channels(image, source_encoding, target_encoding.order), source_encoding, target_encoding
    )


def _reorder_channels(image: NDArray[Any], source_encoding: Encoding, order: str) -> NDArray[Any]:
    """Return an image with its channels in another order.

    Missing channels are added, and unused channels are dropped.
    """
    if source_encoding.order == order:
        return image
    if source_encoding.order == "mono":
        channels = [image] * 3
    else:
        image = _to_rgb(image, source_encoding)
        is_reversed = source_encoding.order.startswith("bgr")
        channels = [image[..., index] for index in ((2, 1, 0) if is_reversed else (0, 1, 2))]
    if order == "mono":
        red, green, blue = (channel.astype(np.int64) for channel in channels)
        weighted_sum = red * _RED_WEIGHT + green * _GREEN_WEIGHT + blue * _BLUE_WEIGHT + (1 << (_GRAY_SHIFT - 1))
        return (weighted_sum >> _GRAY_SHIFT).astype(image.dtype)
    if order.startswith("bgr"):
        channels.reverse()
    if len(order) > 3:
        opaque_alpha = np.full(image.shape[:2], np.iinfo(image.dtype).max, image.dtype)
        channels.append(image[..., 3] if source_encoding.order in ("rgba", "bgra") else opaque_alpha)
    return np.stack(channels, axis=-1)


def _to_rgb(image: NDArray[Any], source_encoding: Encoding) -> NDArray[Any]:
    """Convert an image in a Bayer or YUV encoding to RGB.

    Any other image is returned unchanged.
    """
    if source_encoding.order.startswith("bayer_"):
        if source_encoding.depth != "8U":
            raise ConversionError(
                f"Unsupported conversion from [{source_encoding.name}]: only mosaics of 8 bits are read"
            )
        return demosaic(image, source_encoding.order.removeprefix("bayer_"))
    if source_encoding.name in _PACKED_YUV:
        return packed_to_rgb(image, source_encoding.order)
    return image


def _convert_depth(image: NDArray[Any], source_encoding: Encoding, target_encoding: Encoding) -> NDArray[Any]:
    """Return an image converted to another depth.

    Between unsigned 8-bit and 16-bit depths, the values are scaled, so that black and white are preserved.
    """
    dtype = np.dtype(NUMPY_NAMES[DEPTHS.index(target_encoding.depth)])
    if image.dtype == dtype:
        return np.array(image, order="C")
    factor = {("8U", "16U"): 65535.0 / 255.0, ("16U", "8U"): 255.0 / 65535.0}.get(
        (source_encoding.depth, target_encoding.depth), 1.0
    )
    values = image.astype(np.float64) * factor
    if dtype.kind == "f":
        return values.astype(dtype)
    limits = np.iinfo(dtype)
    return np.clip(np.rint(np.nan_to_num(values)), limits.min, limits.max).astype(dtype)
