"""detect_3d_node: computes the positions of detected objects in metres.

Source: yolo_ros 4 (the executable, the topics ``detections``, ``depth_image``, ``depth_info`` and ``detections_3d``,
the parameters, and that messages up to half a second apart are matched). Deliberate differences: detections are those
of vision_msgs, except in the node with yolo_ros's own name; depth images of 32FC1 are in metres regardless of the
divisor, as in REP 118; and with a ``ground_frame``, objects without a known depth are placed where their boxes touch
the ground.
"""

from __future__ import annotations

from collections import deque
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.single import Transform, compose, rotate
from linkwright.graph import DEFAULT_QOS, SENSOR_DATA_QOS, Graph
from linkwright.messages import get_message
from linkwright.nodes.frame_poses import FramePoses
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, starting
from linkwright.nodes.settings import log_unknown, positive
from linkwright.perception.nodes.depthimage_to_laserscan import depths_of
from linkwright.vision.detectors.drawing import colour_of
from linkwright.vision.nodes.detection_reading import VISION_FORM, YOLO_FORM, DetectionForm
from linkwright.vision.places.camera import CameraModel, camera_model
from linkwright.vision.places.positions import Place, place_by_depth, place_on_ground

_DEPTH = 10
_KEPT = 10
"""Depth images that may still get their detections."""
_SLOP_NS = 500_000_000
_RELIABLE = 1
_MILLIMETRES = 1000
_SECONDS_BETWEEN_COMPLAINTS = 5.0
_MARKER_SECONDS = 1
_LABEL_METRES = 0.12
_FORWARD = (0.5, -0.5, 0.5, 0.5)
"""Axes with x forward and z up in those of an optical frame, as a quaternion."""


