"""depth_image_proc's nodes that convert depth images to meters and to point clouds.

They work only while their output has a subscription. Distortion is ignored, as in depth_image_proc, which expects
rectified images.

Source: depth_image_proc for ROS 2 (parameters, topics, defaults) and REP 118 (depth images).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import phrase
from linkwright.graph import SENSOR_DATA_QOS, Graph, Publisher, QoSProfile, Subscription
from linkwright.images.decoding import BadImageError
from linkwright.images.transports import ImageSource, Unpacker
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import check_positive, log_unknown_parameters
from linkwright.perception.nodes.image_arrays import to_array, to_image
from linkwright.perception.nodes.image_node import ImageNode
from linkwright.perception.nodes.image_proc import get_info_topic
from linkwright.perception.nodes.lazy_subscriptions import LazySubscriptions

_IMAGE_TYPE, _INFO_TYPE, _CLOUD_TYPE = (
    "sensor_msgs/msg/Image",
    "sensor_msgs/msg/CameraInfo",
    "sensor_msgs/msg/PointCloud2",
)
_MILLIMETERS = ("16UC1", "mono16")
_METERS = "32FC1"
_FLOAT32 = 7
_ERROR_PERIOD_S = 5.0
_COLOR_CHANNELS = {"rgb8": (0, 1, 2), "rgba8": (0, 1, 2), "bgr8": (2, 1, 0), "bgra8": (2, 1, 0), "mono8": (0, 0, 0)}


def read_depths(image: Any) -> NDArray[np.float32]:
    """Return the depths of an image in meters, shape (height, width), NaN where they are not known.

    Raises:
        ValueError: the image is not a depth image, or has too little data.
    """
    if image.encoding in _MILLIMETERS:
        values = to_array(image)[..., 0]
        millimeters: NDArray[np.float32] = values.astype(np.float32)
        return np.where(values == 0, np.float32(np.nan), millimeters * np.float32(0.001))
    if image.encoding == _METERS:
        meters: NDArray[np.float32] = to_array(image)[..., 0].astype(np.float32)
        return np.where(np.isfinite(meters), meters, np.float32(np.nan))
    raise ValueError(f"Depth image has unsupported encoding [{image.encoding}]")


class ConvertMetricNode(ImageNode):
    """The node that converts depth images from millimeters to meters, or back.

    Raises:
        LinkwrightError: a parameter has an invalid type (GRAPH201).
    """

    DEFAULT_NAME, OUTPUTS = "ConvertMetricNode", ("image",)

    def convert(self, image: Any) -> None:
        """Publish the depths in the other unit."""
        depths = read_depths(image)
        pixels: NDArray[Any] = depths
        encoding = _METERS
        if image.encoding == _METERS:
            pixels = np.nan_to_num(np.rint(depths * 1000)).clip(0, 65535).astype(np.uint16)
            encoding = "16UC1"
        source = get_message(_IMAGE_TYPE)(header=image.header, encoding=encoding)
        self._publishers[0].publish(to_image(pixels[..., None], source))

    def log_failure(self, error: Exception) -> None:
        """Log that an image is left out."""
        self._node.get_logger().error(str(error), throttle_duration_sec=_ERROR_PERIOD_S)


class _CloudNode(SingleNode, ABC):
    """A node that makes point clouds of depth images and what belongs to them.

    Attributes:
        TOPICS: the topics of the depth images and of the other images, if there are any.
        INFO_OF: the index of the topic whose camera_info is used.
    """

    TOPICS: ClassVar[tuple[str, ...]]
    INFO_OF: ClassVar[int] = 0

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        with handle_start_errors(node):
            transports = [node.declare_parameter("depth_image_transport", "raw").value]
            self._is_exact = False
            if len(self.TOPICS) > 1:
                transports.append(node.declare_parameter("image_transport", "raw").value)
                self._is_exact = bool(node.declare_parameter("exact_sync", False).value)
            depth = int(check_positive(node, "queue_size", node.declare_parameter("queue_size", 5).value))
            self._invalid_depth: float = node.declare_parameter("invalid_depth", 0.0).value
            log_unknown_parameters(node)
        self._sources = [
            ImageSource.of(node.resolve_topic_name(topic), transport)
            for topic, transport in zip(self.TOPICS, transports, strict=True)
        ]
        self._unpackers = [Unpacker() for _ in self.TOPICS]
        self._queues: list[deque[Any]] = [deque(maxlen=depth) for _ in self.TOPICS]
        self._info: Any = None
        self._publisher: Publisher[Any] = node.create_publisher(get_message(_CLOUD_TYPE), "points", SENSOR_DATA_QOS)
        self._qos = QoSProfile(depth, SENSOR_DATA_QOS.reliability)
        self._subscriptions = LazySubscriptions(graph, node, [self._publisher], self._subscribe)

    def close(self) -> None:
        """Close the node."""
        self._subscriptions.close()
        super().close()

    @abstractmethod
    def read_columns(self, shape: tuple[int, int], image: Any) -> list[tuple[str, NDArray[np.float32]]]:
        """Return the further fields of the points of an image, each of the given shape.

        Raises:
            ValueError: the image cannot be used.
        """

    def _subscribe(self) -> list[Subscription[Any]]:
        node = self._node
        info_topic = node.resolve_topic_name(get_info_topic(self._sources[self.INFO_OF].base))
        subscriptions = [node.create_subscription(get_message(_INFO_TYPE), info_topic, self._on_info, self._qos)]
        for index, source in enumerate(self._sources):
            subscriptions.append(
                node.create_subscription(
                    get_message(source.message_type),
                    source.topic,
                    lambda message, index=index: self._on_image(index, message),
                    self._qos,
                )
            )
        return subscriptions

    def _on_info(self, message: Any) -> None:
        self._info = message
        self._process()

    def _on_image(self, index: int, message: Any) -> None:
        self._queues[index].append(message)
        self._process()

    def _process(self) -> None:
        """Convert the oldest depth image to which the other images have arrived."""
        if self._info is None:
            return
        while self._queues[0]:
            others = [self._find_partner(self._queues[0][0], queue) for queue in list(self._queues)[1:]]
            if any(other is None for other in others):
                if len(self._queues[0]) < 2:
                    return
                self._queues[0].popleft()  # A newer depth image may have found its partner.
                continue
            self._convert([self._queues[0].popleft(), *others])

    def _find_partner(self, depth: Any, queue: deque[Any]) -> Any:
        """Return the image of a queue that belongs to a depth image, or None if it has not arrived yet."""
        stamp_ns = depth.header.stamp.nanoseconds
        times = [abs(image.header.stamp.nanoseconds - stamp_ns) for image in queue]
        if not queue or (self._is_exact and min(times) > 0):
            return None
        is_complete = max(image.header.stamp.nanoseconds for image in queue) >= stamp_ns
        return queue[times.index(min(times))] if is_complete else None

    def _convert(self, messages: list[Any]) -> None:
        try:
            depth, *others = (
                unpacker.image(message, source.transport_of(message))
                for unpacker, message, source in zip(self._unpackers, messages, self._sources, strict=True)
            )
            depths = read_depths(depth)
            if self._invalid_depth:
                depths = np.where(np.isnan(depths), np.float32(self._invalid_depth), depths)
            columns = self._project(depths)
            for other in others:
                columns += self.read_columns(_check_size(other, depth), other)
        except (ValueError, BadImageError) as error:
            self._node.get_logger().error(
                phrase("the image on '{topic}' is left out: {reason}", topic=self._sources[0].topic, reason=str(error)),
                throttle_duration_sec=_ERROR_PERIOD_S,
            )
            return
        self._publisher.publish(_make_cloud(columns, depth.header))

    def _project(self, depths: NDArray[np.float32]) -> list[tuple[str, NDArray[np.float32]]]:
        """Return the coordinates of the points in the frame of the camera.

        Raises:
            ValueError: the camera is not calibrated.
        """
        projection = self._info.p if self._info.p[0] else [*self._info.k[:3], 0.0, *self._info.k[3:6], 0.0]
        focal_x, center_x, focal_y, center_y = projection[0], projection[2], projection[5], projection[6]
        if not focal_x or not focal_y:
            raise ValueError("the camera is not calibrated: its camera_info has no focal length")
        binning_x, binning_y = max(self._info.binning_x, 1), max(self._info.binning_y, 1)
        roi = self._info.roi
        columns = np.arange(depths.shape[1], dtype=np.float32) * binning_x + roi.x_offset
        rows = np.arange(depths.shape[0], dtype=np.float32)[:, None] * binning_y + roi.y_offset
        x = (columns - np.float32(center_x)) * depths / np.float32(focal_x)
        y = (rows - np.float32(center_y)) * depths / np.float32(focal_y)
        return [("x", x), ("y", y), ("z", depths)]


class PointCloudXyzNode(_CloudNode):
    """The node that makes point clouds of depth images."""

    DEFAULT_NAME = "PointCloudXyzNode"
    TOPICS = ("image_rect",)

    def read_columns(self, shape: tuple[int, int], image: Any) -> list[tuple[str, NDArray[np.float32]]]:
        """Return no further fields."""
        return []


class PointCloudXyzrgbNode(_CloudNode):
    """The node that makes colored point clouds of depth images and color images of the same camera."""

    DEFAULT_NAME = "PointCloudXyzrgbNode"
    TOPICS = ("depth_registered/image_rect", "rgb/image_rect_color")
    INFO_OF = 1

    def read_columns(self, shape: tuple[int, int], image: Any) -> list[tuple[str, NDArray[np.float32]]]:
        """Return the field ``rgb``, whose bytes are those of 0x00RRGGBB."""
        channels = _COLOR_CHANNELS.get(image.encoding)
        if channels is None:
            raise ValueError(f"RGB image has unsupported encoding [{image.encoding}]")
        pixels = to_array(image).astype(np.uint32)
        red, green, blue = (pixels[..., channel] for channel in channels)
        packed = np.ascontiguousarray(((red << 16) | (green << 8) | blue).reshape(shape), dtype=np.uint32)
        return [("rgb", packed.view(np.float32))]


class PointCloudXyziNode(_CloudNode):
    """The node that makes point clouds with intensities of depth images and intensity images."""

    DEFAULT_NAME = "PointCloudXyziNode"
    TOPICS = ("depth/image_rect", "intensity/image_rect")
    INFO_OF = 1

    def read_columns(self, shape: tuple[int, int], image: Any) -> list[tuple[str, NDArray[np.float32]]]:
        """Return the field ``intensity``."""
        pixels = to_array(image)
        if pixels.shape[2] != 1:
            raise ValueError(f"Intensity image has unsupported encoding [{image.encoding}]")
        return [("intensity", pixels.reshape(shape).astype(np.float32))]


def _check_size(image: Any, depth: Any) -> tuple[int, int]:
    """Return the rows and columns of an image.

    Raises:
        ValueError: the size differs from that of the depth image.
    """
    if (image.height, image.width) != (depth.height, depth.width):
        raise ValueError(
            f"Depth resolution ({depth.width}x{depth.height}) does not match the resolution of the other image"
            f" ({image.width}x{image.height})"
        )
    return image.height, image.width


def _make_cloud(columns: list[tuple[str, NDArray[np.float32]]], header: Any) -> Any:
    """Return a point cloud with the points of an image in its order."""
    field_class = get_message("sensor_msgs/msg/PointField")
    message = get_message(_CLOUD_TYPE)(header=header)
    height, width = columns[0][1].shape
    values = np.stack([column.astype("<f4", copy=False) for _, column in columns], axis=-1)
    message.fields = [
        field_class(name=name, offset=4 * index, datatype=_FLOAT32, count=1) for index, (name, _) in enumerate(columns)
    ]
    message.height, message.width = height, width
    message.point_step = 4 * len(columns)
    message.row_step = message.point_step * width
    message.is_dense = False
    message.data = np.frombuffer(values.tobytes(), np.uint8)
    return message
