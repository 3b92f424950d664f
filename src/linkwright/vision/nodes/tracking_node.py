"""tracking_node: assigns persistent IDs to detected objects across images.

Source: yolo_ros 4 (the executable, the topics ``detections`` and ``tracking``). Its parameters are in a ByteTrack file
there, and parameters of the node here. Deliberate differences: it needs no images, and both topics are
vision_msgs/msg/Detection2DArray, except in the node with yolo_ros's own name.
"""

from __future__ import annotations

from typing import Any, ClassVar

from linkwright.graph import Graph, ParameterDescriptor
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, starting
from linkwright.nodes.settings import bad_value, log_unknown, positive
from linkwright.vision.nodes.detection_reading import VISION_FORM, YOLO_FORM, DetectionForm
from linkwright.vision.places.tracker import Tracker, TrackerSettings

_ANY = ParameterDescriptor(dynamic_typing=True)
_DEPTH = 10
_IMAGES_PER_SECOND = 30.0
"""The rate of images in which ``track_buffer`` counts."""


class TrackingNode(SingleNode):
    """The tracking node.

    Parameters: ``track_high_thresh``, ``track_low_thresh`` and ``new_track_thresh`` (scores), ``match_thresh`` (1 - IoU
    at most), ``track_buffer`` (how long an undetected object is kept, in images of 1/30 s), ``min_hits`` (consecutive
    images before an object gets an ID).

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201).
    """

    DEFAULT_NAME = "tracking_node"
    FORM: ClassVar[DetectionForm] = VISION_FORM
    IGNORED: ClassVar[tuple[str, ...]] = ("tracker",)  # a parameter of yolo_ros; here there is only one tracker

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        with starting(node):
            for name in self.IGNORED:
                node.declare_parameter(name, None, _ANY)
            self._tracker = Tracker(self._settings())
            log_unknown(node)
        self._array = get_message(self.FORM.images)
        self._publisher = node.create_publisher(self._array, "tracking", _DEPTH)
        node.create_subscription(self._array, "detections", self._receive, _DEPTH)

    def _settings(self) -> TrackerSettings:
        usual = TrackerSettings()
        return TrackerSettings(
            high=self._share("track_high_thresh", usual.high),
            low=self._share("track_low_thresh", usual.low),
            new=self._share("new_track_thresh", usual.new),
            match=self._share("match_thresh", usual.match),
            patience=self._positive("track_buffer", round(usual.patience * _IMAGES_PER_SECOND)) / _IMAGES_PER_SECOND,
            births=int(self._positive("min_hits", usual.births)),
        )

    def _share(self, name: str, usual: float) -> float:
        value: float = self._node.declare_parameter(name, usual).value
        if not 0.0 <= value <= 1.0:
            raise bad_value(name, value, self._node.get_name())
        return value

    def _positive(self, name: str, usual: int) -> float:
        return positive(self._node, name, self._node.declare_parameter(name, usual).value)

    def _receive(self, message: Any) -> None:
        ids = self._tracker.update(self.FORM.read(message), message.header.stamp.nanoseconds / 1e9)
        tracked = self._array(header=message.header)
        tracked.detections = [
            self.FORM.with_id(detection, number)
            for detection, number in zip(message.detections, ids, strict=True)
            if number
        ]
        self._publisher.publish(tracked)


class YoloTrackingNode(TrackingNode):
    """tracking_node of yolo_ros, whose topics are both yolo_msgs/msg/DetectionArray."""

    FORM = YOLO_FORM
    IGNORED = (*TrackingNode.IGNORED, "image_reliability")  # this tracker needs no images
