"""Samples of one series that wait to be sent to a page."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

MOST_SENT = 256
"""Samples of a series in one frame; thirty frames a second hold a topic of 7 kHz in full."""

_MOST_WAITING = 4096


class SampleQueue:
    """Gathers samples until they are taken. It never becomes long: what is too much is thinned out."""

    def __init__(self) -> None:
        self._received: list[float] = []
        self._stamps: list[float] = []
        self._values: list[float] = []

    def __len__(self) -> int:
        return len(self._values)

    def add(self, received: float, stamp: float, value: float) -> None:
        """Add a sample: when it was received and the stamp of its header (NaN for none), seconds, and the value."""
        self._received.append(received)
        self._stamps.append(stamp)
        self._values.append(value)
        if len(self._values) >= _MOST_WAITING:
            kept = thinned(self._array(), MOST_SENT).tolist()
            self._received, self._stamps, self._values = kept

    def take(self) -> NDArray[np.float64]:
        """All of them, thinned out to what a frame may hold: array, shape (3, M); the queue is empty then."""
        taken = thinned(self._array(), MOST_SENT)
        self._received, self._stamps, self._values = [], [], []
        return taken

    def _array(self) -> NDArray[np.float64]:
        return np.array([self._received, self._stamps, self._values], dtype=np.float64)


def thinned(samples: NDArray[Any], most: int) -> NDArray[Any]:
    """At most so many of the samples, so that a plot of them looks the same.

    Of each of equal shares in a row the least and the greatest value stay, in their order.

    Args:
        samples: array, shape (3, M); values are in the last row.
        most: an even number of samples to keep.
    """
    count = samples.shape[1]
    if count <= most:
        return samples
    values = samples[-1]
    unknown = np.isnan(values)
    edges = np.linspace(0, count, most // 2 + 1).astype(np.int64)
    kept: set[int] = set()
    for start, stop in pairwise(edges):
        share, gap = values[start:stop], unknown[start:stop]
        kept.add(int(start + np.argmin(np.where(gap, np.inf, share))))
        kept.add(int(start + np.argmax(np.where(gap, -np.inf, share))))
    return samples[:, sorted(kept)]
