"""Select detections that satisfy limits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from linkwright.vision.detections import Detections
from linkwright.vision.detector import Limits


def select_detections(
    boxes: Sequence[Sequence[float]],
    scores: Sequence[float],
    classes: Sequence[int],
    names: tuple[str, ...],
    limits: Limits,
    corners: Sequence[object] | None = None,
) -> Detections:
    """Return the detections within the limits, the highest score first.

    Args:
        boxes: left, top, right, bottom of each detection.
        scores: the score of each detection.
        classes: the class of each detection, an index in `names`.
        names: the names of the classes.
        limits: the limits that detections must satisfy.
        corners: the four corners of each detection; None if the objects have none.
    """
    allowed = [
        index
        for index, score in enumerate(scores)
        if score >= limits.threshold and (limits.classes is None or names[classes[index]] in limits.classes)
    ]
    selected = sorted(allowed, key=lambda index: -scores[index])[: limits.max_detections]
    return Detections(
        np.array([boxes[index] for index in selected], np.float32).reshape(-1, 4),
        np.array([scores[index] for index in selected], np.float32),
        np.array([classes[index] for index in selected], np.int32),
        names,
        None if corners is None else np.array([corners[index] for index in selected], np.float32).reshape(-1, 4, 2),
    )
