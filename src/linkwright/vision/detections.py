"""Detections: boxes, scores and classes in an image."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Detections:
    """The boxes in one image, the most certain first.

    Attributes:
        boxes: shape ``(n, 4)``: left, top, right, bottom, in pixels of the image, where pixel 0 extends from 0 to 1.
            They reach beyond the edges of the image only if the detector documents it.
        scores: shape ``(n,)``, 0 to 1.
        classes: shape ``(n,)``, indices into `names`.
        names: the names of the detector's classes.
        corners: the corners of objects that have four, such as markers: shape ``(n, 4, 2)``, in pixels, in an order
            that the detector defines; None for other detectors.
    """

    boxes: NDArray[np.float32]
    scores: NDArray[np.float32]
    classes: NDArray[np.int32]
    names: tuple[str, ...]
    corners: NDArray[np.float32] | None = None

    def __len__(self) -> int:
        return len(self.scores)

    def name(self, index: int) -> str:
        """Return the class name of the detection at an index."""
        return self.names[int(self.classes[index])]

    @classmethod
    def empty(cls, names: tuple[str, ...]) -> Detections:
        """Return the detections of an image without objects."""
        return cls(np.zeros((0, 4), np.float32), np.zeros(0, np.float32), np.zeros(0, np.int32), names)
