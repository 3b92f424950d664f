"""The detector node, and its variants with the names of other packages.

The node subscribes to images only while its detections have a subscriber. A thread processes the latest image, so that
a slow network never builds up a queue. The same thread loads the detector, which may take seconds. Meanwhile the node
does not process images, `set_classes` delays its response, and all other requests are answered immediately. The
differences between the packages are in `dialects`.

Parameters, by the names of yolo_ros:

``model``
    an ONNX file, or the name of a detector: ``colors``, ``aruco``, ``apriltag``, ``qr``, ``line``, or a detector
    that a package provides.
``labels``
    a file with the names of the classes, which replace the names in the network's file.
``device``
    where the network runs: ``cpu``, ``cuda:0``.
``imgsz_height``, ``imgsz_width``
    the input size of a network that takes any size; 0 for the size used in training.
``threshold``, ``iou``, ``max_det``, ``classes``, ``enable``, ``max_rate``
    the limits for detections, whether images are processed, and the maximum number of images per second (0: all). They
    can be set at run time. ``classes`` are names; an empty list means all classes.
``input_image_topic``, ``image_transport``, ``image_reliability``
    the source of images: a topic of Image, or one that ends in ``/compressed``; 1 reliable, 2 best effort.
``colors.NAME``, ``dictionary``, ``least_area``, ``part``, ``color``
    settings of the detectors without networks.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.graph import (
    Future,
    Graph,
    Parameter,
    ParameterDescriptor,
    QoSProfile,
    ReliabilityPolicy,
    SetParametersResult,
    Subscription,
)
from linkwright.graph.loop.node_handle import MutuallyExclusiveCallbackGroup
from linkwright.graph.parameters.parameter import Range
from linkwright.images import BadImageError, ImageSource, RangeFinder, Unpacker, decode_image
from linkwright.messages import get_message, get_service
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import invalid_value_error, log_unknown_parameters
from linkwright.perception.nodes.lazy_subscriptions import LazySubscriptions
from linkwright.vision.detections import Detections
from linkwright.vision.detector import Detector, Limits
from linkwright.vision.detectors.drawing import draw_detections
from linkwright.vision.detectors.options import MAX_SIZE, DetectorOptions
from linkwright.vision.detectors.registry import DEFAULT_DETECTOR, make_detector
from linkwright.vision.detectors.settings import setting_error
from linkwright.vision.nodes.detection_messages import MESSAGE_MAKERS, image_message
from linkwright.vision.nodes.dialects import DARKNET_ROS, LINKWRIGHT, YOLO_ROS, YOLOV5_ROS, YOLOV5_ROS2, Dialect
from linkwright.vision.nodes.image_watch import ImageWatch
from linkwright.vision.nodes.latest_worker import LatestWorker

_QUEUE_DEPTH = 10
_ERROR_PERIOD_S = 5.0
_FRACTION_DESCRIPTOR = ParameterDescriptor(floating_point_range=[Range(0.0, 1.0)])
_RATE_DESCRIPTOR = ParameterDescriptor(floating_point_range=[Range(0.0, 1000.0)])
_SIDE_DESCRIPTOR = ParameterDescriptor(integer_range=[Range(0, MAX_SIZE)], read_only=True)
_READ_ONLY = ParameterDescriptor(read_only=True)
_ANY_TYPE = ParameterDescriptor(dynamic_typing=True)
_DETECTOR_SETTINGS = ("dictionary", "least_area", "part", "color")
_COLORS_PARAMETER = "colors"
_CLASSES_PARAMETER = "classes"
_MIN_PERIOD_FRACTION = 0.9
"""The fraction of a period after which the next image is accepted, so that a slightly early image is not skipped."""


@dataclass(frozen=True, slots=True)
class _Task:
    """An image to process, the limits for its detections, and whether to draw boxes into it."""

    message: Any
    limits: Limits
    draws_boxes: bool


class DetectorNode(SingleNode):
    """The detector node, which exits if the detector does not exist or lacks a class.

    Attributes:
        loaded: a future that is done as soon as the detector is loaded.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, VISION109).
    """

    DEFAULT_NAME = "yolo_node"
    DIALECT: ClassVar[Dialect] = LINKWRIGHT

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._graph = graph
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node, dialect = self._node, self.DIALECT
        with handle_start_errors(node):
            self._declare(dialect)
            settings = self._read_detector_options(dialect)
            self._limits = self._make_limits({}, None)
            self._source = self._read_image_source(dialect)
            self._qos = self._read_image_qos()
            log_unknown_parameters(node)
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self.loaded: Future[None] = Future()
        self._names: tuple[str, ...] | None = None
        self._unpacker, self._ranges = Unpacker(), RangeFinder()
        self._last_image_ns: int | None = None
        self._results: deque[Callable[[], None]] = deque()
        output = (
            node.get_parameter(dialect.output_topic).value if dialect.output_topic else dialect.default_output_topic
        )
        self._detections = node.create_publisher(get_message(dialect.message_type), output, _QUEUE_DEPTH)
        message_class = get_message("sensor_msgs/msg/Image")
        self._image_publishers = [
            node.create_publisher(message_class, topic, _QUEUE_DEPTH) for topic in dialect.debug_image_topics
        ]
        node.create_service(get_service("std_srvs/srv/SetBool"), "enable", self._on_enable)
        set_classes, callback_group = get_service("yolo_msgs/srv/SetClasses"), MutuallyExclusiveCallbackGroup()
        node.create_service(set_classes, "set_classes", self._on_set_classes, callback_group=callback_group)
        node.add_on_set_parameters_callback(self._check_parameters)
        node.add_post_set_parameters_callback(lambda _: self._update_limits())
        self._result_condition = node.create_guard_condition(self._run_results)
        self._subscriptions: LazySubscriptions | None = None
        load = partial(self._load, self._get_parameter_value(dialect.model), settings)
        self._worker = LatestWorker(load, f"{node.get_name()} detector")

    def close(self) -> None:
        """Close the node and its detector."""
        if self._subscriptions is not None:
            self._subscriptions.close()
        self._worker.close()
        super().close()

    def _declare(self, dialect: Dialect) -> None:
        node = self._node
        node.declare_parameter(dialect.model, DEFAULT_DETECTOR, _READ_ONLY)
        node.declare_parameter(dialect.labels, "", _READ_ONLY)
        node.declare_parameter("device", "cpu", _READ_ONLY)
        node.declare_parameter("imgsz_height", 0, _SIDE_DESCRIPTOR)
        node.declare_parameter("imgsz_width", 0, _SIDE_DESCRIPTOR)
        node.declare_parameter(dialect.threshold, dialect.default_threshold, _FRACTION_DESCRIPTOR)
        node.declare_parameter(dialect.iou, dialect.default_iou, _FRACTION_DESCRIPTOR)
        node.declare_parameter(dialect.max_detections_parameter, dialect.default_max_detections)
        node.declare_parameter(_CLASSES_PARAMETER, [""], _ANY_TYPE)
        node.declare_parameter("enable", True)
        node.declare_parameter("max_rate", 0.0, _RATE_DESCRIPTOR)
        node.declare_parameter("image_transport", "raw", _READ_ONLY)
        node.declare_parameter("image_reliability", ReliabilityPolicy.BEST_EFFORT.value, _READ_ONLY)
        if dialect.image_topic:
            node.declare_parameter(dialect.image_topic, dialect.default_image_topic, _READ_ONLY)
        if dialect.output_topic:
            node.declare_parameter(dialect.output_topic, dialect.default_output_topic, _READ_ONLY)
        for name in node.undeclared_overrides():
            if name in _DETECTOR_SETTINGS or name.startswith(f"{_COLORS_PARAMETER}."):
                node.declare_parameter(name, None, ParameterDescriptor(read_only=True, dynamic_typing=True))

    def _get_parameter_value(self, name: str) -> Any:
        return self._node.get_parameter(name).value

    def _read_detector_options(self, dialect: Dialect) -> DetectorOptions:
        names = self._node.parameter_names()
        settings: dict[str, object] = {
            name: self._get_parameter_value(name) for name in _DETECTOR_SETTINGS if name in names
        }
        colors = {
            name.partition(".")[2]: self._get_parameter_value(name)
            for name in names
            if name.startswith(f"{_COLORS_PARAMETER}.")
        }
        if colors:
            settings[_COLORS_PARAMETER] = colors
        size = self._get_parameter_value("imgsz_height"), self._get_parameter_value("imgsz_width")
        if 0 in size and any(size):
            missing = "imgsz_width" if size[0] else "imgsz_height"
            raise setting_error(missing, 0, phrase("give both the height and the width of the input, or neither"))
        labels = self._get_parameter_value(dialect.labels)
        return DetectorOptions(
            labels=Path(labels).expanduser() if labels else None,
            device=self._get_parameter_value("device"),
            size=size if all(size) else None,
            settings=settings,
        )

    def _read_image_source(self, dialect: Dialect) -> ImageSource:
        topic = self._get_parameter_value(dialect.image_topic) if dialect.image_topic else dialect.default_image_topic
        transport = self._get_parameter_value("image_transport")
        source = ImageSource.of(self._node.resolve_topic_name(topic), transport)
        if not source.is_supported:
            raise invalid_value_error("image_transport", transport, self._node.get_name(), ("raw", "compressed"))
        return source

    def _read_image_qos(self) -> QoSProfile:
        reliability = self._get_parameter_value("image_reliability")
        policies = {policy.value: policy for policy in ReliabilityPolicy}
        if reliability not in policies:
            raise invalid_value_error("image_reliability", reliability, self._node.get_name(), ("1", "2"))
        return QoSProfile(depth=1, reliability=policies[reliability])

    def _make_limits(self, new_values: dict[str, Any], detector_classes: Sequence[str] | None) -> Limits:
        """Return the limits that the parameters set, with new values for some parameters.

        Args:
            new_values: the new values, by parameter name.
            detector_classes: the classes of the detector; None while it is being loaded, which allows all classes.

        Raises:
            LinkwrightError: NODE433, ``max_det`` is less than 1, or the detector lacks one of the classes.
        """
        dialect = self.DIALECT
        threshold, iou, max_detections, classes = (
            new_values.get(name, self._get_parameter_value(name))
            for name in (dialect.threshold, dialect.iou, dialect.max_detections_parameter, _CLASSES_PARAMETER)
        )
        if max_detections < 1:
            raise invalid_value_error(dialect.max_detections_parameter, max_detections, self._node.get_name())
        return Limits(
            threshold,
            iou,
            max_detections,
            None if detector_classes is None else self._parse_requested_classes(classes, detector_classes),
        )

    def _parse_requested_classes(self, classes: Any, detector_classes: Sequence[str]) -> frozenset[str] | None:
        entries = classes if isinstance(classes, Sequence) and not isinstance(classes, str) else [classes]
        requested = []
        for class_name in entries:
            is_number = (
                isinstance(class_name, int)
                and not isinstance(class_name, bool)
                and 0 <= class_name < len(detector_classes)
            )
            name = detector_classes[class_name] if is_number else str(class_name)
            if class_name is None or name == "":
                continue
            if detector_classes and name not in detector_classes:
                raise invalid_value_error(_CLASSES_PARAMETER, name, self._node.get_name(), detector_classes)
            requested.append(name)
        return frozenset(requested) if requested else None

    def _check_parameters(self, parameters: Sequence[Parameter]) -> SetParametersResult:
        new_values = {parameter.name: parameter.value for parameter in parameters}
        if self._names is None and _CLASSES_PARAMETER in new_values:
            return SetParametersResult(False, str(phrase("the classes cannot be set until the detector is loaded")))
        try:
            self._make_limits(new_values, self._names)
        except LinkwrightError as error:
            diagnostic = error.diagnostics[0]
            return SetParametersResult(
                False, f"{diagnostic.message}; {diagnostic.hint}" if diagnostic.hint else str(diagnostic.message)
            )
        return SetParametersResult(True)

    def _update_limits(self) -> None:
        self._limits = self._make_limits({}, self._names)

    def _on_enable(self, request: Any, response: Any) -> Any:
        self._node.set_parameters([Parameter("enable", value=request.data)])
        response.success, response.message = True, "enabled" if request.data else "disabled"
        return response

    async def _on_set_classes(self, request: Any, response: Any) -> Any:
        await self.loaded
        (result,) = self._node.set_parameters([Parameter(_CLASSES_PARAMETER, value=list(request.classes) or [""])])
        response.success, response.message = result.successful, result.reason
        return response

    def _subscribe(self) -> list[Subscription[Any]]:
        message_class = get_message(self._source.message_type)
        return [self._node.create_subscription(message_class, self._source.topic, self._receive, self._qos)]

    def _receive(self, message: Any) -> None:
        self._watch.record_image()
        if not self._get_parameter_value("enable") or self._is_too_early():
            return
        draws_boxes = any(publisher.get_subscription_count() for publisher in self._image_publishers)
        self._worker.offer(_Task(message, self._limits, draws_boxes))

    def _is_too_early(self) -> bool:
        rate, now_ns = self._get_parameter_value("max_rate"), self._node.get_clock().now().nanoseconds
        if (
            rate > 0
            and self._last_image_ns is not None
            and 0 <= now_ns - self._last_image_ns < _MIN_PERIOD_FRACTION * 1e9 / rate
        ):
            return True
        self._last_image_ns = now_ns
        return False

    # --- in the worker's thread ----------------------------------------------------------------------------------

    def _load(self, model: str, options: DetectorOptions) -> Callable[[_Task], None] | None:
        """Load the detector, and return a function that processes an image, or None on failure."""
        try:
            detector = make_detector(model, options)
        except LinkwrightError as error:
            self._queue_result(partial(self._fail, error))
            return None
        except Exception as error:  # noqa: BLE001 - a detector of another package may raise anything
            self._queue_result(partial(self._fail, _make_detector_error(error)))
            return None
        self._queue_result(partial(self._begin, detector))
        return partial(self._detect, detector)

    def _detect(self, detector: Detector, task: _Task) -> None:
        """Detect objects in an image, and queue the result for the node's callback."""
        try:
            message = self._unpacker.image(task.message, self._source.transport)
            image = decode_image(message, self._ranges).rgb()
            detections = detector.detect(image, task.limits)
            image_with_boxes = draw_detections(image, detections) if task.draws_boxes else None
        except (BadImageError, LinkwrightError) as error:
            self._queue_result(partial(self._log_error, str(error)))
        except Exception as error:  # noqa: BLE001 - a detector of another package may raise anything
            self._queue_result(partial(self._log_error, str(_make_detector_error(error))))
        else:
            self._queue_result(partial(self._publish, task.message.header, detections, image_with_boxes))

    def _queue_result(self, result: Callable[[], None]) -> None:
        self._results.append(result)
        self._result_condition.trigger()

    # --- results, in the node's callbacks ------------------------------------------------------------------------

    def _run_results(self) -> None:
        while self._results:
            self._results.popleft()()

    def _begin(self, detector: Detector) -> None:
        """Log the detector's notes, and start subscribing to images."""
        for note in detector.notes:
            self._node.get_logger().info(str(note))
        try:
            self._limits = self._make_limits({}, detector.names)
        except LinkwrightError as error:
            self._fail(error)
            return
        self._names = detector.names
        subscriptions = self._subscriptions = LazySubscriptions(
            self._graph, self._node, [self._detections, *self._image_publishers], self._subscribe
        )
        self._watch = ImageWatch(
            self._node, self._source, self._qos, lambda: subscriptions.are_open, self.DIALECT.image_topic
        )
        self.loaded.set_result(None)

    def _fail(self, error: LinkwrightError) -> None:
        diagnostic = error.diagnostics[0]
        logger = self._node.get_logger()
        logger.fatal(diagnostic.message)
        if diagnostic.hint:
            logger.fatal(diagnostic.hint)
        if not self.finished.done():
            self.finished.set_result(1)

    def _log_error(self, problem: str) -> None:
        self._node.get_logger().error(problem, throttle_duration_sec=_ERROR_PERIOD_S)

    def _publish(self, header: Any, detections: Detections, image: NDArray[np.uint8] | None) -> None:
        self._detections.publish(MESSAGE_MAKERS[self.DIALECT.message_type](header, detections))
        if image is None:
            return
        message = image_message(header, image)
        for publisher in self._image_publishers:
            if publisher.get_subscription_count():
                publisher.publish(message)


