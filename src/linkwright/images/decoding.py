"""Convert sensor_msgs/msg/Image to 8-bit gray, RGB or RGBA pixels.

Luma and chroma of video cameras are converted (ITU-R BT.601, studio range), and images of a Bayer filter demosaiced.
Gray values of more than 8 bits are scaled by a range, as RViz's Normalize Range does.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import phrase

Pixels = NDArray[np.uint8]

_MAX_STEP = 16
"""The maximum side of a square: the sum of 16 x 16 values of 8 bits fits into 16 bits."""


class BadImageError(ValueError):
    """Raised if a message cannot be shown as an image.

    The message is meant for the status row ``Image`` of a display.
    """


@dataclass(frozen=True, slots=True)
class DecodedImage:
    """The pixels of an image, row by row from the top.

    Attributes:
        pixels: shape (height, width) for gray, (height, width, 3) for RGB, (height, width, 4) for RGBA.
    """

    pixels: Pixels

    @property
    def width(self) -> int:
        """The width in pixels."""
        return int(self.pixels.shape[1])

    @property
    def height(self) -> int:
        """The height in pixels."""
        return int(self.pixels.shape[0])

    @property
    def channels(self) -> int:
        """The number of channels: 1, 3 or 4."""
        return 1 if self.pixels.ndim == 2 else int(self.pixels.shape[2])

    def rgb(self) -> Pixels:
        """Return the pixels as RGB, shape (height, width, 3)."""
        if self.pixels.ndim == 2:
            return np.repeat(self.pixels[..., np.newaxis], 3, axis=2)
        return self.pixels[..., :3]

    def reduce_by(self, step: int) -> DecodedImage:
        """Return the image with one mean pixel for each square of `step` by `step` pixels.

        Pixels at the right and lower edges that do not fill a square are left out.

        Args:
            step: the side of a square in pixels; values above 16 count as 16.
        """
        step = min(step, _MAX_STEP)
        height, width = self.height // step, self.width // step
        if step == 1 or height == 0 or width == 0:
            return self
        pixels = self.pixels[: height * step, : width * step]
        row_sums = pixels[::step].astype(np.uint16)
        for row in range(1, step):
            row_sums += pixels[row::step]
        sums = row_sums[:, ::step].copy()
        for column in range(1, step):
            sums += row_sums[:, column::step]
        return DecodedImage((sums // step**2).astype(np.uint8))

    def subsample(self, max_pixels: int) -> DecodedImage:
        """Return every n-th pixel of each row and column.

        The result has at most `max_pixels` pixels, with the smallest possible n.
        """
        step = 1
        while -(-self.width // step) * -(-self.height // step) > max_pixels:
            step += 1
        return self if step == 1 else DecodedImage(np.ascontiguousarray(self.pixels[::step, ::step]))


def _reorder_channels(pixels: Pixels, order: Sequence[int]) -> Pixels:
    """Return the pixels with their channels in another order.

    Copying them one by one takes a fifth of the time of one indexing operation.
    """
    reordered = np.empty((*pixels.shape[:2], len(order)), pixels.dtype)
    for channel, source in enumerate(order):
        reordered[..., channel] = pixels[..., source]
    return reordered


def has_range(encoding: str) -> bool:
    """Return whether an encoding has more than 8 bits per value.

    RViz determines limits for black and white for such encodings.
    """
    return encoding in _RANGED_TYPES


def decode_image(message: Any, ranges: RangeFinder) -> DecodedImage:
    """Return the image of a message.

    Args:
        message: sensor_msgs/msg/Image.
        ranges: sets the black and white limits for values of more than 8 bits.

    Raises:
        BadImageError: the encoding is not supported, or there are too few bytes.
    """
    encoding = message.encoding
    if encoding in _RANGED_TYPES:
        return DecodedImage(_normalize(_read_rows(message, _RANGED_TYPES[encoding]), ranges))
    if encoding in _PLAIN_ENCODINGS:
        channels, order = _PLAIN_ENCODINGS[encoding]
        pixels = _read_rows(message, "u1", channels)
        return DecodedImage(pixels if order is None else _reorder_channels(pixels, order))
    if encoding.startswith("bayer_") and encoding[6:10] in ("rggb", "bggr", "gbrg", "grbg"):
        has_16_bits = encoding.endswith("16")
        mosaic = _read_rows(message, "u2" if has_16_bits else "u1")
        return DecodedImage(demosaic((mosaic >> 8).astype(np.uint8) if has_16_bits else mosaic, encoding[6:10]))
    if encoding in _YUV_CONVERTERS:
        return DecodedImage(_YUV_CONVERTERS[encoding](message))
    raise BadImageError(phrase("Unsupported image encoding [{encoding}]", encoding=encoding))


_RGB, _BGR, _RGBA, _BGRA = None, [2, 1, 0], None, [2, 1, 0, 3]

_PLAIN_ENCODINGS: dict[str, tuple[int, list[int] | None]] = {
    "rgb8": (3, _RGB),
    "rgba8": (4, _RGBA),
    "bgr8": (3, _BGR),
    "8UC3": (3, _BGR),
    "8SC3": (3, _BGR),
    "bgra8": (4, _BGRA),
    "8UC4": (4, _BGRA),
    "8SC4": (4, _BGRA),
    "mono8": (1, None),
    "8UC1": (1, None),
    "8SC1": (1, None),
}
_RANGED_TYPES = {"mono16": "u2", "16UC1": "u2", "16SC1": "i2", "32FC1": "f4"}


def _read_rows(message: Any, kind: str, channels: int = 1) -> NDArray[Any]:
    """Return the values of an image without the padding of its rows.

    Their shape is (height, width), or (height, width, channels) for several channels.
    """
    size = int(kind[1])
    row_bytes = message.width * channels * size
    step = message.step or row_bytes
    data = np.frombuffer(message.data, np.uint8)
    height = message.height
    if step < row_bytes or data.size < step * max(0, height - 1) + row_bytes * (height > 0):
        raise BadImageError(
            phrase(
                "The image has {size} bytes in rows of {step}, too few for {width} x {height} pixels of '{encoding}'",
                size=data.size,
                step=step,
                width=message.width,
                height=height,
                encoding=message.encoding,
            )
        )
    shape = (height, message.width) if channels == 1 else (height, message.width, channels)
    strides = (step, size) if channels == 1 else (step, channels * size, size)
    if data.size == 0:
        return np.empty(shape, kind)
    order = ">" if message.is_bigendian else "<"
    rows: NDArray[Any] = np.ndarray(shape, order + kind, data.data, 0, strides)
    return rows


@dataclass(frozen=True, slots=True)
class Range:
    """The values that are shown as black and as white."""

    black: float = 0.0
    white: float = 1.0


class RangeFinder:
    """Determines the black and white limits for the images of a stream.

    Attributes:
        fixed: the range to use; None to determine it from the images.
        window: the number of latest images over which the medians of minimum and maximum are computed.
    """

    def __init__(self) -> None:
        self.fixed: Range | None = None
        self.window = 5
        self._minima: deque[float] = deque()
        self._maxima: deque[float] = deque()

    def reset(self) -> None:
        """Forget earlier images, so that the next range does not depend on them."""
        self._minima.clear()
        self._maxima.clear()

    def update_range(self, values: NDArray[Any]) -> Range:
        """Add an image to the window, and return its range.

        Values that are not finite are ignored. A fixed range leaves the window unchanged.
        """
        if self.fixed is not None:
            return self.fixed
        minimum, maximum = (float(values.min()), float(values.max())) if values.size else (0.0, 0.0)
        if not np.isfinite(minimum + maximum):
            finite = values[np.isfinite(values)]
            minimum, maximum = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
        return Range(self._add_and_get_median(self._minima, minimum), self._add_and_get_median(self._maxima, maximum))

    def _add_and_get_median(self, values: deque[float], value: float) -> float:
        """Add a value to the values of the window, and return the median."""
        if self.window <= 1:
            return value
        while len(values) > self.window - 1:
            values.pop()
        values.appendleft(value)
        return sorted(values)[len(values) // 2]


def _normalize(values: NDArray[Any], ranges: RangeFinder) -> Pixels:
    limits = ranges.update_range(values)
    span = limits.white - limits.black
    if not span > 0.0:
        return np.zeros(values.shape, np.uint8)
    if values.dtype.itemsize == 2 and values.dtype.kind == "u":
        levels = np.arange(65536, dtype=np.float64)
        lookup_table = np.clip((levels - limits.black) / span * 255.0, 0.0, 255.0).astype(np.uint8)
        mapped: Pixels = lookup_table[values]
        return mapped
    scaled = values.astype(np.float32)
    scaled -= np.float32(limits.black)
    scaled /= np.float32(span)
    scaled *= np.float32(255.0)
    if not np.isfinite(scaled.sum(dtype=np.float64)):
        np.nan_to_num(scaled, copy=False, nan=0.0, posinf=255.0, neginf=0.0)
    np.clip(scaled, 0.0, 255.0, out=scaled)
    pixels: Pixels = scaled.astype(np.uint8)
    return pixels


def demosaic(mosaic: NDArray[Any], pattern: str) -> NDArray[Any]:
    """Return the RGB pixels of a Bayer mosaic, shape (height, width, 3), with the type of the mosaic.

    Each missing color is the mean of the neighbors that have it.

    Args:
        mosaic: unsigned integers of 8 or 16 bits, shape (height, width).
        pattern: the colors of the first two pixels of the first row, then of the second row, such as ``rggb``.
    """
    height, width = mosaic.shape
    if height < 2 or width < 2:
        return np.repeat(mosaic[..., np.newaxis], 3, axis=2)
    wider: type[np.unsignedinteger[Any]] = np.uint16 if mosaic.dtype.itemsize == 1 else np.uint32
    padded: NDArray[np.unsignedinteger[Any]] = np.pad(mosaic, 1, mode="reflect").astype(wider)
    neighbors = [padded[1 + dy : 1 + dy + height, 1 + dx : 1 + dx + width] for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    _, up, _, left, _, right, _, down, _ = neighbors
    horizontal = (left + right) >> 1
    vertical = (up + down) >> 1
    cross = (left + right + up + down) >> 2
    corners = (neighbors[0] + neighbors[2] + neighbors[6] + neighbors[8]) >> 2
    result = np.empty((height, width, 3), mosaic.dtype)
    for position, color in enumerate(pattern):
        rows, columns = slice(position // 2, None, 2), slice(position % 2, None, 2)
        known_color = mosaic[rows, columns]
        channels: tuple[NDArray[Any], ...]
        if color == "g":
            is_red_in_row = pattern[position ^ 1] == "r"
            red, blue = (horizontal, vertical) if is_red_in_row else (vertical, horizontal)
            channels = (red[rows, columns], known_color, blue[rows, columns])
        elif color == "r":
            channels = (known_color, cross[rows, columns], corners[rows, columns])
        else:
            channels = (corners[rows, columns], cross[rows, columns], known_color)
        for index, channel in enumerate(channels):
            result[rows, columns, index] = channel
    return result


def _make_packed_converter(first: str) -> Callable[[Any], Pixels]:
    return lambda message: packed_to_rgb(_read_rows(message, "u1", 2), first)


def _make_planar_converter(layout: str) -> Callable[[Any], Pixels]:
    def convert(message: Any) -> Pixels:
        width, height = message.width, message.height
        has_full_chroma = layout == "nv24"
        pairs = width if has_full_chroma else (width + 1) // 2
        step = message.step or (width if has_full_chroma else 2 * pairs)
        chroma_step, chroma_rows = (2 * step, height) if has_full_chroma else (step, (height + 1) // 2)
        data = np.frombuffer(message.data, np.uint8)
        required_size = step * height + chroma_step * chroma_rows
        if step < width or chroma_step < 2 * pairs or data.size < required_size or width == 0 or height == 0:
            raise BadImageError(
                phrase(
                    "The image has {size} bytes, too few for {width} x {height} pixels of '{layout}'",
                    size=data.size,
                    width=width,
                    height=height,
                    layout=layout,
                )
            )
        luma = data[: step * height].reshape(height, step)[:, :width]
        chroma = data[step * height : required_size].reshape(chroma_rows, chroma_step)[:, : 2 * pairs]
        return planar_to_rgb(luma, chroma, layout)

    return convert


_YUV_CONVERTERS: dict[str, Callable[[Any], Pixels]] = {
    "yuv422": _make_packed_converter("uyvy"),
    "uyvy": _make_packed_converter("uyvy"),
    "yuv422_yuy2": _make_packed_converter("yuyv"),
    "yuyv": _make_packed_converter("yuyv"),
    "nv21": _make_planar_converter("nv21"),
    "nv24": _make_planar_converter("nv24"),
}


def packed_to_rgb(pairs: Pixels, layout: str) -> Pixels:
    """Convert an image with shared chroma for each pair of pixels to RGB.

    Args:
        pairs: shape (height, width, 2): luma and one chroma value of each pixel, alternately for blue and red.
        layout: ``uyvy`` with the chroma first, or ``yuyv``.
    """
    luma, chroma = (pairs[..., 1], pairs[..., 0]) if layout == "uyvy" else (pairs[..., 0], pairs[..., 1])
    width = luma.shape[1]
    paired_chroma = chroma[:, : width - width % 2]
    blue, red = np.repeat(paired_chroma[:, 0::2], 2, axis=1), np.repeat(paired_chroma[:, 1::2], 2, axis=1)
    if width % 2 and width > 1:  # the last pixel of an odd row has no partner
        blue, red = (np.concatenate([channel, channel[:, -1:]], axis=1) for channel in (blue, red))
    elif width == 1:
        blue = red = np.full_like(luma, 128)
    return _yuv_to_rgb(luma, blue, red)


def planar_to_rgb(luma: Pixels, chroma: Pixels, layout: str) -> Pixels:
    """Convert an image with the chroma after the luma to RGB.

    Args:
        luma: shape (height, width).
        chroma: for ``nv21``, shape (height / 2, width), alternating red and blue for each 2 x 2 pixels; for ``nv24``,
            shape (height, 2 width), alternating blue and red for each pixel.
        layout: ``nv21`` or ``nv24``.
    """
    height, width = luma.shape
    if layout == "nv24":
        return _yuv_to_rgb(luma, chroma[:, 0::2], chroma[:, 1::2])
    red, blue = (
        np.repeat(np.repeat(channel, 2, axis=0), 2, axis=1)[:height, :width]
        for channel in (chroma[:, 0::2], chroma[:, 1::2])
    )
    return _yuv_to_rgb(luma, blue, red)


def _yuv_to_rgb(luma: Pixels, blue: Pixels, red: Pixels) -> Pixels:
    y = (luma.astype(np.int32) - 16) * 298
    b = blue.astype(np.int32) - 128
    r = red.astype(np.int32) - 128
    channels = ((y + 409 * r + 128) >> 8, (y - 100 * b - 208 * r + 128) >> 8, (y + 516 * b + 128) >> 8)
    result = np.empty((*luma.shape, 3), np.uint8)
    for index, channel in enumerate(channels):
        result[..., index] = np.clip(channel, 0, 255)
    return result
