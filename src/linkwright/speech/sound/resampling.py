"""Resample a stream to `RATE` without aliasing, with a polyphase filter, block by block.

The filter is a sinc in a Kaiser window whose pass band ends at 0.92 of half the lower rate; frequencies above that half
are attenuated by at least 60 dB. The output starts with the first sample of the input: the filter's delay is removed.
"""

from __future__ import annotations

from math import ceil, gcd

import numpy as np
from numpy.typing import NDArray

from linkwright.speech.sound.samples import RATE, Samples

LOWEST_RATE = 4_000
HIGHEST_RATE = 384_000

_PASSED = 0.92
_KAISER = 7.0
_ZEROS = 32  # zero crossings of the sinc on each side
_AT_ONCE = 8_192  # output samples per multiplication


class Resampler:
    """Resamples a stream of any rate to `RATE`.

    Args:
        rate: the input rate in samples per second, `LOWEST_RATE` to `HIGHEST_RATE`.
    """

    def __init__(self, rate: int) -> None:
        if not LOWEST_RATE <= rate <= HIGHEST_RATE:
            raise ValueError(f"a rate of {rate} is not within {LOWEST_RATE} and {HIGHEST_RATE}")
        common = gcd(rate, RATE)
        self._up, self._down = RATE // common, rate // common
        cutoff = _PASSED * min(1.0, RATE / rate)
        half = ceil(_ZEROS / cutoff)
        offsets = np.arange(-half + 1, half + 1)[None, :] - np.arange(self._up)[:, None] / self._up
        window = np.i0(_KAISER * np.sqrt(np.maximum(0.0, 1.0 - (offsets / half) ** 2))) / np.i0(_KAISER)
        table = cutoff * np.sinc(cutoff * offsets) * window
        self._table = table / table.sum(axis=1, keepdims=True)
        self._half = half
        self._buffer: NDArray[np.float64] = np.zeros(half - 1)
        self._position = 0  # of the next output, in 1/up of an input sample, counted from the first one kept

    def feed(self, values: NDArray[np.floating]) -> Samples:
        """Process the next block, shape ``(n,)``, full scale at 1, and return the samples that result from it.

        They are delayed by half the filter, 2 ms or less at usual rates; `flush` returns the rest.
        """
        self._buffer = np.concatenate((self._buffer, np.asarray(values, dtype=np.float64)))
        taps = self._table.shape[1]
        ready = (len(self._buffer) - taps) * self._up
        count = max(0, (ready - self._position) // self._down + 1)
        found = np.empty(count)
        windows = np.lib.stride_tricks.sliding_window_view(self._buffer, taps) if count else self._buffer[None]
        for first in range(0, count, _AT_ONCE):
            at = self._position + self._down * np.arange(first, min(count, first + _AT_ONCE))
            found[first : first + len(at)] = np.einsum("ij,ij->i", windows[at // self._up], self._table[at % self._up])
        self._position += count * self._down
        passed = min(self._position // self._up, len(self._buffer))
        self._buffer = self._buffer[passed:]
        self._position -= passed * self._up
        return to_samples(found)

    def flush(self) -> Samples:
        """Return the samples that are still in the filter at the end of the stream."""
        return self.feed(np.zeros(self._half + 1))


def resample(values: NDArray[np.floating], rate: int) -> Samples:
    """Resample a complete sound, full scale at 1, shape ``(n,)``, to `RATE`.

    Its duration is kept to one sample.
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
    steps = np.rint(np.clip(np.nan_to_num(values, nan=0.0), -1.0, 1.0) * 32_768.0)
    return np.asarray(np.clip(steps, -32_768, 32_767), dtype=np.int16)
