"""Convert detections and images to messages."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.messages import get_message
from linkwright.vision.detections import Detections
from linkwright.vision.nodes.dialects import VISION, YOLO


def vision_message(header: Any, found: Detections) -> Any:
    """Convert detections to vision_msgs/msg/Detection2DArray, with the class name as ``class_id``."""
    one, hypothesis = (
        get_message("vision_msgs/msg/Detection2D"),
        get_message("vision_msgs/msg/ObjectHypothesisWithPose"),
    )
    detections = []
    for index, (x, y, width, height) in enumerate(_centres(found)):
        result = hypothesis()
        result.hypothesis.class_id = found.name(index)
        result.hypothesis.score = float(found.scores[index])
        detection = one(header=header, results=[result])
        detection.bbox.center.position.x, detection.bbox.center.position.y = x, y
        detection.bbox.size_x, detection.bbox.size_y = width, height
        detections.append(detection)
    return get_message(VISION)(header=header, detections=detections)


def yolo_message(header: Any, found: Detections) -> Any:
    """Convert detections to yolo_msgs/msg/DetectionArray."""
    one = get_message("yolo_msgs/msg/Detection")
    detections = []
    for index, (x, y, width, height) in enumerate(_centres(found)):
        detection = one(class_id=int(found.classes[index]), class_name=found.name(index))
        detection.score = float(found.scores[index])
        detection.bbox.center.position.x, detection.bbox.center.position.y = x, y
        detection.bbox.size.x, detection.bbox.size.y = width, height
        detections.append(detection)
    return get_message(YOLO)(header=header, detections=detections)


MESSAGES: Mapping[str, Callable[[Any, Detections], Any]] = {VISION: vision_message, YOLO: yolo_message}
"""The functions that make messages, by type."""


def image_message(header: Any, image: NDArray[np.uint8]) -> Any:
    """Convert an image, shape ``(height, width, 3)``, to sensor_msgs/msg/Image."""
    message = get_message("sensor_msgs/msg/Image")(header=header, encoding="rgb8")
    message.height, message.width, _ = image.shape
    message.step = 3 * message.width
    message.data = np.ascontiguousarray(image).reshape(-1)
    return message


def _centres(found: Detections) -> list[list[float]]:
    """Return the centre and size of each box, in pixels."""
    corners = found.boxes.astype(np.float64)
    middle, size = (corners[:, :2] + corners[:, 2:]) / 2, corners[:, 2:] - corners[:, :2]
    rows: list[list[float]] = np.hstack([middle, size]).tolist()
    return rows