def _make_detector_error(error: Exception) -> LinkwrightError:
    message = phrase("the detector failed: {problem}", problem=foreign(f"{type(error).__name__}: {error}"))
    return LinkwrightError(Diagnostic("VISION112", message))


class YoloRosNode(DetectorNode):
    """The node yolo_node of yolo_ros.

    It publishes yolo_msgs/msg/DetectionArray on ``detections``, and ``dbg_image``.
    """

    DIALECT = YOLO_ROS


class Yolov5RosNode(DetectorNode):
    """The detector of yolov5_ros.

    Its parameters are ``weights``, ``confidence_threshold``, ``iou_threshold`` and ``output_topic``, among others.
    """

    DEFAULT_NAME = "detect"
    DIALECT = YOLOV5_ROS


class Yolov5Ros2Node(DetectorNode):
    """The node yolo_detect_2d of yolov5_ros2.

    It subscribes to ``image_topic``, and publishes ``yolo_result`` and ``result_img``.
    """

    DEFAULT_NAME = "yolov5_ros2"
    DIALECT = YOLOV5_ROS2


class DarknetRosNode(DetectorNode):
    """The node detector_node of openrobotics_darknet_ros.

    Its topics are ``~/images`` and ``~/detections``, and ``detection.threshold`` is a parameter.
    """

    DEFAULT_NAME = "detector_node"
    DIALECT = DARKNET_ROS
