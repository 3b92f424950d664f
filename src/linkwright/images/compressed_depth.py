"""The transport `compressedDepth`: a header, and the depths as a PNG of 16 bits or compressed by RVL.

It follows compressed_depth_image_transport. The header consists of an unused int32 and two float32. Depths that were
float32 are quantised to integers that grow as the distance decreases: ``depth = first / (number - second)``, and 0
where there is no depth. An RVL stream is preceded by its columns and rows, each a uint32.

RVL is the lossless compression of depth images by Wilson ("Fast Lossless Depth Image Compression", ISS 2017). A stream
is a sequence of numbers in groups of four bits: three bits of the number, the lowest first, and one bit that is set if
more groups follow. Eight groups make a little-endian word, the first group in its highest bits. The sequence repeats:
the number of pixels that are 0, the number of pixels that are not, and for each of the latter the difference from the
previous one, with the sign in the lowest bit.
"""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import foreign, phrase
from linkwright.images.decoding import BadImageError
from linkwright.images.image_files import MOST_PIXELS, RawImage, encoding_of, file_pixels

_HEADER = struct.Struct("<iff")
_RVL_SIZE = struct.Struct("<II")
_WHOLE, _FLOAT = ("16UC1", "mono16"), "32FC1"
_PACKINGS = {"": "png", "compressedDepth": "png", "compressedDepth png": "png", "compressedDepth rvl": "rvl"}
"""How the depths are packed, by the end of the format after the encoding; older publishers know only PNG."""


def unpacked_depth(message: Any) -> RawImage:
    """Return the depth image of a message.

    Args:
        message: sensor_msgs/msg/CompressedImage with a format such as ``16UC1; compressedDepth png``.

    Raises:
        BadImageError: the format is unknown, or the data does not match it.
    """
    encoding = encoding_of(message)
    packing = _PACKINGS.get(message.format.partition(";")[2].strip())
    if packing is None or encoding not in (*_WHOLE, _FLOAT):
        raise BadImageError(
            phrase(
                "The format of the depth image is '{format}'; supported are 16UC1, mono16 and 32FC1, each with "
                "'compressedDepth png' or 'compressedDepth rvl'",
                format=message.format,
            )
        )
    data = np.frombuffer(message.data, np.uint8)
    if data.size <= _HEADER.size:
        raise BadImageError(phrase("The depth image has {size} bytes, and no data after its header", size=data.size))
    _, first, second = _HEADER.unpack(data[: _HEADER.size].tobytes())
    rest = data[_HEADER.size :]
    numbers = _of_png(rest) if packing == "png" else _of_rvl(rest)
    if encoding == _FLOAT:
        return RawImage.of(message.header, _FLOAT, _depths(numbers, first, second))
    return RawImage.of(message.header, encoding, numbers)


def _of_png(data: NDArray[np.uint8]) -> NDArray[np.uint16]:
    pixels = file_pixels(data)
    if pixels.dtype != np.uint16:
        raise BadImageError(phrase("The depth image is not a PNG of 16 bits and one channel"))
    return pixels


def _of_rvl(data: NDArray[np.uint8]) -> NDArray[np.uint16]:
    if data.size < _RVL_SIZE.size:
        raise BadImageError(phrase("The RVL depth image ends before its size is given"))
    columns, rows = _RVL_SIZE.unpack(data[: _RVL_SIZE.size].tobytes())
    if not 0 < columns * rows <= MOST_PIXELS:
        raise BadImageError(
            phrase(
                "The header of the RVL depth image declares {columns} x {rows} pixels; 1 to {most} are supported",
                columns=columns,
                rows=rows,
                most=MOST_PIXELS,
            )
        )
    try:
        return decoded(data[_RVL_SIZE.size :], columns * rows).reshape(rows, columns)
    except BadRvlError as error:
        raise BadImageError(
            phrase(
                "The RVL depth image of {columns} x {rows} pixels cannot be read: {error}",
                columns=columns,
                rows=rows,
                error=foreign(error),
            )
        ) from None


