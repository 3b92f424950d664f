"""detect_3d_node: computes the positions of detected objects in meters.

Source: yolo_ros 4 (the executable, the topics ``detections``, ``depth_image``, ``depth_info`` and ``detections_3d``,
the parameters, and the matching of messages up to 0.5 s apart). Deliberate differences: detections have the
types of vision_msgs, except in the node with yolo_ros's own name; depth images of 32FC1 are in meters regardless of the
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
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import check_positive, log_unknown_parameters
from linkwright.perception.nodes.depthimage_to_laserscan import read_depths
from linkwright.vision.detectors.drawing import choose_class_color
from linkwright.vision.nodes.detection_formats import VISION_FORMAT, YOLO_FORMAT, DetectionFormat
from linkwright.vision.places.camera import CameraModel, make_camera_model
from linkwright.vision.places.positions import ObjectPosition, position_from_depth, position_on_ground

_QUEUE_DEPTH = 10
_MAX_DEPTH_IMAGES = 10
"""The number of depth images that are kept until their detections arrive."""
_MAX_STAMP_DIFFERENCE_NS = 500_000_000
_RELIABLE = 1
_MILLIMETERS_PER_METER = 1000
_WARNING_PERIOD_S = 5.0
_MARKER_LIFETIME_S = 1
_LABEL_HEIGHT_M = 0.12
_FORWARD_IN_OPTICAL = (0.5, -0.5, 0.5, 0.5)
"""The orientation, in an optical frame, of axes with x forward and z up, as a quaternion."""


class Detect3DNode(SingleNode):
    """The node that computes positions of detections from depth images or from the ground.

    Parameters:

    - ``target_frame``: the frame of the result.
    - ``depth_image_units_divisor``: the units per meter in images of 16UC1.
    - ``maximum_detection_threshold``: the maximum difference in depth from the middle of the object's surface, in m.
    - ``depth_image_reliability``, ``depth_info_reliability``: 1 for reliable, 2 for best effort.
    - ``ground_frame``: the frame whose x and y axes span the ground; if empty, no objects are placed on the ground.
    - ``maximum_distance``: the maximum distance of an object, in m.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201).
    """

    DEFAULT_NAME = "detect_3d_node"
    DETECTION_FORMAT: ClassVar[DetectionFormat] = VISION_FORMAT

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        declare = node.declare_parameter
        with handle_start_errors(node):
            self._target_frame: str = declare("target_frame", "base_link").value
            divisor = check_positive(
                node, "depth_image_units_divisor", declare("depth_image_units_divisor", 1000).value
            )
            self._max_depth_difference = check_positive(
                node, "maximum_detection_threshold", declare("maximum_detection_threshold", 0.3).value
            )
            self._max_distance = check_positive(node, "maximum_distance", declare("maximum_distance", 20.0).value)
            self._ground_frame: str = declare("ground_frame", "").value
            image_qos, info_qos = (
                DEFAULT_QOS if declare(name, 2).value == _RELIABLE else SENSOR_DATA_QOS
                for name in ("depth_image_reliability", "depth_info_reliability")
            )
            log_unknown_parameters(node)
        self._meters_per_unit = _MILLIMETERS_PER_METER / divisor
        self._poses = FramePoses(node, "the positions of detections are unknown:")
        self._depth_images: deque[Any] = deque(maxlen=_MAX_DEPTH_IMAGES)
        self._cameras: dict[str, CameraModel] = {}
        self._array = get_message(self.DETECTION_FORMAT.position_type)
        self._publisher = node.create_publisher(self._array, "detections_3d", _QUEUE_DEPTH)
        self._markers = node.create_publisher(
            get_message("visualization_msgs/msg/MarkerArray"), "markers", _QUEUE_DEPTH
        )
        info = get_message("sensor_msgs/msg/CameraInfo")
        node.create_subscription(
            get_message("sensor_msgs/msg/Image"), "depth_image", self._depth_images.append, image_qos
        )
        node.create_subscription(
            info, "depth_info", lambda message: self._receive_camera_info("depth", message), info_qos
        )
        node.create_subscription(
            info, "camera_info", lambda message: self._receive_camera_info("color", message), SENSOR_DATA_QOS
        )
        node.create_subscription(
            get_message(self.DETECTION_FORMAT.image_type), "detections", self._receive, _QUEUE_DEPTH
        )

    def _receive_camera_info(self, kind: str, message: Any) -> None:
        try:
            self._cameras[kind] = make_camera_model(
                message.width, message.height, message.k, message.d, message.p, message.distortion_model
            )
        except ValueError as error:
            self._warn(str(error))

    def _receive(self, message: Any) -> None:
        header = message.header
        result = self._array()
        result.header.stamp, result.header.frame_id = header.stamp, self._target_frame
        pose = self._poses.pose(self._target_frame, header.frame_id, header.stamp.nanoseconds)
        positions: list[ObjectPosition] = []
        if pose is not None and message.detections:
            for detection, position in zip(message.detections, self._find_positions(message), strict=True):
                if position is not None:
                    result.detections.append(self._position_detection(detection, position, pose, result.header))
                    positions.append(position)
        self._publisher.publish(result)
        if self._markers.get_subscription_count():
            self._markers.publish(_make_markers(self.DETECTION_FORMAT, result, positions))

    def _find_positions(self, message: Any) -> list[ObjectPosition | None]:
        """Return each detection's position in the optical frame of its image, or None if unknown."""
        camera = self._cameras.get("color") or self._cameras.get("depth")
        if camera is None:
            self._warn("no camera_info has arrived")
            return [None] * len(message.detections)
        depths, ground = self._find_matching_depths(message), self._find_ground_plane(message)
        positions: list[ObjectPosition | None] = []
        for box in map(self.DETECTION_FORMAT.get_box, message.detections):
            position = None
            if depths is not None:
                position = position_from_depth(
                    box, depths, camera, max_depth_difference=self._max_depth_difference, max_depth=self._max_distance
                )
            if position is None and ground is not None:
                position = position_on_ground(box, camera, *ground, max_distance=self._max_distance)
            positions.append(position)
        return positions

    def _find_matching_depths(self, message: Any) -> NDArray[np.float64] | None:
        """Return the depth image of the detections in meters, or None if there is none."""
        time_ns = message.header.stamp.nanoseconds
        image = min(self._depth_images, key=lambda depth: abs(depth.header.stamp.nanoseconds - time_ns), default=None)
        if image is None or abs(image.header.stamp.nanoseconds - time_ns) > _MAX_STAMP_DIFFERENCE_NS:
            if not self._ground_frame:
                self._warn("no depth image has arrived with a stamp near that of the detections")
            return None
        if image.header.frame_id != message.header.frame_id:
            self._warn(
                f"the depth image is in the frame '{image.header.frame_id}' and the detections in "
                f"'{message.header.frame_id}': it must be registered to the image"
            )
            return None
        try:
            depths = read_depths(image)
        except ValueError as error:
            self._warn(str(error))
            return None
        return depths if image.encoding == "32FC1" else depths * self._meters_per_unit

    def _find_ground_plane(self, message: Any) -> tuple[NDArray[np.float64], float] | None:
        """Return the upward direction and the camera's height in m, or None if unknown.

        The direction is in the optical frame.
        """
        if not self._ground_frame:
            return None
        header = message.header
        pose = self._poses.pose(self._ground_frame, header.frame_id, header.stamp.nanoseconds)
        if pose is None:
            return None
        x, y, z, w = pose[3:]
        return np.array(rotate((-x, -y, -z, w), (0.0, 0.0, 1.0))), pose[2]

    def _position_detection(self, detection: Any, position: ObjectPosition, pose: Transform, header: Any) -> Any:
        """Return a detection with a box in the target frame.

        The x axis of the box points along the view, and its z axis up.
        """
        box_pose = compose(pose, (*position.center, *_FORWARD_IN_OPTICAL))
        return self.DETECTION_FORMAT.with_position(
            detection, header, box_pose, (position.depth, position.width, position.height)
        )

    def _warn(self, reason: str) -> None:
        self._node.get_logger().warning(
            f"the positions of detections are unknown: {reason}", throttle_duration_sec=_WARNING_PERIOD_S
        )


