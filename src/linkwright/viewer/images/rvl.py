"""RVL, the lossless compression of depth images by Wilson ("Fast Lossless Depth Image Compression", ISS 2017).

A stream is a row of numbers in groups of four bits: three of the number, the lowest first, and one that says that more
follow; eight groups make a little-endian word, the first group in its highest bits. The numbers are, over and over: how
many pixels are 0, how many then are not, and for each of those by how much it differs from the one before, with the
sign in the lowest bit.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_MOST_GROUPS = 10
"""Groups of a number: with more it would not fit into 32 bits."""


class BadRvlError(ValueError):
    """A stream is not what it should be; the text says what is wrong with it."""


def decoded(stream: NDArray[np.uint8], pixels: int) -> NDArray[np.uint16]:
    """The pixels of a stream, shape (pixels,).

    Args:
        stream: its bytes.
        pixels: how many there are to be.

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
        raise BadRvlError("it has a number of more than 30 bits")
    numbers: NDArray[np.int64] = (groups[starts] & 7).astype(np.int64)
    for place in range(1, longest):
        longer = np.flatnonzero(lengths > place)
        numbers[longer] |= (groups[starts[longer] + place] & 7).astype(np.int64) << (3 * place)
    return numbers


def _runs(numbers: NDArray[np.int64], pixels: int) -> tuple[list[int], list[int]]:
    """Where the two counts of each run stand among the numbers, and how long runs are: of 0, of others, of 0, ..."""
    heads: list[int] = []
    runs: list[int] = []
    read = numbers.data  # of a memoryview a single number is had faster than of an array
    at, left, count = 0, pixels, len(numbers)
    while left > 0:
        if at + 2 > count:
            raise BadRvlError(f"it ends {left} pixels too early")
        zeros, others = read[at], read[at + 1]
        if zeros == 0 and heads:
            raise BadRvlError("it has an empty run of pixels")
        left -= zeros + others
        heads.append(at)
        runs += (zeros, others)
        at += 2 + others
    if left < 0:
        raise BadRvlError(f"it has {-left} pixels too many")
    if at > count:
        raise BadRvlError(f"it ends {at - count} pixels too early")
    return heads, runs
