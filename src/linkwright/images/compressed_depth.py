"""The transport ``compressedDepth``: a header, then the depths as 16-bit PNG or RVL.

It follows compressed_depth_image_transport. The header consists of an unused int32 and two float32. Float32 depths are
quantized to integers, which grow as the distance decreases: ``depth = first / (number - second)``. 0 means that there
is no depth. An RVL stream is preceded by its columns and rows, each a uint32.

RVL is the lossless compression of depth images by Wilson ("Fast Lossless Depth Image Compression", ISS 2017). A stream
is a sequence of numbers in groups of four bits: three bits of the number, the lowest first, and one bit that is set if
more groups follow. Eight groups form a little-endian word, and the first group has the highest bits. The sequence
repeats: the number of zero pixels, the number of other pixels, and for each of the others the difference from the
previous one, with the sign in the lowest bit.
"""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import foreign, phrase
from linkwright.images.decoding import BadImageError
from linkwright.images.image_files import MAX_PIXELS, RawImage, decode_file, encoding_of

_HEADER = struct.Struct("<iff")
_RVL_SIZE = struct.Struct("<II")
_INTEGER_ENCODINGS, _FLOAT_ENCODING = ("16UC1", "mono16"), "32FC1"
_PACKINGS = {"": "png", "compressedDepth": "png", "compressedDepth png": "png", "compressedDepth rvl": "rvl"}
"""The packing of the depths by the part of the format after the encoding. Older publishers only use PNG."""


def decode_depth(message: Any) -> RawImage:
    """Return the depth image of a compressed message.

    Args:
        message: sensor_msgs/msg/CompressedImage with a format such as ``16UC1; compressedDepth png``.

    Raises:
        BadImageError: the format is not supported, or the data does not match it.
    """
    encoding = encoding_of(message)
    packing = _PACKINGS.get(message.format.partition(";")[2].strip())
    if packing is None or encoding not in (*_INTEGER_ENCODINGS, _FLOAT_ENCODING):
        raise BadImageError(
            phrase(
                "The format of the depth image is '{format}', but only 16UC1, mono16 and "
                "32FC1 are supported, each with 'compressedDepth png' or 'compressedDepth "
                "rvl'",
                format=message.format,
            )
        )
    data = np.frombuffer(message.data, np.uint8)
    if data.size <= _HEADER.size:
        raise BadImageError(
            phrase("The depth image has {size} bytes, so it has no data after its header", size=data.size)
        )
    _, scale, offset = _HEADER.unpack(data[: _HEADER.size].tobytes())
    payload = data[_HEADER.size :]
    numbers = _decode_png(payload) if packing == "png" else _decode_rvl(payload)
    if encoding == _FLOAT_ENCODING:
        return RawImage.of(message.header, _FLOAT_ENCODING, _dequantize(numbers, scale, offset))
    return RawImage.of(message.header, encoding, numbers)


def _decode_png(data: NDArray[np.uint8]) -> NDArray[np.uint16]:
    pixels = decode_file(data)
    if pixels.dtype != np.uint16:
        raise BadImageError(phrase("The depth image is not a PNG of 16 bits and one channel"))
    return pixels


def _decode_rvl(data: NDArray[np.uint8]) -> NDArray[np.uint16]:
    if data.size < _RVL_SIZE.size:
        raise BadImageError(phrase("The RVL depth image is too short to contain its size"))
    columns, rows = _RVL_SIZE.unpack(data[: _RVL_SIZE.size].tobytes())
    if not 0 < columns * rows <= MAX_PIXELS:
        raise BadImageError(
            phrase(
                "The header of the RVL depth image declares {columns} x {rows} pixels; 1 to {maximum} are supported",
                columns=columns,
                rows=rows,
                maximum=MAX_PIXELS,
            )
        )
    try:
        return decode_rvl(data[_RVL_SIZE.size :], columns * rows).reshape(rows, columns)
    except BadRvlError as error:
        raise BadImageError(
            phrase(
                "The RVL depth image of {columns} x {rows} pixels cannot be read: {error}",
                columns=columns,
                rows=rows,
                error=foreign(error),
            )
        ) from None


