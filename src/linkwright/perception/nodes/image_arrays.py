"""The pixels of image messages as arrays, and their resampling.

Source: REP 118 and sensor_msgs (encodings), OpenCV (positions of pixels and borders of ``remap`` and ``resize``).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.messages import get_message

_CHANNELS = {"mono": 1, "rgb": 3, "bgr": 3, "rgba": 4, "bgra": 4, "bayer_rggb": 1, "bayer_bggr": 1}
_CHANNELS |= {"bayer_gbrg": 1, "bayer_grbg": 1}
_COLOR_ENCODING = re.compile(r"([a-z_]+?)(8|16)")
_GENERIC_ENCODING = re.compile(r"(8|16|32|64)([USF])C(\d*)")
_KINDS = {"U": "u", "S": "i", "F": "f"}
NEAREST, LINEAR = 0, 1
"""The interpolations, with the numbers of OpenCV."""


def to_array(image: Any) -> NDArray[Any]:
    """Return the pixels of a ``sensor_msgs/msg/Image``, shape (height, width, channels).

    Raises:
        ValueError: the encoding is not supported, or the data are too short.
    """
    dtype, channels = _parse_encoding(image.encoding)
    dtype = dtype.newbyteorder(">" if image.is_bigendian else "<")
    row_bytes = dtype.itemsize * channels * image.width
    data = np.frombuffer(bytes(image.data), np.uint8)
    if image.step < row_bytes or len(data) < image.step * image.height:
        raise ValueError(f"the image has {len(data)} bytes, not {image.height} rows of {row_bytes}")
    rows = data[: image.step * image.height].reshape(image.height, image.step)[:, :row_bytes]
    return np.ascontiguousarray(rows).view(dtype).reshape(image.height, image.width, channels)


def to_image(pixels: NDArray[Any], source: Any) -> Any:
    """Return pixels as a message with the header and the encoding of another one."""
    image = get_message("sensor_msgs/msg/Image")(header=source.header, encoding=source.encoding)
    pixels = np.ascontiguousarray(pixels, pixels.dtype.newbyteorder("<"))
    image.height, image.width = pixels.shape[:2]
    image.step = pixels.dtype.itemsize * pixels.shape[1] * pixels.shape[2]
    image.data = pixels.tobytes()
    return image


def _parse_encoding(name: str) -> tuple[np.dtype[Any], int]:
    """Return the type of a channel, and the number of channels of an encoding.

    Raises:
        ValueError: the encoding is not supported.
    """
    color, generic = _COLOR_ENCODING.fullmatch(name), _GENERIC_ENCODING.fullmatch(name)
    if color is not None and color[1] in _CHANNELS:
        return np.dtype(f"u{int(color[2]) // 8}"), _CHANNELS[color[1]]
    if generic is not None and not (generic[2] == "F" and int(generic[1]) < 32):
        return np.dtype(f"{_KINDS[generic[2]]}{int(generic[1]) // 8}"), int(generic[3] or 1)
    raise ValueError(f"the encoding '{name}' is not supported")


@dataclass(frozen=True, slots=True)
class Sampling:
    """The positions in an image from which the pixels of another one are taken.

    Attributes:
        columns, rows: the positions in pixels, where the center of the first pixel is 0, shape (height, width).
        interpolation: `NEAREST` or `LINEAR`.
        has_border: whether pixels outside of the image are 0; otherwise the pixels at the edge are repeated.
    """

    columns: NDArray[np.float32]
    rows: NDArray[np.float32]
    interpolation: int = LINEAR
    has_border: bool = True

    def apply(self, pixels: NDArray[Any]) -> NDArray[Any]:
        """Return the sampled image, shape (height, width, channels).

        Args:
            pixels: the image, shape (rows, columns, channels).
        """
        if self.interpolation == NEAREST:
            columns, rows = np.rint(self.columns).astype(np.int64), np.rint(self.rows).astype(np.int64)
            return self._take(pixels, columns, rows)
        left, top = np.floor(self.columns), np.floor(self.rows)
        right_share, lower_share = (self.columns - left)[..., None], (self.rows - top)[..., None]
        column, row = left.astype(np.int64), top.astype(np.int64)
        upper, lower = (
            self._take(pixels, column, line) * (1.0 - right_share) + self._take(pixels, column + 1, line) * right_share
            for line in (row, row + 1)
        )
        blended = upper * (1.0 - lower_share) + lower * lower_share
        values = np.rint(blended) if pixels.dtype.kind in "ui" else blended
        sampled: NDArray[Any] = values.astype(pixels.dtype)
        return sampled

    def _take(self, pixels: NDArray[Any], columns: NDArray[np.int64], rows: NDArray[np.int64]) -> NDArray[Any]:
        """Return the pixels at integer positions, with the border."""
        height, width = pixels.shape[:2]
        taken = pixels[np.clip(rows, 0, height - 1), np.clip(columns, 0, width - 1)]
        if self.has_border:
            outside = (columns < 0) | (columns >= width) | (rows < 0) | (rows >= height)
            taken = np.where(outside[..., None], np.zeros((), pixels.dtype), taken)
        return taken


def create_resizing(
    size: tuple[int, int], new_size: tuple[int, int], factors: tuple[float, float], interpolation: int
) -> Sampling:
    """Return the sampling that resizes an image.

    Args:
        size: the width and height of the image in pixels.
        new_size: the width and height of the resized image in pixels.
        factors: the new size divided by the old one, before rounding, along x and y.
        interpolation: `NEAREST` or `LINEAR`.
    """
    positions = []
    for length, new_length, factor in zip(size, new_size, factors, strict=True):
        indices = np.arange(new_length)
        if interpolation == NEAREST:
            positions.append(np.minimum(np.floor(indices / factor), length - 1))
        else:
            positions.append((indices + 0.5) / factor - 0.5)
    columns, rows = np.meshgrid(*(np.asarray(values, np.float32) for values in positions))
    return Sampling(columns, rows, interpolation, has_border=False)
