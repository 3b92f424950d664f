"""Non-maximum suppression: keep the most certain of overlapping boxes of one class."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

MOST_CANDIDATES = 30_000
"""The greatest number of boxes to compare, the most certain ones, as Ultralytics' ``max_nms``."""


def suppressed(
    boxes: NDArray[np.float32], scores: NDArray[np.float32], classes: NDArray[np.int32], iou: float, most: int
) -> NDArray[np.intp]:
    """Return the indices of the boxes to keep, the most certain first.

    Args:
        boxes: shape ``(n, 4)``: left, top, right, bottom.
        scores: shape ``(n,)``.
        classes: shape ``(n,)``; boxes of different classes do not suppress each other.
        iou: two boxes of a class with a larger intersection over union are the same object.
        most: the maximum number of boxes to keep.

    Returns:
        Indices in `boxes`, at most `most`.
    """
    left = np.argsort(-scores, kind="stable")[:MOST_CANDIDATES]
    areas = (boxes[:, 2] - boxes[:, 0]) * (boxes[:, 3] - boxes[:, 1])
    kept: list[int] = []
    while left.size and len(kept) < most:
        first, left = left[0], left[1:]
        kept.append(int(first))
        others = boxes[left]
        width = np.minimum(boxes[first, 2], others[:, 2]) - np.maximum(boxes[first, 0], others[:, 0])
        height = np.minimum(boxes[first, 3], others[:, 3]) - np.maximum(boxes[first, 1], others[:, 1])
        common = np.maximum(width, 0) * np.maximum(height, 0)
        union = areas[first] + areas[left] - common
        same = (union > 0) & (common > iou * union)  # an untrained network also outputs boxes without area
        left = left[~(same & (classes[left] == classes[first]))]
    return np.asarray(kept, np.intp)
