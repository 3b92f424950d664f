"""Non-maximum suppression: keep the most certain of overlapping boxes of one class."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

MAX_CANDIDATES = 30_000
"""The maximum number of boxes to compare (Ultralytics' ``max_nms``). The least certain boxes are dropped."""


def non_maximum_suppression(
    boxes: NDArray[np.float32], scores: NDArray[np.float32], classes: NDArray[np.int32], iou: float, max_boxes: int
) -> NDArray[np.intp]:
    """Return the indices of the boxes to keep, the most certain first.

    Args:
        boxes: shape ``(n, 4)``: left, top, right, bottom.
        scores: shape ``(n,)``.
        classes: shape ``(n,)``; boxes of different classes do not suppress each other.
        iou: the intersection over union above which two boxes of a class count as the same object.
        max_boxes: the maximum number of boxes to keep.

    Returns:
        Indices into `boxes`.
    """
    remaining = np.argsort(-scores, kind="stable")[:MAX_CANDIDATES]
    areas = (boxes[:, 2] - boxes[:, 0]) * (boxes[:, 3] - boxes[:, 1])
    kept_indices: list[int] = []
    while remaining.size and len(kept_indices) < max_boxes:
        best, remaining = remaining[0], remaining[1:]
        kept_indices.append(int(best))
        remaining_boxes = boxes[remaining]
        width = np.minimum(boxes[best, 2], remaining_boxes[:, 2]) - np.maximum(boxes[best, 0], remaining_boxes[:, 0])
        height = np.minimum(boxes[best, 3], remaining_boxes[:, 3]) - np.maximum(boxes[best, 1], remaining_boxes[:, 1])
        intersection = np.maximum(width, 0) * np.maximum(height, 0)
        union = areas[best] + areas[remaining] - intersection
        # An untrained network also outputs boxes without area.
        is_same_object = (union > 0) & (intersection > iou * union)
        remaining = remaining[~(is_same_object & (classes[remaining] == classes[best]))]
    return np.asarray(kept_indices, np.intp)
