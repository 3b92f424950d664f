"""A detector for tests without a network or library.

It returns one box around all pixels of one color.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.graph import SENSOR_DATA_QOS, Graph
from linkwright.images import RangeFinder, decode_image
from linkwright.messages import get_message
from linkwright.vision.places.object_colors import COLORS, classify_colors

_MIN_PIXELS = 60


class ColorDetector:
    """A node that finds one object: all pixels of a color.

    Args:
        graph: the graph of the node.
        color: one of `COLORS`.
        name: the class of the object.
    """

    def __init__(self, graph: Graph, color: str = "red", name: str = "ball") -> None:
        self._color, self._name = COLORS.index(color), name
        self.node = graph.create_node("color_detector")
        self._array = get_message("vision_msgs/msg/Detection2DArray")
        self._publisher = self.node.create_publisher(self._array, "/yolo/detections", 10)
        self._ranges = RangeFinder()
        self.subscription = self.node.create_subscription(
            get_message("sensor_msgs/msg/Image"), "/camera/image_raw", self._see, SENSOR_DATA_QOS
        )

    def _see(self, image: Any) -> None:
        pixels = decode_image(image, self._ranges).pixels[:, :, :3]
        names = classify_colors(pixels.reshape(-1, 3)).reshape(pixels.shape[:2])
        rows, columns = np.nonzero(names == self._color)
        array = self._array(header=image.header)
        if len(rows) >= _MIN_PIXELS:
            left, right = np.percentile(columns, [1, 99])
            top, bottom = np.percentile(rows, [1, 99])
            array.detections.append(detection(image.header, left, top, right + 1, bottom + 1, self._name))
        self._publisher.publish(array)


def detection(header: Any, left: float, top: float, right: float, bottom: float, name: str, score: float = 0.9) -> Any:
    """Return a vision_msgs/msg/Detection2D of a box."""
    message = get_message("vision_msgs/msg/Detection2D")(header=header)
    message.bbox.center.position.x, message.bbox.center.position.y = (left + right) / 2, (top + bottom) / 2
    message.bbox.size_x, message.bbox.size_y = float(right - left), float(bottom - top)
    result = get_message("vision_msgs/msg/ObjectHypothesisWithPose")()
    result.hypothesis.class_id, result.hypothesis.score = name, score
    message.results = [result]
    return message


def yolo_detection(left: float, top: float, right: float, bottom: float, name: str, score: float) -> Any:
    """Return a yolo_msgs/msg/Detection of a box of class 4."""
    message = get_message("yolo_msgs/msg/Detection")(class_id=4, class_name=name, score=score)
    message.bbox.center.position.x, message.bbox.center.position.y = (left + right) / 2, (top + bottom) / 2
    message.bbox.size.x, message.bbox.size.y = float(right - left), float(bottom - top)
    return message