class YoloDetect3DNode(Detect3DNode):
    """The node detect_3d_node of yolo_ros, which adds ``bbox3d`` to detections."""

    DETECTION_FORMAT = YOLO_FORMAT


def _make_markers(detection_format: DetectionFormat, detection_array: Any, positions: list[ObjectPosition]) -> Any:
    """Return a visualization_msgs/msg/MarkerArray with a box and a label for each detection."""
    marker_class = get_message("visualization_msgs/msg/Marker")
    marker_array = get_message("visualization_msgs/msg/MarkerArray")()
    marker_array.markers.append(marker_class(header=detection_array.header, action=marker_class.DELETEALL))
    for index, (detection, position) in enumerate(zip(detection_array.detections, positions, strict=True)):
        name, _ = detection_format.find_best_hypothesis(detection)
        box_3d = detection_format.get_box_3d(detection)
        box, label = (
            marker_class(header=detection_array.header, ns=ns, id=index, type=shape, action=marker_class.ADD)
            for ns, shape in (("boxes", marker_class.CUBE), ("labels", marker_class.TEXT_VIEW_FACING))
        )
        box.lifetime.sec = label.lifetime.sec = _MARKER_LIFETIME_S
        box.pose, box.scale = box_3d.center, box_3d.size
        label_position, box_center = label.pose.position, box_3d.center.position
        label_position.x, label_position.y, label_position.z = (
            box_center.x,
            box_center.y,
            box_center.z + box_3d.size.z / 2 + _LABEL_HEIGHT_M,
        )
        label.scale.z = _LABEL_HEIGHT_M
        distance = float(np.linalg.norm(position.center))
        label.text = " ".join(filter(None, (name, detection.id, f"{distance:.1f} m")))
        for marker, alpha in ((box, 0.45), (label, 1.0)):
            color = marker.color
            color.r, color.g, color.b = (channel / 255 for channel in choose_class_color(name))
            color.a = alpha
        marker_array.markers += [box, label]
    return marker_array
