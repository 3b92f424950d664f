"""tracking_node: assigns persistent IDs to detected objects across images.

Source: yolo_ros 4 (the executable, the topics ``detections`` and ``tracking``). There the parameters are in a ByteTrack
file; here they are parameters of the node. Deliberate differences: it needs no images, and both topics are
vision_msgs/msg/Detection2DArray, except in the node with yolo_ros's own name.
"""

from __future__ import annotations

from typing import Any, ClassVar

from linkwright.graph import Graph, ParameterDescriptor
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import check_positive, invalid_value_error, log_unknown_parameters
from linkwright.vision.nodes.detection_formats import VISION_FORMAT, YOLO_FORMAT, DetectionFormat
from linkwright.vision.places.tracker import Tracker, TrackerSettings

_ANY_TYPE = ParameterDescriptor(dynamic_typing=True)
_QUEUE_DEPTH = 10
_IMAGES_PER_SECOND = 30.0
"""The images per second to which ``track_buffer`` refers."""


class TrackingNode(SingleNode):
    """The node that assigns persistent IDs to detections.

    Parameters:

    - ``track_high_thresh``, ``track_low_thresh``, ``new_track_thresh``: scores.
    - ``match_thresh``: the maximum of 1 - IoU for two boxes of the same object.
    - ``track_buffer``: how long an undetected object is kept, in images of 1/30 s.
    - ``min_hits``: the number of consecutive images that must show an object before it gets an ID.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201).
    """

    DEFAULT_NAME = "tracking_node"
    DETECTION_FORMAT: ClassVar[DetectionFormat] = VISION_FORMAT
    IGNORED: ClassVar[tuple[str, ...]] = ("tracker",)  # a parameter of yolo_ros; here there is only one tracker

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        with handle_start_errors(node):
            for name in self.IGNORED:
                node.declare_parameter(name, None, _ANY_TYPE)
            self._tracker = Tracker(self._read_settings())
            log_unknown_parameters(node)
        self._array = get_message(self.DETECTION_FORMAT.image_type)
        self._publisher = node.create_publisher(self._array, "tracking", _QUEUE_DEPTH)
        node.create_subscription(self._array, "detections", self._receive, _QUEUE_DEPTH)

    def _read_settings(self) -> TrackerSettings:
        defaults = TrackerSettings()
        return TrackerSettings(
            high_threshold=self._declare_share("track_high_thresh", defaults.high_threshold),
            low_threshold=self._declare_share("track_low_thresh", defaults.low_threshold),
            new_track_score=self._declare_share("new_track_thresh", defaults.new_track_score),
            match_threshold=self._declare_share("match_thresh", defaults.match_threshold),
            max_age=self._declare_positive("track_buffer", round(defaults.max_age * _IMAGES_PER_SECOND))
            / _IMAGES_PER_SECOND,
            min_hits=int(self._declare_positive("min_hits", defaults.min_hits)),
        )

    def _declare_share(self, name: str, default: float) -> float:
        value: float = self._node.declare_parameter(name, default).value
        if not 0.0 <= value <= 1.0:
            raise invalid_value_error(name, value, self._node.get_name())
        return value

    def _declare_positive(self, name: str, default: int) -> float:
        return check_positive(self._node, name, self._node.declare_parameter(name, default).value)

    def _receive(self, message: Any) -> None:
        ids = self._tracker.update(self.DETECTION_FORMAT.read(message), message.header.stamp.nanoseconds / 1e9)
        tracked = self._array(header=message.header)
        tracked.detections = [
            self.DETECTION_FORMAT.with_track_id(detection, track_id)
            for detection, track_id in zip(message.detections, ids, strict=True)
            if track_id
        ]
        self._publisher.publish(tracked)


class YoloTrackingNode(TrackingNode):
    """The node tracking_node of yolo_ros, with yolo_msgs/msg/DetectionArray on both topics."""

    DETECTION_FORMAT = YOLO_FORMAT
    IGNORED = (*TrackingNode.IGNORED, "image_reliability")  # this tracker needs no images
