"""Mel spectra of a stream, for voice activity detection and recognition.

Windows of 25 ms every 10 ms, a first-order pre-emphasis, and 26 triangular bands from 80 to 7600 Hz of equal width on
the mel scale (O'Shaughnessy's, as in HTK).
"""

from __future__ import annotations

from math import log10
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from linkwright.speech.sound.samples import RATE, Samples

HOP_LENGTH = RATE // 100
"""The number of samples from one frame to the next: 10 ms."""

WINDOW_LENGTH = RATE // 40
"""The number of samples from which a frame is computed: 25 ms."""

BANDS = 26

Powers: TypeAlias = NDArray[np.float64]
"""The power of each band, shape ``(frames, BANDS)``.

The scale is such that white noise with an RMS of one 16-bit step has the power 1.
"""

_FFT_SIZE = 512
_MIN_FREQUENCY_HZ, _MAX_FREQUENCY_HZ = 80.0, 7600.0  # the range of the bands in Hz
_PRE_EMPHASIS = 0.97


class MelFrames:
    """The frames of a stream, computed from blocks of any length."""

    def __init__(self) -> None:
        self._buffer: NDArray[np.float64] = np.zeros(0)
        self._last_sample = 0.0

    def feed(self, samples: Samples) -> Powers:
        """Process the next block, and return the frames that it completes, possibly none."""
        if not len(samples):
            return np.zeros((0, BANDS))
        values = samples.astype(np.float64)
        emphasized = values.copy()
        emphasized[0] -= _PRE_EMPHASIS * self._last_sample
        emphasized[1:] -= _PRE_EMPHASIS * values[:-1]
        self._last_sample = float(values[-1])
        self._buffer = np.concatenate((self._buffer, emphasized))
        count = (len(self._buffer) - WINDOW_LENGTH) // HOP_LENGTH + 1
        if count <= 0:
            return np.zeros((0, BANDS))
        frames = np.lib.stride_tricks.sliding_window_view(self._buffer, WINDOW_LENGTH)[
            : (count - 1) * HOP_LENGTH + 1 : HOP_LENGTH
        ]
        spectrum = np.abs(np.fft.rfft(frames * _NORMALIZED_WINDOW, _FFT_SIZE)) ** 2
        self._buffer = self._buffer[count * HOP_LENGTH :]
        powers: Powers = spectrum @ _FILTERS
        return powers


def extract_mel_frames(samples: Samples) -> Powers:
    """Return the frames of a recording."""
    return MelFrames().feed(samples)


def _make_mel_filters() -> NDArray[np.float64]:
    """Return the filters of the mel bands, shape ``(_FFT_SIZE // 2 + 1, BANDS)``.

    Each filter sums to 1, so that white noise is equal in all bands.
    """
    min_mel, max_mel = (2595.0 * log10(1.0 + hertz / 700.0) for hertz in (_MIN_FREQUENCY_HZ, _MAX_FREQUENCY_HZ))
    mel = np.linspace(min_mel, max_mel, BANDS + 2)
    edges = 700.0 * (10.0 ** (mel / 2595.0) - 1.0)
    frequencies = np.arange(_FFT_SIZE // 2 + 1) * RATE / _FFT_SIZE
    rising = (frequencies[:, None] - edges[None, :-2]) / np.diff(edges)[:-1]
    falling = (edges[None, 2:] - frequencies[:, None]) / np.diff(edges)[1:]
    bands = np.maximum(0.0, np.minimum(rising, falling))
    return np.asarray(bands / bands.sum(axis=0))


_HAMMING = np.hamming(WINDOW_LENGTH)
_NORMALIZED_WINDOW = _HAMMING / np.sqrt(np.sum(_HAMMING**2))
_FILTERS = _make_mel_filters()
