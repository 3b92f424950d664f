"""A display of images, overlaid with the boxes of a vision_msgs/Detection2DArray."""

from __future__ import annotations

import asyncio
from collections import deque
from functools import partial
from typing import Any

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.page.protocol.detections import ImageBoxes
from linkwright.rviz.config.property_store import qos_from_properties
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, Schema, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.base.topic_display import SideTopic
from linkwright.rviz.displays.class_colors import choose_class_color
from linkwright.rviz.displays.detections import find_best_result
from linkwright.rviz.displays.detector_threshold import DetectorThreshold
from linkwright.rviz.displays.image import ImageDisplay

DETECTIONS = "Detections Topic"
THRESHOLD = "Threshold"
_DETECTIONS_TYPE = "vision_msgs/msg/Detection2DArray"
_BOXES_KEY = "boxes"
_MAX_IMAGES = 10
"""The largest number of images that wait for their detections."""

_DETECTION_TIMEOUT_S = 1.0
"""After this many seconds without detections, images are shown as soon as they arrive."""


class DetectionImageDisplay(ImageDisplay):
    """A display of images in a separate panel, with boxes around the detected objects.

    While detections arrive, each image is stored until the detections with the same stamp arrive. Images are therefore
    delayed by the processing time of the detector. Detections for an image that is no longer stored are drawn over the
    current image.
    """

    CLASS = "linkwright/Detections"
    SCHEMA = (
        *ImageDisplay.SCHEMA,
        topic_spec(DETECTIONS, "/yolo/detections", _DETECTIONS_TYPE, messages=(_DETECTIONS_TYPE,)),
        PropertySpec(
            THRESHOLD,
            "float",
            0.0,
            "The minimum score of detections. Their node applies it if it has a parameter 'threshold'; "
            "otherwise the display does.",
            minimum=0.0,
            maximum=1.0,
        ),
        PropertySpec("Show Score", "bool", True, "Write class and score above each box."),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._detections_topic = SideTopic(host, _DETECTIONS_TYPE, self._on_detections)
        self._threshold = DetectorThreshold(host.context.node, partial(self.set_status_row, THRESHOLD))
        self._images: deque[Any] = deque(maxlen=_MAX_IMAGES)
        self._last_detection_time = float("-inf")

    def schema(self) -> Schema:
        """Return the properties of an image display and of the boxes."""
        return (*super().schema(), *self.SCHEMA[len(ImageDisplay.SCHEMA) :])

    def on_property_changed(self, path: Path) -> None:
        """Subscribe to other detections, or apply a new threshold."""
        super().on_property_changed(path)
        if path[0] == DETECTIONS:
            self._threshold.close()
            self.delete_status_row(THRESHOLD)
            if self.enabled:
                self._subscribe_detections()
        elif path[0] == THRESHOLD and self.enabled:
            self._threshold.set(self.properties.text(DETECTIONS).strip(), self.properties.number(THRESHOLD))

    def process_image(self, message: Any, pose: Pose | None) -> None:
        """Store an image until its detections arrive, or show it if no detections arrived recently."""
        if asyncio.get_running_loop().time() - self._last_detection_time < _DETECTION_TIMEOUT_S:
            self._images.append(message)
            return
        self._images.clear()
        self.remove_content(_BOXES_KEY)
        super().process_image(message, pose)

    def on_time_changed(self) -> None:
        """Show the messages that were queued while time was paused."""
        self._detections_topic.resume()
        super().on_time_changed()

    def reset(self) -> None:
        """Discard the image and the boxes."""
        self._images.clear()
        self._last_detection_time = float("-inf")
        super().reset()

    def _subscribe(self) -> None:
        super()._subscribe()
        self._subscribe_detections()

    def _unsubscribe(self) -> None:
        super()._unsubscribe()
        self._detections_topic.close()
        self._threshold.close()

    def _subscribe_detections(self) -> None:
        topic = self.properties.text(DETECTIONS).strip()
        problem = (
            self._detections_topic.listen(topic, qos_from_properties(self.properties, DETECTIONS))
            if topic
            else phrase("Empty topic name")
        )
        if problem:
            self.set_status_row(DETECTIONS, "error", problem)
        else:
            self.delete_status_row(DETECTIONS)

    def _on_detections(self, message: Any) -> None:
        self._last_detection_time = asyncio.get_running_loop().time()
        _, stamp_ns = self.frame_of(message)
        image = next((image for image in self._images if self.frame_of(image)[1] == stamp_ns), None)
        content = _make_boxes(message, of_image=image is not None)
        if content is None:
            self.set_status_row(
                DETECTIONS, "error", phrase("Message contained invalid floating point values (nans or infs)")
            )
            return
        self.delete_status_row(DETECTIONS)
        self.send(content, key=_BOXES_KEY, stamp_ns=stamp_ns)
        if image is not None:
            while self._images.popleft() is not image:
                pass
            super().process_image(image, None)


def _make_boxes(message: Any, *, of_image: bool) -> ImageBoxes | None:
    """Return the boxes of a Detection2DArray, or None if a number is not finite.

    Args:
        message: the detections.
        of_image: whether the boxes belong to the next image, which is still stored.
    """
    detections = list(message.detections)
    results = [find_best_result(detection) for detection in detections]
    centers = [detection.bbox.center for detection in detections]
    boxes = np.array(
        [
            (center.position.x, center.position.y, detection.bbox.size_x, detection.bbox.size_y, center.theta)
            for center, detection in zip(centers, detections, strict=True)
        ],
        dtype=np.float32,
    ).reshape(-1, 5)
    if not np.isfinite(boxes).all():
        return None
    colors = np.array([choose_class_color(name, {}) for name, _ in results], dtype=np.uint8).reshape(-1, 3)
    scores = np.array([score for _, score in results], dtype=np.float32)
    return ImageBoxes(boxes, colors, scores, [name for name, _ in results], of_image)
