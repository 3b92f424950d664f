"""Detections of vision_msgs, as they are read."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.vision.detections import Detections


def detections_of(message: Any) -> Detections:
    """What a vision_msgs/msg/Detection2DArray says, in its order: the best hypothesis of each detection."""
    best = [best_hypothesis(each) for each in message.detections]
    names = tuple(dict.fromkeys(name for name, _ in best))
    return Detections(
        np.array([box_of(each) for each in message.detections], np.float32).reshape(-1, 4),
        np.array([score for _, score in best], np.float32),
        np.array([names.index(name) for name, _ in best], np.int32),
        names,
    )


def best_hypothesis(detection: Any) -> tuple[str, float]:
    """The class and the score that a detection most likely has; no class where it says none."""
    if not detection.results:
        return "", 0.0
    best = max((each.hypothesis for each in detection.results), key=lambda each: float(each.score))
    return best.class_id, float(best.score)


def box_of(detection: Any) -> NDArray[np.float64]:
    """Left, top, right and bottom of a vision_msgs/msg/Detection2D, pixels: shape ``(4,)``."""
    middle, half = detection.bbox.center.position, (detection.bbox.size_x / 2, detection.bbox.size_y / 2)
    return np.array([middle.x - half[0], middle.y - half[1], middle.x + half[0], middle.y + half[1]], np.float64)