def _depths(numbers: NDArray[np.uint16], first: float, second: float) -> NDArray[np.float32]:
    """Return the depths in metres, shape (height, width); NaN where there is no depth."""
    if not (np.isfinite(first) and np.isfinite(second) and first > 0.0):
        raise BadImageError(
            phrase(
                "The header of the depth image has no valid scale of the depths: {first:g}, {second:g}",
                first=first,
                second=second,
            )
        )
    every = np.arange(65536, dtype=np.float32)
    with np.errstate(divide="ignore"):
        metres = np.float32(first) / (every - np.float32(second))
    metres[0] = np.nan
    table: NDArray[np.float32] = metres[numbers]
    return table


_MOST_GROUPS = 10
"""Groups of a number: with more it would not fit into 32 bits."""


class BadRvlError(ValueError):
    """Raised when a stream is malformed; the text describes the error."""


def decoded(stream: NDArray[np.uint8], pixels: int) -> NDArray[np.uint16]:
    """Return the pixels of a stream, shape (pixels,).

    Args:
        stream: the bytes of the stream.
        pixels: the expected number of pixels.

    Raises:
        BadRvlError: the stream ends before its last pixel, or is not what an encoder writes.
    """
    numbers = _numbers(stream)
    heads, runs = _runs(numbers, pixels)
    end = heads[-1] + 2 + runs[-1] if heads else 0
    is_step = np.ones(end, np.bool_)
    is_step[heads] = False
    is_step[np.asarray(heads, np.intp) + 1] = False
    steps = numbers[:end][is_step]
    values = np.cumsum((steps >> 1) ^ -(steps & 1))
    result = np.zeros(pixels, np.uint16)
    result[np.repeat(np.arange(len(runs)) % 2 == 1, runs)] = values.astype(np.uint16)
    return result


def _numbers(stream: NDArray[np.uint8]) -> NDArray[np.int64]:
    words = np.frombuffer(stream[: len(stream) // 4 * 4].tobytes(), "<u4")
    groups = ((words[:, np.newaxis] >> np.arange(28, -4, -4).astype(np.uint32)) & 15).astype(np.uint8).ravel()
    ends = np.flatnonzero(groups < 8)
    starts = np.concatenate([[0], ends[:-1] + 1]) if len(ends) else ends
    lengths = ends - starts + 1
    longest = int(lengths.max(initial=0))
    if longest > _MOST_GROUPS:
        raise BadRvlError(phrase("it has a number of more than 30 bits"))
    numbers: NDArray[np.int64] = (groups[starts] & 7).astype(np.int64)
    for place in range(1, longest):
        longer = np.flatnonzero(lengths > place)
        numbers[longer] |= (groups[starts[longer] + place] & 7).astype(np.int64) << (3 * place)
    return numbers


def _runs(numbers: NDArray[np.int64], pixels: int) -> tuple[list[int], list[int]]:
    """Return the positions of the runs' counts among the numbers, and the run lengths.

    Each run has two counts. The lengths are those of zeros, others, zeros, and so on.
    """
    heads: list[int] = []
    runs: list[int] = []
    read = numbers.data  # Reading single numbers from a memoryview is faster than from an array.
    at, left, count = 0, pixels, len(numbers)
    while left > 0:
        if at + 2 > count:
            raise BadRvlError(phrase("it ends {left} pixels too early", left=left))
        zeros, others = read[at], read[at + 1]
        if zeros == 0 and heads:
            raise BadRvlError(phrase("it has an empty run of pixels"))
        left -= zeros + others
        heads.append(at)
        runs += (zeros, others)
        at += 2 + others
    if left < 0:
        raise BadRvlError(phrase("it has {left} pixels too many", left=-left))
    if at > count:
        raise BadRvlError(phrase("it ends {left} pixels too early", left=at - count))
    return heads, runs
