"""Resample a stream to `RATE` without aliasing, in blocks, by a polyphase filter.

The filter is a sinc in a Kaiser window. Its pass band ends at 0.92 of half the lower rate; frequencies above that half
are attenuated by at least 60 dB. The output starts with the first sample of the input, without the filter's delay.
"""

from __future__ import annotations

from math import ceil, gcd

import numpy as np
from numpy.typing import NDArray

from linkwright.speech.sound.samples import RATE, Samples

MIN_RATE = 4_000
MAX_RATE = 384_000

_PASS_BAND = 0.92
"""The cutoff frequency as a fraction of half the lower sampling rate."""
_KAISER_BETA = 7.0
"""The shape parameter of the Kaiser window."""
_ZERO_CROSSINGS = 32  # the number of zero crossings of the sinc on each side
_BATCH_SAMPLES = 8_192  # the number of output samples per multiplication


class Resampler:
    """A resampler of a stream of any rate to `RATE`.

    Args:
        rate: the input rate in samples per second, `MIN_RATE` to `MAX_RATE`.
    """

    def __init__(self, rate: int) -> None:
        if not MIN_RATE <= rate <= MAX_RATE:
            raise ValueError(f"a rate of {rate} is not between {MIN_RATE} and {MAX_RATE}")
        divisor = gcd(rate, RATE)
        self._up, self._down = RATE // divisor, rate // divisor
        cutoff = _PASS_BAND * min(1.0, RATE / rate)
        half_length = ceil(_ZERO_CROSSINGS / cutoff)
        offsets = np.arange(-half_length + 1, half_length + 1)[None, :] - np.arange(self._up)[:, None] / self._up
        window = np.i0(_KAISER_BETA * np.sqrt(np.maximum(0.0, 1.0 - (offsets / half_length) ** 2))) / np.i0(
            _KAISER_BETA
        )
        taps = cutoff * np.sinc(cutoff * offsets) * window
        self._taps = taps / taps.sum(axis=1, keepdims=True)
        self._half_length = half_length
        self._buffer: NDArray[np.float64] = np.zeros(half_length - 1)
        self._position = 0  # the position of the next output in the buffer, in 1/up of an input sample

    def feed(self, values: NDArray[np.floating]) -> Samples:
        """Process the next block, shape ``(n,)``, full scale at 1, and return completed samples.

        The output is delayed by half the filter, 2 ms or less at usual rates. `flush` returns the rest.
        """
        self._buffer = np.concatenate((self._buffer, np.asarray(values, dtype=np.float64)))
        tap_count = self._taps.shape[1]
        last_position = (len(self._buffer) - tap_count) * self._up
        output_count = max(0, (last_position - self._position) // self._down + 1)
        output = np.empty(output_count)
        windows = (
            np.lib.stride_tricks.sliding_window_view(self._buffer, tap_count) if output_count else self._buffer[None]
        )
        for start in range(0, output_count, _BATCH_SAMPLES):
            positions = self._position + self._down * np.arange(start, min(output_count, start + _BATCH_SAMPLES))
            output[start : start + len(positions)] = np.einsum(
                "ij,ij->i", windows[positions // self._up], self._taps[positions % self._up]
            )
        self._position += output_count * self._down
        consumed = min(self._position // self._up, len(self._buffer))
        self._buffer = self._buffer[consumed:]
        self._position -= consumed * self._up
        return to_samples(output)

    def flush(self) -> Samples:
        """Return the samples that are still in the filter at the end of the stream."""
        return self.feed(np.zeros(self._half_length + 1))


def resample(values: NDArray[np.floating], rate: int) -> Samples:
    """Resample a recording, full scale at 1, shape ``(n,)``, to `RATE`.

    The duration changes by less than one sample.
    """
    if rate == RATE:
        return to_samples(values)
    resampler = Resampler(rate)
    length = ceil(len(values) * RATE / rate)
    return np.concatenate((resampler.feed(values), resampler.flush()))[:length]


def to_samples(values: NDArray[np.floating]) -> Samples:
    """Convert values with full scale at 1 to 16 bits.

    Values beyond full scale are clipped, and NaN becomes silence.
    """
    levels = np.rint(np.clip(np.nan_to_num(values, nan=0.0), -1.0, 1.0) * 32_768.0)
    return np.asarray(np.clip(levels, -32_768, 32_767), dtype=np.int16)
