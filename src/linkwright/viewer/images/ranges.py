"""Which values of an image are black and white: RViz's Normalize Range."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Range:
    """The values shown black and white."""

    black: float = 0.0
    white: float = 1.0


class RangeFinder:
    """Finds the range of the images of a stream.

    Attributes:
        fixed: the range to be used, or None to look for it in the images.
        window: over so many images the median of their least and largest values is taken.
    """

    def __init__(self) -> None:
        self.fixed: Range | None = None
        self.window = 5
        self._least: deque[float] = deque()
        self._largest: deque[float] = deque()

    def reset(self) -> None:
        """Forget the images before."""
        self._least.clear()
        self._largest.clear()

    def range_of(self, values: NDArray[Any]) -> Range:
        """The range for an image; values that are no numbers do not count."""
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