class Detect3DNode(SingleNode):
    """The detect_3d_node node.

    Parameters: ``target_frame`` (of the result), ``depth_image_units_divisor`` (units per metre in images of 16UC1),
    ``maximum_detection_threshold`` (the largest difference in depth from the middle of the object's surface, metres),
    ``depth_image_reliability`` and ``depth_info_reliability`` (1 reliable, 2 best effort), ``ground_frame`` (its x and
    y span the ground; empty to place no objects on the ground), ``maximum_distance`` (metres).

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201).
    """

    DEFAULT_NAME = "detect_3d_node"
    FORM: ClassVar[DetectionForm] = VISION_FORM

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        declare = node.declare_parameter
        with starting(node):
            self._target: str = declare("target_frame", "base_link").value
            divisor = positive(node, "depth_image_units_divisor", declare("depth_image_units_divisor", 1000).value)
            self._spread = positive(
                node, "maximum_detection_threshold", declare("maximum_detection_threshold", 0.3).value
            )
            self._farthest = positive(node, "maximum_distance", declare("maximum_distance", 20.0).value)
            self._ground: str = declare("ground_frame", "").value
            image_qos, info_qos = (
                DEFAULT_QOS if declare(name, 2).value == _RELIABLE else SENSOR_DATA_QOS
                for name in ("depth_image_reliability", "depth_info_reliability")
            )
            log_unknown(node)
        self._unit = _MILLIMETRES / divisor
        self._poses = FramePoses(node, "the positions of detections are unknown:")
        self._depths: deque[Any] = deque(maxlen=_KEPT)
        self._cameras: dict[str, CameraModel] = {}
        self._array = get_message(self.FORM.places)
        self._publisher = node.create_publisher(self._array, "detections_3d", _DEPTH)
        self._markers = node.create_publisher(get_message("visualization_msgs/msg/MarkerArray"), "markers", _DEPTH)
        info = get_message("sensor_msgs/msg/CameraInfo")
        node.create_subscription(get_message("sensor_msgs/msg/Image"), "depth_image", self._depths.append, image_qos)
        node.create_subscription(info, "depth_info", lambda message: self._see_camera("depth", message), info_qos)
        node.create_subscription(
            info, "camera_info", lambda message: self._see_camera("colour", message), SENSOR_DATA_QOS
        )
        node.create_subscription(get_message(self.FORM.images), "detections", self._receive, _DEPTH)

    def _see_camera(self, which: str, message: Any) -> None:
        try:
            self._cameras[which] = camera_model(
                message.width, message.height, message.k, message.d, message.p, message.distortion_model
            )
        except ValueError as error:
            self._complain(str(error))

    def _receive(self, message: Any) -> None:
        header = message.header
        found = self._array()
        found.header.stamp, found.header.frame_id = header.stamp, self._target
        pose = self._poses.pose(self._target, header.frame_id, header.stamp.nanoseconds)
        places: list[Place] = []
        if pose is not None and message.detections:
            for detection, place in zip(message.detections, self._places(message), strict=True):
                if place is not None:
                    found.detections.append(self._placed(detection, place, pose, found.header))
                    places.append(place)
        self._publisher.publish(found)
        if self._markers.get_subscription_count():
            self._markers.publish(_markers(self.FORM, found, places))

    def _places(self, message: Any) -> list[Place | None]:
        """Return the positions of detections in the optical frame of their image."""
        camera = self._cameras.get("colour") or self._cameras.get("depth")
        if camera is None:
            self._complain("no camera_info has arrived")
            return [None] * len(message.detections)
        depths, ground = self._depths_at(message), self._ground_below(message)
        places: list[Place | None] = []
        for box in map(self.FORM.box, message.detections):
            place = None
            if depths is not None:
                place = place_by_depth(box, depths, camera, spread=self._spread, farthest=self._farthest)
            if place is None and ground is not None:
                place = place_on_ground(box, camera, *ground, farthest=self._farthest)
            places.append(place)
        return places

    def _depths_at(self, message: Any) -> NDArray[np.float64] | None:
        """Return the depth image that belongs to detections, in metres; None if there is none."""
        time_ns = message.header.stamp.nanoseconds
        image = min(self._depths, key=lambda depth: abs(depth.header.stamp.nanoseconds - time_ns), default=None)
        if image is None or abs(image.header.stamp.nanoseconds - time_ns) > _SLOP_NS:
            if not self._ground:
                self._complain("no depth image has arrived with a stamp near that of the detections")
            return None
        if image.header.frame_id != message.header.frame_id:
            self._complain(
                f"the depth image is in the frame '{image.header.frame_id}' and the detections in "
                f"'{message.header.frame_id}': it must be registered to the image"
            )
            return None
        try:
            depths = depths_of(image)
        except ValueError as error:
            self._complain(str(error))
            return None
        return depths if image.encoding == "32FC1" else depths * self._unit

    def _ground_below(self, message: Any) -> tuple[NDArray[np.float64], float] | None:
        """Return the upward direction in the optical frame, and the height of the camera."""
        if not self._ground:
            return None
        header = message.header
        pose = self._poses.pose(self._ground, header.frame_id, header.stamp.nanoseconds)
        if pose is None:
            return None
        x, y, z, w = pose[3:]
        return np.array(rotate((-x, -y, -z, w), (0.0, 0.0, 1.0))), pose[2]

    def _placed(self, detection: Any, place: Place, pose: Transform, header: Any) -> Any:
        """Return a detection with a box in the target frame, whose x is along the view and z up."""
        middle = compose(pose, (*place.centre, *_FORWARD))
        return self.FORM.placed(detection, header, middle, (place.depth, place.width, place.height))

    def _complain(self, reason: str) -> None:
        self._node.get_logger().warning(
            f"the positions of detections are unknown: {reason}", throttle_duration_sec=_SECONDS_BETWEEN_COMPLAINTS
        )


class YoloDetect3DNode(Detect3DNode):
    """detect_3d_node of yolo_ros, which adds ``bbox3d`` to yolo_msgs/msg/DetectionArray."""

    FORM = YOLO_FORM


def _markers(form: DetectionForm, found: Any, places: list[Place]) -> Any:
    """Return a visualization_msgs/msg/MarkerArray with a box and a label for each detection."""
    kind = get_message("visualization_msgs/msg/Marker")
    array = get_message("visualization_msgs/msg/MarkerArray")()
    array.markers.append(kind(header=found.header, action=kind.DELETEALL))
    for number, (detection, place) in enumerate(zip(found.detections, places, strict=True)):
        name, _ = form.best(detection)
        volume = form.place(detection)
        box, label = (
            kind(header=found.header, ns=ns, id=number, type=shape, action=kind.ADD)
            for ns, shape in (("boxes", kind.CUBE), ("labels", kind.TEXT_VIEW_FACING))
        )
        box.lifetime.sec = label.lifetime.sec = _MARKER_SECONDS
        box.pose, box.scale = volume.center, volume.size
        at, above = label.pose.position, volume.center.position
        at.x, at.y, at.z = above.x, above.y, above.z + volume.size.z / 2 + _LABEL_METRES
        label.scale.z = _LABEL_METRES
        distance = float(np.linalg.norm(place.centre))
        label.text = " ".join(filter(None, (name, detection.id, f"{distance:.1f} m")))
        for marker, alpha in ((box, 0.45), (label, 1.0)):
            colour = marker.color
            colour.r, colour.g, colour.b = (part / 255 for part in colour_of(name))
            colour.a = alpha
        array.markers += [box, label]
    return array
