"""The encodings of ``sensor_msgs/image_encodings``, and conversions between them as in OpenCV."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.images.decoding import demosaic, packed_to_rgb

DEPTHS = ("8U", "8S", "16U", "16S", "32S", "32F", "64F")
"""OpenCV's names of depths, indexed by their numbers."""
NUMPY_NAMES = ("uint8", "int8", "uint16", "int16", "int32", "float32", "float64")
_CHANNEL_SHIFT = 3

_TYPE = re.compile(r"(8U|8S|16U|16S|32S|32F|64F)C(\d*)")
_COLOUR = re.compile(r"(mono|rgb|bgr|rgba|bgra)(8|16)|bayer_(rggb|bggr|gbrg|grbg)(8|16)")
_PACKED_YUV = {"yuv422": "uyvy", "uyvy": "uyvy", "yuv422_yuy2": "yuyv", "yuyv": "yuyv"}
_CHANNELS = {"mono": 1, "rgb": 3, "bgr": 3, "rgba": 4, "bgra": 4}

# The weights of red, green and blue in a grey value, as in OpenCV: ITU-R BT.601 in units of 1/32768.
_GREY_SHIFT = 15
_RED, _GREEN, _BLUE = 9798, 19235, 3735


class ConversionError(RuntimeError):
    """Raised when an encoding is unknown or a conversion is not possible; states the reason."""


@dataclass(frozen=True, slots=True)
class Encoding:
    """An image encoding.

    Attributes:
        name: the name of the encoding in messages.
        depth: OpenCV's name of the depth.
        channels: the number of channels.
        order: the order of the channels: ``mono``, ``rgb``, ``bgra``, ``bayer_rggb``, ``yuyv``...; empty for plain
            numbers.
    """

    name: str
    depth: str
    channels: int
    order: str

    @property
    def cv_type(self) -> int:
        """OpenCV's type number, such as 16 for ``CV_8UC3``."""
        return DEPTHS.index(self.depth) + ((self.channels - 1) << _CHANNEL_SHIFT)


def encoding(name: str) -> Encoding:
    """Return the encoding with the given name.

    Raises:
        ConversionError: there is no such encoding.
    """
    if plain := _TYPE.fullmatch(name):
        return Encoding(name, plain[1], int(plain[2] or 1), "")
    if name in _PACKED_YUV:
        return Encoding(name, "8U", 2, _PACKED_YUV[name])
    colour = _COLOUR.fullmatch(name)
    if colour is None:
        raise ConversionError(f"Unrecognized image encoding [{name}]")
    if colour[3]:
        return Encoding(name, f"{colour[4]}U", 1, f"bayer_{colour[3]}")
    return Encoding(name, f"{colour[2]}U", _CHANNELS[colour[1]], colour[1])


def depth_and_channels(cv_type: int) -> tuple[str, int]:
    """Return OpenCV's name of the depth and the number of channels for a type number."""
    return DEPTHS[cv_type & ((1 << _CHANNEL_SHIFT) - 1)], (cv_type >> _CHANNEL_SHIFT) + 1


def convert_image(image: NDArray[Any], source: str, wanted: str) -> NDArray[Any]:
    """Return a copy of an image in another encoding.

    Args:
        image: the pixels, of shape (height, width), or (height, width, channels) for several channels.
        source: the name of the image's encoding.
        wanted: the name of the target encoding.

    Raises:
        ConversionError: an encoding is unknown, or the conversion is not possible.
    """
    of, to = encoding(source), encoding(wanted)
    if source == wanted or not wanted:
        return np.array(image, order="C")
    if not of.order and to.order:
        raise ConversionError(f"[{source}] is not a color format, and [{wanted}] is: that conversion makes no sense")
    if not to.order:
        if of.channels != to.channels:
            raise ConversionError(f"[{source}] and [{wanted}] do not have the same number of channels")
        return _convert_depth(image, of, to)
    if to.order not in _CHANNELS:
        raise ConversionError(f"Unsupported conversion from [{source}] to [{wanted}]")
    return _convert_depth(_in_order(image, of, to.order), of, to)


def _in_order(image: NDArray[Any], of: Encoding, order: str) -> NDArray[Any]:
    """Return an image with the channels in another order, where channels may be added or dropped."""
    if of.order == order:
        return image
    if of.order == "mono":
        channels = [image] * 3
    else:
        image = _to_rgb(image, of)
        reversed_ = of.order.startswith("bgr")
        channels = [image[..., index] for index in ((2, 1, 0) if reversed_ else (0, 1, 2))]
    if order == "mono":
        red, green, blue = (channel.astype(np.int64) for channel in channels)
        weighed = red * _RED + green * _GREEN + blue * _BLUE + (1 << (_GREY_SHIFT - 1))
        return (weighed >> _GREY_SHIFT).astype(image.dtype)
    if order.startswith("bgr"):
        channels.reverse()
    if len(order) > 3:
        opaque = np.full(image.shape[:2], np.iinfo(image.dtype).max, image.dtype)
        channels.append(image[..., 3] if of.order in ("rgba", "bgra") else opaque)
    return np.stack(channels, axis=-1)


def _to_rgb(image: NDArray[Any], of: Encoding) -> NDArray[Any]:
    """Convert an image in a Bayer or YUV encoding to RGB; return any other image unchanged."""
    if of.order.startswith("bayer_"):
        if of.depth != "8U":
            raise ConversionError(f"Unsupported conversion from [{of.name}]: only mosaics of 8 bits are read")
        return demosaic(image, of.order.removeprefix("bayer_"))
    if of.name in _PACKED_YUV:
        return packed_to_rgb(image, of.order)
    return image


def _convert_depth(image: NDArray[Any], of: Encoding, to: Encoding) -> NDArray[Any]:
    """Return an image converted to another depth.

    Between unsigned 8 and 16 bits the values are scaled, so that black and white are preserved.
    """
    dtype = np.dtype(NUMPY_NAMES[DEPTHS.index(to.depth)])
    if image.dtype == dtype:
        return np.array(image, order="C")
    factor = {("8U", "16U"): 65535.0 / 255.0, ("16U", "8U"): 255.0 / 65535.0}.get((of.depth, to.depth), 1.0)
    numbers = image.astype(np.float64) * factor
    if dtype.kind == "f":
        return numbers.astype(dtype)
    limits = np.iinfo(dtype)
    return np.clip(np.rint(np.nan_to_num(numbers)), limits.min, limits.max).astype(dtype)
