"""apriltag_node of apriltag_ros: AprilTags in rectified images, and their poses on ``/tf``.

Topics: ``image_rect`` with its ``camera_info``, ``detections``, ``/tf``.

Source: apriltag_ros for ROS 2 (parameters, defaults, topics, names of frames, checks). Deliberate differences: OpenCV
finds the tags, so the families are 16h5, 25h9 and 36h11, and of the parameters in ``detector``, only ``refine`` has an
effect; ``homography`` is an analytical method for planes.

Parameters:

``image_transport``, ``qos_profile``
    how images arrive: ``raw`` or ``compressed``; ``default``, ``sensor_data`` or ``system_default``.
``family``, ``size``
    the tag family, and the length of an edge of the black square in m.
``tag.ids``, ``tag.frames``, ``tag.sizes``
    the tags that are published, their frames, and their sizes; without frames, all tags are published, and their frames
    are called tag36h11:0 and so on.
``pose_estimation_method``
    ``pnp``, ``homography``, or empty for no poses.
``max_hamming``
    tags with more wrong bits are left out.
``detector.threads``, ``detector.decimate``, ``detector.blur``, ``detector.refine``, ``detector.sharpening``,
``detector.debug``, ``profile``
    settings of the AprilTag library.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.geometry.arrays import quaternion_from_matrix
from linkwright.graph import DEFAULT_QOS, SENSOR_DATA_QOS, Graph, Parameter, ParameterDescriptor
from linkwright.graph.transforms.broadcaster import TransformBroadcaster
from linkwright.images import BadImageError, ImageSource, RangeFinder, Unpacker, decode_image
from linkwright.messages import TransformStamped, get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import invalid_value_error, log_unknown_parameters
from linkwright.perception.nodes.camera_pairs import CameraPairs
from linkwright.perception.nodes.image_proc import get_info_topic
from linkwright.vision.detectors.april_tags import FAMILIES, AprilTag, AprilTagFinder, estimate_pose
from linkwright.vision.detectors.markers import to_gray

_INPUT, _INFO_TYPE = "image_rect", "sensor_msgs/msg/CameraInfo"
_DETECTION_TYPE, _POINT_TYPE = "apriltag_msgs/msg/AprilTagDetection", "apriltag_msgs/msg/Point"
_QOS_PROFILES = {"default": DEFAULT_QOS, "sensor_data": SENSOR_DATA_QOS, "system_default": DEFAULT_QOS}
_POSE_METHODS = ("pnp", "homography", "")
_REFINE = "detector.refine"
_READ_ONLY = ParameterDescriptor(read_only=True)
_LIBRARY_SETTINGS: dict[str, Any] = {
    "detector.threads": 1,
    "detector.decimate": 2.0,
    "detector.blur": 0.0,
    _REFINE: True,
    "detector.sharpening": 0.25,
    "detector.debug": False,
    "max_hamming": 0,
    "profile": False,
}
_WARNING_PERIOD_S = 5.0


class AprilTagNode(SingleNode):
    """The node that publishes AprilTags and their poses.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433) or type (GRAPH201); OpenCV is missing (VISION101).
    """

    DEFAULT_NAME = "apriltag"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        with handle_start_errors(node):
            transport = node.declare_parameter("image_transport", "raw", _READ_ONLY).value
            qos = _QOS_PROFILES[self._declare_choice("qos_profile", "default", tuple(_QOS_PROFILES))]
            self._family = self._declare_choice("family", "36h11", tuple(FAMILIES))
            self._size: float = node.declare_parameter("size", 1.0, _READ_ONLY).value
            self._method = self._declare_choice("pose_estimation_method", "pnp", _POSE_METHODS)
            self._frames, self._sizes = self._declare_tags()
            for name, value in _LIBRARY_SETTINGS.items():
                node.declare_parameter(name, value)
            log_unknown_parameters(node)
            self._finder = AprilTagFinder(self._family, refine=node.get_parameter(_REFINE).value)
        node.add_post_set_parameters_callback(self._on_parameters)
        self._source = ImageSource.of(node.resolve_topic_name(_INPUT), transport)
        self._unpacker, self._ranges = Unpacker(), RangeFinder()
        self._detections = node.create_publisher(get_message(f"{_DETECTION_TYPE}Array"), "detections", 1)
        self._broadcaster = TransformBroadcaster(node)
        pairs = CameraPairs(self._receive)
        node.create_subscription(get_message(_INFO_TYPE), get_info_topic(self._source.base), pairs.add_info, qos)
        node.create_subscription(get_message(self._source.message_type), self._source.topic, pairs.add_image, qos)

    def _declare_choice(self, name: str, default: str, choices: tuple[str, ...]) -> str:
        value: str = self._node.declare_parameter(name, default, _READ_ONLY).value
        if value not in choices:
            raise invalid_value_error(name, value, self._node.get_name(), [choice for choice in choices if choice])
        return value

    def _declare_tags(self) -> tuple[dict[int, str], dict[int, float]]:
        """Return the frames and the sizes of tags, by ID.

        Raises:
            LinkwrightError: NODE433, there are not as many of them as IDs.
        """
        ids, frames, sizes = (
            self._node.declare_parameter(f"tag.{name}", default, _READ_ONLY).value
            for name, default in (
                ("ids", Parameter.Type.INTEGER_ARRAY),
                ("frames", Parameter.Type.STRING_ARRAY),
                ("sizes", Parameter.Type.DOUBLE_ARRAY),
            )
        )
        for name, values in (("tag.frames", frames), ("tag.sizes", sizes)):
            if values and len(values) != len(ids or ()):
                message = phrase(
                    "parameter '{name}' of '{node}' has {count} values, but 'tag.ids' has {expected}",
                    name=name,
                    node=self._node.get_name(),
                    count=len(values),
                    expected=len(ids or ()),
                )
                raise LinkwrightError(Diagnostic("NODE433", message))
        return dict(zip(ids or (), frames or (), strict=False)), dict(zip(ids or (), sizes or (), strict=False))

    def _on_parameters(self, parameters: list[Parameter]) -> None:
        if any(parameter.name == _REFINE for parameter in parameters):
            self._finder = AprilTagFinder(self._family, refine=self._node.get_parameter(_REFINE).value)

    def _receive(self, message: Any, info: Any) -> None:
        intrinsics = np.array((info.p[0], info.p[5], info.p[2], info.p[6]))
        is_calibrated = bool(info.width and info.height and intrinsics.all())
        if self._method and not is_calibrated:
            self._node.get_logger().warning(
                "The camera is not calibrated! Set 'pose_estimation_method' to \"\" (empty) to disable pose estimation "
                "and this warning.",
                throttle_duration_sec=_WARNING_PERIOD_S,
            )
        try:
            image = self._unpacker.image(message, self._source.transport_of(message))
            pixels = decode_image(image, self._ranges).pixels
        except BadImageError as error:
            reason = phrase("the image on '{topic}' is left out: {reason}", topic=self._source.topic, reason=str(error))
            self._node.get_logger().error(reason, throttle_duration_sec=_WARNING_PERIOD_S)
            return
        gray = pixels if pixels.ndim == 2 else to_gray(pixels[:, :, :3])
        tags = [tag for tag in self._finder.find(gray) if self._is_wanted(tag)]
        detections = [self._describe(tag) for tag in tags]
        self._detections.publish(get_message(f"{_DETECTION_TYPE}Array")(header=message.header, detections=detections))
        if self._method:
            transforms = [self._locate(tag, intrinsics, message.header) for tag in tags] if is_calibrated else []
            self._broadcaster.sendTransform(transforms)

    def _is_wanted(self, tag: AprilTag) -> bool:
        is_listed = not self._frames or tag.number in self._frames
        return is_listed and tag.hamming <= self._node.get_parameter("max_hamming").value

    def _describe(self, tag: AprilTag) -> Any:
        point = get_message(_POINT_TYPE)
        x, y = tag.center
        return get_message(_DETECTION_TYPE)(
            family=f"tag{self._family}",
            id=tag.number,
            hamming=tag.hamming,
            decision_margin=tag.decision_margin,
            centre=point(x=x, y=y),
            corners=[point(x=x, y=y) for x, y in tag.corners.tolist()],
            homography=tag.homography.ravel().tolist(),
        )

    def _locate(self, tag: AprilTag, intrinsics: Any, header: Any) -> TransformStamped:
        """Return the transform from the camera to a tag."""
        size = self._sizes.get(tag.number, self._size)
        matrix, position = estimate_pose(tag, intrinsics, size, is_iterative=self._method == "pnp")
        frame = self._frames.get(tag.number, f"tag{self._family}:{tag.number}")
        transform = TransformStamped(header=header, child_frame_id=frame)
        translation, rotation = transform.transform.translation, transform.transform.rotation
        translation.x, translation.y, translation.z = position.tolist()
        rotation.x, rotation.y, rotation.z, rotation.w = quaternion_from_matrix(matrix).tolist()
        return transform
