"""Conversion of sensor_msgs/msg/Image to 8-bit grey, RGB or RGBA pixels.

Video cameras send luma and chroma (ITU-R BT.601, studio range); images taken through a Bayer filter are demosaiced;
grey values of more than 8 bits are scaled by a range, as RViz's Normalize Range does.
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

_LARGEST_STEP = 16
"""So many times so many values of 8 bits make one of 16 bits."""


class BadImageError(ValueError):
    """Raised when a message cannot be shown as an image.

    The text is for the status row ``Image``.
    """


@dataclass(frozen=True, slots=True)
class DecodedImage:
    """The pixels of an image, row by row from the top.

    Attributes:
        pixels: shape (height, width) for grey, (height, width, 3) for RGB, (height, width, 4) for RGBA.
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

    def reduced(self, step: int) -> DecodedImage:
        """Return the image reduced to one pixel, the mean, for each square of `step` by `step` pixels.

        The remainder at the edges is left out.

        Args:
            step: the side of a square; values above 16 count as 16.
        """
        step = min(step, _LARGEST_STEP)
        height, width = self.height // step, self.width // step
        if step == 1 or height == 0 or width == 0:
            return self
        pixels = self.pixels[: height * step, : width * step]
        rows = pixels[::step].astype(np.uint16)
        for row in range(1, step):
            rows += pixels[row::step]
        total = rows[:, ::step].copy()
        for column in range(1, step):
            total += rows[:, column::step]
        return DecodedImage((total // step**2).astype(np.uint8))

    def thinned(self, most_pixels: int) -> DecodedImage:
        """Return every n-th pixel of each row and column, with the smallest n for at most `most_pixels` pixels."""
        step = 1
        while -(-self.width // step) * -(-self.height // step) > most_pixels:
            step += 1
        return self if step == 1 else DecodedImage(np.ascontiguousarray(self.pixels[::step, ::step]))


def _reordered(pixels: Pixels, order: Sequence[int]) -> Pixels:
    """Return the channels in another order.

    Copying them one by one takes a fifth of the time of one indexing operation.
    """
    out = np.empty((*pixels.shape[:2], len(order)), pixels.dtype)
    for channel, source in enumerate(order):
        out[..., channel] = pixels[..., source]
    return out


def has_range(encoding: str) -> bool:
    """Return whether RViz determines a black and white limit for an encoding: one of more than 8 bits."""
    return encoding in _RANGED


def decode_image(message: Any, ranges: RangeFinder) -> DecodedImage:
    """Return the image of a message.

    Args:
        message: sensor_msgs/msg/Image.
        ranges: sets the black and white limits for values of more than 8 bits.

    Raises:
        BadImageError: the encoding is unknown, or there are too few bytes.
    """
    encoding = message.encoding
    if encoding in _RANGED:
        return DecodedImage(_normalized(_rows(message, _RANGED[encoding]), ranges))
    if encoding in _PLAIN:
        channels, order = _PLAIN[encoding]
        pixels = _rows(message, "u1", channels)
        return DecodedImage(pixels if order is None else _reordered(pixels, order))
    if encoding.startswith("bayer_") and encoding[6:10] in ("rggb", "bggr", "gbrg", "grbg"):
        deep = encoding.endswith("16")
        mosaic = _rows(message, "u2" if deep else "u1")
        return DecodedImage(demosaiced((mosaic >> 8).astype(np.uint8) if deep else mosaic, encoding[6:10]))
    if encoding in _YUV:
        return DecodedImage(_YUV[encoding](message))
    raise BadImageError(phrase("Unsupported image encoding [{encoding}]", encoding=encoding))


_RGB, _BGR, _RGBA, _BGRA = None, [2, 1, 0], None, [2, 1, 0, 3]

_PLAIN: dict[str, tuple[int, list[int] | None]] = {
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
_RANGED = {"mono16": "u2", "16UC1": "u2", "16SC1": "i2", "32FC1": "f4"}


def _rows(message: Any, kind: str, channels: int = 1) -> NDArray[Any]:
    """Return the values of an image whose rows may be padded.

    The shape is (height, width) or (height, width, channels).
    """
    size = int(kind[1])
    row = message.width * channels * size
    step = message.step or row
    data = np.frombuffer(message.data, np.uint8)
    height = message.height
    if step < row or data.size < step * max(0, height - 1) + row * (height > 0):
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
    """The values that are shown as black and white."""

    black: float = 0.0
    white: float = 1.0


class RangeFinder:
    """Finds the range of the images of a stream.

    Attributes:
        fixed: the range to use; None to determine it from the images.
        window: the number of images whose minimum and maximum values are combined by the median.
    """

    def __init__(self) -> None:
        self.fixed: Range | None = None
        self.window = 5
        self._least: deque[float] = deque()
        self._largest: deque[float] = deque()

    def reset(self) -> None:
        """Reset the search, so that the next range does not depend on earlier images."""
        self._least.clear()
        self._largest.clear()

    def range_of(self, values: NDArray[Any]) -> Range:
        """Return the range for an image; values that are not finite numbers are ignored."""
        if self.fixed is not None:
            return self.fixed
        least, largest = (float(values.min()), float(values.max())) if values.size else (0.0, 0.0)
        if not np.isfinite(least + largest):
            finite = values[np.isfinite(values)]
            least, largest = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
        return Range(self._median(self._least, least), self._median(self._largest, largest))

    def _median(self, seen: deque[float], value: float) -> float:
        if self.window <= 1:
            return value
        while len(seen) > self.window - 1:
            seen.pop()
        seen.appendleft(value)
        return sorted(seen)[len(seen) // 2]


def _normalized(values: NDArray[Any], ranges: RangeFinder) -> Pixels:
    found = ranges.range_of(values)
    span = found.white - found.black
    if not span > 0.0:
        return np.zeros(values.shape, np.uint8)
    if values.dtype.itemsize == 2 and values.dtype.kind == "u":
        steps = np.arange(65536, dtype=np.float64)
        table = np.clip((steps - found.black) / span * 255.0, 0.0, 255.0).astype(np.uint8)
        looked_up: Pixels = table[values]
        return looked_up
    scaled = values.astype(np.float32)
    scaled -= np.float32(found.black)
    scaled /= np.float32(span)
    scaled *= np.float32(255.0)
    if not np.isfinite(scaled.sum(dtype=np.float64)):
        np.nan_to_num(scaled, copy=False, nan=0.0, posinf=255.0, neginf=0.0)
    np.clip(scaled, 0.0, 255.0, out=scaled)
    pixels: Pixels = scaled.astype(np.uint8)
    return pixels


def demosaiced(mosaic: Pixels, pattern: str) -> Pixels:
    """Return RGB pixels, shape (height, width, 3).

    Missing colours are the mean of the neighbours that have them.

    Args:
        mosaic: shape (height, width).
        pattern: the colours of the first two pixels of the first and the second row, such as ``rggb``.
    """
    height, width = mosaic.shape
    if height < 2 or width < 2:
        return np.repeat(mosaic[..., np.newaxis], 3, axis=2)
    padded = np.pad(mosaic, 1, mode="reflect").astype(np.uint16)
    around = [padded[1 + dy : 1 + dy + height, 1 + dx : 1 + dx + width] for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    _, up, _, left, _, right, _, down, _ = around
    sideways = (left + right) >> 1
    upright = (up + down) >> 1
    cross = (left + right + up + down) >> 2
    corners = (around[0] + around[2] + around[6] + around[8]) >> 2
    result = np.empty((height, width, 3), np.uint8)
    for place, colour in enumerate(pattern):
        rows, columns = slice(place // 2, None, 2), slice(place % 2, None, 2)
        own = mosaic[rows, columns]
        parts: tuple[NDArray[Any], ...]
        if colour == "g":
            red_in_row = pattern[place ^ 1] == "r"
            red, blue = (sideways, upright) if red_in_row else (upright, sideways)
            parts = (red[rows, columns], own, blue[rows, columns])
        elif colour == "r":
            parts = (own, cross[rows, columns], corners[rows, columns])
        else:
            parts = (corners[rows, columns], cross[rows, columns], own)
        for index, part in enumerate(parts):
            result[rows, columns, index] = part
    return result


def _packed_yuv(first: str) -> Callable[[Any], Pixels]:
    return lambda message: from_packed(_rows(message, "u1", 2), first)


def _planar_yuv(layout: str) -> Callable[[Any], Pixels]:
    def convert(message: Any) -> Pixels:
        width, height = message.width, message.height
        full = layout == "nv24"
        pairs = width if full else (width + 1) // 2
        step = message.step or (width if full else 2 * pairs)
        chroma_step, chroma_rows = (2 * step, height) if full else (step, (height + 1) // 2)
        data = np.frombuffer(message.data, np.uint8)
        needed = step * height + chroma_step * chroma_rows
        if step < width or chroma_step < 2 * pairs or data.size < needed or width == 0 or height == 0:
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
        rest = data[step * height : needed].reshape(chroma_rows, chroma_step)[:, : 2 * pairs]
        return from_nv(luma, rest, layout)

    return convert


_YUV: dict[str, Callable[[Any], Pixels]] = {
    "yuv422": _packed_yuv("uyvy"),
    "uyvy": _packed_yuv("uyvy"),
    "yuv422_yuy2": _packed_yuv("yuyv"),
    "yuyv": _packed_yuv("yuyv"),
    "nv21": _planar_yuv("nv21"),
    "nv24": _planar_yuv("nv24"),
}


def from_packed(pairs: Pixels, layout: str) -> Pixels:
    """Convert an image whose pixels share chroma in pairs to RGB.

    Args:
        pairs: shape (height, width, 2): luma and one chroma of each pixel, alternately blue's and red's.
        layout: ``uyvy`` with the chroma first, or ``yuyv``.
    """
    luma, chroma = (pairs[..., 1], pairs[..., 0]) if layout == "uyvy" else (pairs[..., 0], pairs[..., 1])
    width = luma.shape[1]
    even = chroma[:, : width - width % 2]
    blue, red = np.repeat(even[:, 0::2], 2, axis=1), np.repeat(even[:, 1::2], 2, axis=1)
    if width % 2 and width > 1:  # The last pixel of an odd row has no partner.
        blue, red = (np.concatenate([part, part[:, -1:]], axis=1) for part in (blue, red))
    elif width == 1:
        blue = red = np.full_like(luma, 128)
    return _rgb(luma, blue, red)


def from_nv(luma: Pixels, chroma: Pixels, layout: str) -> Pixels:
    """Convert an image with the chroma after the luma to RGB.

    Args:
        luma: shape (height, width).
        chroma: for ``nv21``, shape (height / 2, width), alternating red and blue for each 2 x 2 pixels; for ``nv24``,
            shape (height, 2 width), alternating blue and red for each pixel.
        layout: ``nv21`` or ``nv24``.
    """
    height, width = luma.shape
    if layout == "nv24":
        return _rgb(luma, chroma[:, 0::2], chroma[:, 1::2])
    red, blue = (
        np.repeat(np.repeat(part, 2, axis=0), 2, axis=1)[:height, :width] for part in (chroma[:, 0::2], chroma[:, 1::2])
    )
    return _rgb(luma, blue, red)


def _rgb(luma: Pixels, blue: Pixels, red: Pixels) -> Pixels:
    y = (luma.astype(np.int32) - 16) * 298
    b = blue.astype(np.int32) - 128
    r = red.astype(np.int32) - 128
    parts = ((y + 409 * r + 128) >> 8, (y - 100 * b - 208 * r + 128) >> 8, (y + 516 * b + 128) >> 8)
    result = np.empty((*luma.shape, 3), np.uint8)
    for index, part in enumerate(parts):
        result[..., index] = np.clip(part, 0, 255)
    return result
