"""Read detection messages of several formats, and add tracker IDs and positions to them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from copy import copy
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.single import Transform
from linkwright.messages import get_message
from linkwright.vision.detections import Detections


class DetectionFormat(ABC):
    """The format of a package's detection messages.

    Args:
        image_type: the type of messages with boxes in images.
        position_type: the type of messages with boxes in meters.
    """

    def __init__(self, image_type: str, position_type: str) -> None:
        self.image_type, self.position_type = image_type, position_type

    def read(self, message: Any) -> Detections:
        """Return the detections of a message in the same order, each with its best hypothesis."""
        best = [self.find_best_hypothesis(detection) for detection in message.detections]
        names = tuple(dict.fromkeys(name for name, _ in best))
        return Detections(
            np.array([self.get_box(detection) for detection in message.detections], np.float32).reshape(-1, 4),
            np.array([score for _, score in best], np.float32),
            np.array([names.index(name) for name, _ in best], np.int32),
            names,
        )

    def with_track_id(self, detection: Any, track_id: int) -> Any:
        """Return a copy of a detection with the ID of a track."""
        tracked = copy(detection)
        tracked.id = str(track_id)
        return tracked

    @abstractmethod
    def find_best_hypothesis(self, detection: Any) -> tuple[str, float]:
        """Return the class and score of a detection's best hypothesis.

        The class is empty if there is no hypothesis.
        """

    @abstractmethod
    def get_box(self, detection: Any) -> NDArray[np.float64]:
        """Return the left, top, right and bottom of a detection in pixels, shape ``(4,)``."""

    @abstractmethod
    def with_position(self, detection: Any, header: Any, pose: Transform, size: tuple[float, float, float]) -> Any:
        """Return a detection with a box in meters, whose pose is in the frame of the header."""

    @abstractmethod
    def get_box_3d(self, detection: Any) -> Any:
        """Return the box in meters of a detection: a message with ``center`` and ``size``."""


class _VisionFormat(DetectionFormat):
    """The format of vision_msgs: a detection has hypotheses with classes as strings."""

    def find_best_hypothesis(self, detection: Any) -> tuple[str, float]:
        if not detection.results:
            return "", 0.0
        best_hypothesis = max(
            (result.hypothesis for result in detection.results), key=lambda hypothesis: float(hypothesis.score)
        )
        return best_hypothesis.class_id, float(best_hypothesis.score)

    def get_box(self, detection: Any) -> NDArray[np.float64]:
        return _compute_box_corners(detection.bbox.center.position, detection.bbox.size_x, detection.bbox.size_y)

    def with_position(self, detection: Any, header: Any, pose: Transform, size: tuple[float, float, float]) -> Any:
        positioned = get_message("vision_msgs/msg/Detection3D")(header=header, id=detection.id)
        _set_box(positioned.bbox, pose, size)
        for hypothesis in detection.results:
            result = get_message("vision_msgs/msg/ObjectHypothesisWithPose")(hypothesis=hypothesis.hypothesis)
            result.pose.pose = positioned.bbox.center
            positioned.results.append(result)
        return positioned

    def get_box_3d(self, detection: Any) -> Any:
        return detection.bbox


class _YoloFormat(DetectionFormat):
    """The format of yolo_msgs: a detection has one class, and both a 2D box and a 3D box."""

    def find_best_hypothesis(self, detection: Any) -> tuple[str, float]:
        return detection.class_name, float(detection.score)

    def get_box(self, detection: Any) -> NDArray[np.float64]:
        return _compute_box_corners(detection.bbox.center.position, detection.bbox.size.x, detection.bbox.size.y)

    def with_position(self, detection: Any, header: Any, pose: Transform, size: tuple[float, float, float]) -> Any:
        positioned = copy(detection)
        positioned.bbox3d = get_message("yolo_msgs/msg/BoundingBox3D")(frame_id=header.frame_id)
        _set_box(positioned.bbox3d, pose, size)
        return positioned

    def get_box_3d(self, detection: Any) -> Any:
        return detection.bbox3d


VISION_FORMAT: DetectionFormat = _VisionFormat("vision_msgs/msg/Detection2DArray", "vision_msgs/msg/Detection3DArray")
YOLO_FORMAT: DetectionFormat = _YoloFormat("yolo_msgs/msg/DetectionArray", "yolo_msgs/msg/DetectionArray")


def _compute_box_corners(center: Any, width: float, height: float) -> NDArray[np.float64]:
    half_size = width / 2, height / 2
    return np.array(
        [center.x - half_size[0], center.y - half_size[1], center.x + half_size[0], center.y + half_size[1]], np.float64
    )


def _set_box(box: Any, pose: Transform, size: tuple[float, float, float]) -> None:
    center = box.center
    center.position.x, center.position.y, center.position.z = pose[:3]
    center.orientation.x, center.orientation.y, center.orientation.z, center.orientation.w = pose[3:]
    box.size.x, box.size.y, box.size.z = size
