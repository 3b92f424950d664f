"""Detected objects with their colors, in a fixed frame."""

from __future__ import annotations

from collections import Counter, OrderedDict, deque
from dataclasses import dataclass
from typing import Any

from linkwright.geometry.single import compose
from linkwright.graph import SENSOR_DATA_QOS, Node
from linkwright.images import BadImageError, RangeFinder, decode_image
from linkwright.messages import get_message
from linkwright.nodes.frame_poses import FramePoses
from linkwright.vision.nodes.detection_formats import VISION_FORMAT
from linkwright.vision.places.object_colors import find_object_color

_QUEUE_DEPTH = 10
_MAX_IMAGES = 10
_MAX_TRACKS = 200
_MAX_VOTES = 30


@dataclass(frozen=True, slots=True)
class SeenObject:
    """An object in the latest detections.

    Attributes:
        name: the name of its class.
        id: the ID from the tracker; empty if there is none.
        color: the word for its color; None if it is unknown.
        x, y: the position of its center in the fixed frame, meters.
        radius: half its width, meters.
        aspect_ratio: its width divided by its height.
        score: the score of its detection.
        seen_ns: the time of the image, nanoseconds.
    """

    name: str
    id: str
    color: str | None
    x: float
    y: float
    radius: float
    aspect_ratio: float
    score: float
    seen_ns: int


class SeenObjects:
    """The collection of detections with positions, and with the colors of objects from images.

    The color is measured in the box with the same ID in ``image_raw``; boxes with IDs arrive on ``tracking``.

    Args:
        node: the node that subscribes.
        poses: looks up transforms between frames.
        fixed_frame: the frame of the positions.

    Attributes:
        objects: the objects in the latest image.
        last_detections_ns: the time of the node's clock at which detections arrived last; None before the first.
    """

    def __init__(self, node: Node, poses: FramePoses, fixed_frame: str) -> None:
        self._node, self._poses, self._frame = node, poses, fixed_frame
        self.objects: list[SeenObject] = []
        self.last_detections_ns: int | None = None
        self._images: deque[Any] = deque(maxlen=_MAX_IMAGES)
        self._votes: OrderedDict[str, Counter[str]] = OrderedDict()
        self._ranges = RangeFinder()
        node.create_subscription(
            get_message("sensor_msgs/msg/Image"), "image_raw", self._images.append, SENSOR_DATA_QOS
        )
        node.create_subscription(
            get_message("vision_msgs/msg/Detection2DArray"), "tracking", self._receive_tracking, _QUEUE_DEPTH
        )
        node.create_subscription(
            get_message("vision_msgs/msg/Detection3DArray"), "detections_3d", self._receive, _QUEUE_DEPTH
        )

    def _receive_tracking(self, message: Any) -> None:
        """Count votes for the colors of objects that have IDs."""
        time_ns = message.header.stamp.nanoseconds
        image = next((candidate for candidate in self._images if candidate.header.stamp.nanoseconds == time_ns), None)
        if image is None or not any(detection.id for detection in message.detections):
            return
        try:
            pixels = decode_image(image, self._ranges).pixels
        except BadImageError:
            return
        if pixels.ndim != 3:
            return
        for detection in message.detections:
            color = find_object_color(pixels[:, :, :3], VISION_FORMAT.get_box(detection)) if detection.id else None
            if color is not None:
                votes = self._votes.setdefault(detection.id, Counter())
                votes[color] += 1
                if votes.total() > _MAX_VOTES:
                    self._votes[detection.id] = Counter({name: count // 2 for name, count in votes.items()})
                self._votes.move_to_end(detection.id)
        while len(self._votes) > _MAX_TRACKS:
            self._votes.popitem(last=False)

    def _receive(self, message: Any) -> None:
        self.last_detections_ns = self._node.get_clock().now().nanoseconds
        time_ns = message.header.stamp.nanoseconds
        self.objects = []
        pose = self._poses.pose(self._frame, message.header.frame_id, time_ns) if message.detections else None
        if pose is None:
            return
        for detection in message.detections:
            center = detection.bbox.center.position
            x, y, *_ = compose(pose, (center.x, center.y, center.z, 0.0, 0.0, 0.0, 1.0))
            color_votes = self._votes.get(detection.id)
            color = color_votes.most_common(1)[0][0] if color_votes else None
            name, score = VISION_FORMAT.find_best_hypothesis(detection)
            size = detection.bbox.size
            aspect_ratio = size.y / size.z if size.z > 0 else 1.0
            self.objects.append(SeenObject(name, detection.id, color, x, y, size.y / 2, aspect_ratio, score, time_ns))
