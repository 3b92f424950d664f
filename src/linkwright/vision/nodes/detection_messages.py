"""Convert detections and images to messages."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.messages import get_message
from linkwright.vision.detections import Detections
from linkwright.vision.nodes.dialects import VISION, YOLO


def vision_message(header: Any, detections: Detections) -> Any:
    """Convert detections to vision_msgs/msg/Detection2DArray, with class names as ``class_id``."""
    detection_class, hypothesis_class = (
        get_message("vision_msgs/msg/Detection2D"),
        get_message("vision_msgs/msg/ObjectHypothesisWithPose"),
    )
    detection_messages = []
    for index, (x, y, width, height) in enumerate(_compute_centers_and_sizes(detections)):
        result = hypothesis_class()
        result.hypothesis.class_id = detections.name(index)
        result.hypothesis.score = float(detections.scores[index])
        detection = detection_class(header=header, results=[result])
        detection.bbox.center.position.x, detection.bbox.center.position.y = x, y
        detection.bbox.size_x, detection.bbox.size_y = width, height
        detection_messages.append(detection)
    return get_message(VISION)(header=header, detections=detection_messages)


def yolo_message(header: Any, detections: Detections) -> Any:
    """Convert detections to yolo_msgs/msg/DetectionArray."""
    detection_class = get_message("yolo_msgs/msg/Detection")
    detection_messages = []
    for index, (x, y, width, height) in enumerate(_compute_centers_and_sizes(detections)):
        detection = detection_class(class_id=int(detections.classes[index]), class_name=detections.name(index))
        detection.score = float(detections.scores[index])
        detection.bbox.center.position.x, detection.bbox.center.position.y = x, y
        detection.bbox.size.x, detection.bbox.size.y = width, height
        detection_messages.append(detection)
    return get_message(YOLO)(header=header, detections=detection_messages)


MESSAGE_MAKERS: Mapping[str, Callable[[Any, Detections], Any]] = {VISION: vision_message, YOLO: yolo_message}
"""The functions that convert detections to messages, by message type."""


def image_message(header: Any, image: NDArray[np.uint8]) -> Any:
    """Convert an image, shape ``(height, width, 3)``, to sensor_msgs/msg/Image."""
    message = get_message("sensor_msgs/msg/Image")(header=header, encoding="rgb8")
    message.height, message.width, _ = image.shape
    message.step = 3 * message.width
    message.data = np.ascontiguousarray(image).reshape(-1)
    return message


def _compute_centers_and_sizes(detections: Detections) -> list[list[float]]:
    """Return the center x and y, the width and the height of each box, in pixels."""
    corners = detections.boxes.astype(np.float64)
    centers, sizes = (corners[:, :2] + corners[:, 2:]) / 2, corners[:, 2:] - corners[:, :2]
    rows: list[list[float]] = np.hstack([centers, sizes]).tolist()
    return rows
