"""Read detections of vision_msgs and yolo_msgs, and add tracker IDs and positions to them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from copy import copy
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.single import Transform
from linkwright.messages import get_message
from linkwright.vision.detections import Detections


class DetectionForm(ABC):
    """The format of a package's detection messages.

    Args:
        images: the type of messages with detections in an image.
        places: the type of messages with detections in metres.
    """

    def __init__(self, images: str, places: str) -> None:
        self.images, self.places = images, places

    def read(self, message: Any) -> Detections:
        """Return the detections of a message in its order, with the best hypothesis of each."""
        best = [self.best(detection) for detection in message.detections]
        names = tuple(dict.fromkeys(name for name, _ in best))
        return Detections(
            np.array([self.box(detection) for detection in message.detections], np.float32).reshape(-1, 4),
            np.array([score for _, score in best], np.float32),
            np.array([names.index(name) for name, _ in best], np.int32),
            names,
        )

    def with_id(self, detection: Any, number: int) -> Any:
        """Return a copy of a detection with the ID of a tracker."""
        tracked = copy(detection)
        tracked.id = str(number)
        return tracked

    @abstractmethod
    def best(self, detection: Any) -> tuple[str, float]:
        """Return the class and score of a detection's best hypothesis; the class is empty if there is none."""

    @abstractmethod
    def box(self, detection: Any) -> NDArray[np.float64]:
        """Return the left, top, right and bottom of a detection in pixels, shape ``(4,)``."""

    @abstractmethod
    def placed(self, detection: Any, header: Any, pose: Transform, size: tuple[float, float, float]) -> Any:
        """Return a detection with a box in metres, whose pose is in the frame of the header."""

    @abstractmethod
    def place(self, detection: Any) -> Any:
        """Return the box in metres of a detection: a message with ``center`` and ``size``."""


class _Vision(DetectionForm):
    """The format of vision_msgs: a detection has hypotheses, whose class is a string."""

    def best(self, detection: Any) -> tuple[str, float]:
        if not detection.results:
            return "", 0.0
        best = max((result.hypothesis for result in detection.results), key=lambda hypothesis: float(hypothesis.score))
        return best.class_id, float(best.score)

    def box(self, detection: Any) -> NDArray[np.float64]:
        return _corners(detection.bbox.center.position, detection.bbox.size_x, detection.bbox.size_y)

    def placed(self, detection: Any, header: Any, pose: Transform, size: tuple[float, float, float]) -> Any:
        made = get_message("vision_msgs/msg/Detection3D")(header=header, id=detection.id)
        _fill(made.bbox, pose, size)
        for hypothesis in detection.results:
            result = get_message("vision_msgs/msg/ObjectHypothesisWithPose")(hypothesis=hypothesis.hypothesis)
            result.pose.pose = made.bbox.center
            made.results.append(result)
        return made

    def place(self, detection: Any) -> Any:
        return detection.bbox


class _Yolo(DetectionForm):
    """The format of yolo_msgs: a detection has one class, and both a 2D box and a 3D box."""

    def best(self, detection: Any) -> tuple[str, float]:
        return detection.class_name, float(detection.score)

    def box(self, detection: Any) -> NDArray[np.float64]:
        return _corners(detection.bbox.center.position, detection.bbox.size.x, detection.bbox.size.y)

    def placed(self, detection: Any, header: Any, pose: Transform, size: tuple[float, float, float]) -> Any:
        made = copy(detection)
        made.bbox3d = get_message("yolo_msgs/msg/BoundingBox3D")(frame_id=header.frame_id)
        _fill(made.bbox3d, pose, size)
        return made

    def place(self, detection: Any) -> Any:
        return detection.bbox3d


VISION_FORM: DetectionForm = _Vision("vision_msgs/msg/Detection2DArray", "vision_msgs/msg/Detection3DArray")
YOLO_FORM: DetectionForm = _Yolo("yolo_msgs/msg/DetectionArray", "yolo_msgs/msg/DetectionArray")


def _corners(middle: Any, width: float, height: float) -> NDArray[np.float64]:
    half = width / 2, height / 2
    return np.array([middle.x - half[0], middle.y - half[1], middle.x + half[0], middle.y + half[1]], np.float64)


def _fill(box: Any, pose: Transform, size: tuple[float, float, float]) -> None:
    at = box.center
    at.position.x, at.position.y, at.position.z = pose[:3]
    at.orientation.x, at.orientation.y, at.orientation.z, at.orientation.w = pose[3:]
    box.size.x, box.size.y, box.size.z = size