def _dequantize(numbers: NDArray[np.uint16], first: float, offset: float) -> NDArray[np.float32]:
    """Return the depths in meters, shape (height, width), with NaN for pixels without a depth."""
    if not (np.isfinite(first) and np.isfinite(offset) and first > 0.0):
        raise BadImageError(
            phrase(
                "The header of the depth image has an invalid scale of the depths: {scale:g}, {offset:g}",
                scale=first,
                offset=offset,
            )
        )
    all_numbers = np.arange(65536, dtype=np.float32)
    with np.errstate(divide="ignore"):
        meters = np.float32(first) / (all_numbers - np.float32(offset))
    meters[0] = np.nan
    depths: NDArray[np.float32] = meters[numbers]
    return depths


_MAX_GROUPS = 10
"""The maximum number of groups of a number: more would not fit into 32 bits."""


class BadRvlError(ValueError):
    """Raised when a stream is malformed, with a description of the error."""


def decode_rvl(stream: NDArray[np.uint8], pixels: int) -> NDArray[np.uint16]:
    """Return the pixels of an RVL stream, shape (pixels,).

    Args:
        stream: the bytes of the stream after its size.
        pixels: the expected number of pixels.

    Raises:
        BadRvlError: the stream ends before its last pixel, has too many pixels, or is malformed.
    """
    numbers = _read_numbers(stream)
    count_positions, runs = _read_runs(numbers, pixels)
    end = count_positions[-1] + 2 + runs[-1] if count_positions else 0
    is_step = np.ones(end, np.bool_)
    is_step[count_positions] = False
    is_step[np.asarray(count_positions, np.intp) + 1] = False
    steps = numbers[:end][is_step]
    values = np.cumsum((steps >> 1) ^ -(steps & 1))
    result = np.zeros(pixels, np.uint16)
    result[np.repeat(np.arange(len(runs)) % 2 == 1, runs)] = values.astype(np.uint16)
    return result


def _read_numbers(stream: NDArray[np.uint8]) -> NDArray[np.int64]:
    words = np.frombuffer(stream[: len(stream) // 4 * 4].tobytes(), "<u4")
    groups = ((words[:, np.newaxis] >> np.arange(28, -4, -4).astype(np.uint32)) & 15).astype(np.uint8).ravel()
    ends = np.flatnonzero(groups < 8)
    starts = np.concatenate([[0], ends[:-1] + 1]) if len(ends) else ends
    lengths = ends - starts + 1
    max_groups = int(lengths.max(initial=0))
    if max_groups > _MAX_GROUPS:
        raise BadRvlError(phrase("it contains a number of more than 30 bits"))
    numbers: NDArray[np.int64] = (groups[starts] & 7).astype(np.int64)
    for group in range(1, max_groups):
        continuing = np.flatnonzero(lengths > group)
        numbers[continuing] |= (groups[starts[continuing] + group] & 7).astype(np.int64) << (3 * group)
    return numbers


def _read_runs(numbers: NDArray[np.int64], pixels: int) -> tuple[list[int], list[int]]:
    """Return the positions of the runs' counts among the numbers, and the lengths of the runs.

    Each run of zeros and the run after it share one position. Runs of zeros alternate with others, zeros first.
    """
    count_positions: list[int] = []
    runs: list[int] = []
    values = numbers.data  # Reading single numbers from a memoryview is faster than from an array.
    position, remaining, count = 0, pixels, len(numbers)
    while remaining > 0:
        if position + 2 > count:
            raise BadRvlError(phrase("it ends {count} pixels too early", count=remaining))
        zeros, nonzeros = values[position], values[position + 1]
        if zeros == 0 and count_positions:
            raise BadRvlError(phrase("it has an empty run of pixels"))
        remaining -= zeros + nonzeros
        count_positions.append(position)
        runs += (zeros, nonzeros)
        position += 2 + nonzeros
    if remaining < 0:
        raise BadRvlError(phrase("it has {count} pixels too many", count=-remaining))
    if position > count:
        raise BadRvlError(phrase("it ends {count} pixels too early", count=position - count))
    return count_positions, runs
