"""Detections: boxes, scores and classes in a picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Detections:
    """Boxes in one picture, the most certain first.

    Attributes:
        boxes: shape ``(n, 4)``: left, top, right, bottom, in pixels of the picture that was given, where pixel 0 is
            from 0 to 1. They may reach beyond its edges only where a detector says so.
        scores: shape ``(n,)``, 0 to 1.
        classes: shape ``(n,)``, places in `names`.
        names: of the classes that the detector knows.
        corners: of things that have four, such as markers: shape ``(n, 4, 2)``, in pixels, in their own order.
    """

    boxes: NDArray[np.float32]
    scores: NDArray[np.float32]
    classes: NDArray[np.int32]
    names: tuple[str, ...]
    corners: NDArray[np.float32] | None = None

    def __len__(self) -> int:
        return len(self.scores)

    def name(self, index: int) -> str:
        """The name of a detection's class."""
        return self.names[int(self.classes[index])]

    @classmethod
    def none(cls, names: tuple[str, ...]) -> Detections:
        """Detections of an empty picture."""
        return cls(np.zeros((0, 4), np.float32), np.zeros(0, np.float32), np.zeros(0, np.int32), names)
