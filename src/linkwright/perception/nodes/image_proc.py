"""image_proc's nodes that rectify, resize and crop images.

They take images with the ``camera_info`` of the same time, and work only while their output has a subscription.

Source: image_proc for ROS 2 (parameters, topics, defaults). Deliberate differences: interpolations other than nearest
and linear are linear, and results are published as raw images only.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.graph import SENSOR_DATA_QOS, Graph, Node, Publisher, Subscription
from linkwright.images.decoding import BadImageError
from linkwright.images.transports import ImageSource, Unpacker
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import check_positive, log_unknown_parameters
from linkwright.perception.nodes.camera_pairs import CameraPairs
from linkwright.perception.nodes.image_arrays import LINEAR, NEAREST, Sampling, create_resizing, to_array, to_image
from linkwright.perception.nodes.lazy_subscriptions import LazySubscriptions
from linkwright.perception.nodes.rectification import create_rectification

_IMAGE_TYPE, _INFO_TYPE = "sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo"
_PUBLISHER_DEPTH = 10
_ERROR_PERIOD_S = 5.0


class CameraNode(SingleNode, ABC):
    """A node that converts the images of a camera.

    Attributes:
        INPUT: the topic of the images.
        DEFAULT_INTERPOLATION: the default of the parameter ``interpolation``.
    """

    INPUT: str
    DEFAULT_INTERPOLATION = LINEAR

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._pairs = CameraPairs(self._receive)
        self._unpacker = Unpacker()
        node = self._node
        with handle_start_errors(node):
            transport: str = node.declare_parameter("image_transport", "raw").value
            interpolation = node.declare_parameter("interpolation", self.DEFAULT_INTERPOLATION).value
            self._interpolation = interpolation if interpolation == NEAREST else LINEAR
            self.declare_parameters(node)
            log_unknown_parameters(node)
            self._source = ImageSource.of(node.resolve_topic_name(self.INPUT), transport)
            self._publisher = self.create_publishers(node)
        self._subscriptions = LazySubscriptions(graph, node, [self._publisher], self._subscribe)

    @abstractmethod
    def declare_parameters(self, node: Node) -> None:
        """Declare the parameters of the node."""

    @abstractmethod
    def create_publishers(self, node: Node) -> Publisher[Any]:
        """Create the publishers, and return that of the images."""

    @abstractmethod
    def convert(self, image: Any, info: Any) -> Any:
        """Publish what the image and its camera_info become.

        Raises:
            ValueError: the image or the camera_info cannot be used.
        """

    def close(self) -> None:
        """Close the node."""
        self._subscriptions.close()
        super().close()

    def publish_image(self, image: Any) -> None:
        """Publish a converted image."""
        self._publisher.publish(image)

    def _subscribe(self) -> list[Subscription[Any]]:
        info_topic = get_info_topic(self._source.base)
        return [
            self._node.create_subscription(get_message(_INFO_TYPE), info_topic, self._pairs.add_info, SENSOR_DATA_QOS),
            self._node.create_subscription(
                get_message(self._source.message_type), self._source.topic, self._pairs.add_image, SENSOR_DATA_QOS
            ),
        ]

    def _receive(self, message: Any, info: Any) -> None:
        try:
            self.convert(self._unpacker.image(message, self._source.transport_of(message)), info)
        except (ValueError, BadImageError) as error:
            self._node.get_logger().error(
                phrase("the image on '{topic}' is left out: {reason}", topic=self._source.topic, reason=str(error)),
                throttle_duration_sec=_ERROR_PERIOD_S,
            )


class RectifyNode(CameraNode):
    """The node that rectifies images: straight lines of the world become straight.

    Raises:
        LinkwrightError: a parameter has an invalid type (GRAPH201).
    """

    DEFAULT_NAME, INPUT = "RectifyNode", "image"

    def declare_parameters(self, node: Node) -> None:
        """Declare ``queue_size``, which has no effect."""
        node.declare_parameter("queue_size", 5)

    def create_publishers(self, node: Node) -> Publisher[Any]:
        """Return the publisher of rectified images."""
        self._sampling: tuple[Any, Sampling] | None = None
        return node.create_publisher(get_message(_IMAGE_TYPE), "image_rect", _PUBLISHER_DEPTH)

    def convert(self, image: Any, info: Any) -> None:
        """Publish the rectified image; an image of a lens without distortion is unchanged."""
        if info.k[0] == 0.0:
            raise ValueError("the camera is not calibrated: its camera_info has no focal length")
        if not any(info.d):
            self._publisher.publish(image)
            return
        key = (*info.k, *info.d, *info.r, *info.p, info.width, info.height, info.distortion_model, str(info.roi))
        key += (info.binning_x, info.binning_y)
        if self._sampling is None or self._sampling[0] != key:
            self._sampling = key, create_rectification(info, self._interpolation)
        self._publisher.publish(to_image(self._sampling[1].apply(to_array(image)), image))


class ResizeNode(CameraNode):
    """The node that resizes images and their camera_info.

    Raises:
        LinkwrightError: a parameter has an invalid value or type (NODE433, GRAPH201).
    """

    DEFAULT_NAME, INPUT = "ResizeNode", "image/image_raw"

    def declare_parameters(self, node: Node) -> None:
        """Declare the size of the result."""
        self._uses_scale: bool = node.declare_parameter("use_scale", True).value
        self._scales: tuple[float, float] = (
            check_positive(node, "scale_width", node.declare_parameter("scale_width", 1.0).value),
            check_positive(node, "scale_height", node.declare_parameter("scale_height", 1.0).value),
        )
        self._size: tuple[int, int] = (
            node.declare_parameter("width", -1).value,
            node.declare_parameter("height", -1).value,
        )

    def create_publishers(self, node: Node) -> Publisher[Any]:
        """Return the publisher of resized images, and create that of their camera_info."""
        topic = node.resolve_topic_name("resize/image_raw")
        self._infos = node.create_publisher(get_message(_INFO_TYPE), get_info_topic(topic), _PUBLISHER_DEPTH)
        return node.create_publisher(get_message(_IMAGE_TYPE), topic, _PUBLISHER_DEPTH)

    def convert(self, image: Any, info: Any) -> None:
        """Publish the resized image, and the camera_info that belongs to it."""
        size = image.width, image.height
        if self._uses_scale:
            factors = self._scales
            new_size = round(size[0] * factors[0]), round(size[1] * factors[1])
        else:
            width, height = self._size
            new_size = width if width > 0 else size[0], height if height > 0 else size[1]
            factors = new_size[0] / size[0], new_size[1] / size[1]
        if min(new_size) < 1:
            raise ValueError("the resized image has no pixels")
        sampling = create_resizing(size, new_size, factors, self._interpolation)
        self._publisher.publish(to_image(sampling.apply(to_array(image)), image))
        self._infos.publish(_resize_info(info, factors))


def get_info_topic(image_topic: str) -> str:
    """Return the topic of the camera_info that belongs to images: beside the topic of the images."""
    return f"{image_topic.rpartition('/')[0]}/camera_info"


def _resize_info(info: Any, factors: tuple[float, float]) -> Any:
    """Return the camera_info of images whose sizes are multiplied by factors along x and y."""
    x, y = factors
    resized = get_message(_INFO_TYPE)(
        header=info.header, distortion_model=info.distortion_model, d=info.d, r=info.r, roi=info.roi
    )
    resized.binning_x, resized.binning_y = info.binning_x, info.binning_y
    resized.width, resized.height = int(info.width * x), int(info.height * y)
    resized.k = [value * factor for value, factor in zip(info.k, (x, 1, x, 1, y, y, 1, 1, 1), strict=True)]
    resized.p = [value * factor for value, factor in zip(info.p, (x, 1, x, x, 1, y, y, 1, 1, 1, 1, 1), strict=True)]
    roi = resized.roi = get_message("sensor_msgs/msg/RegionOfInterest")(do_rectify=info.roi.do_rectify)
    roi.x_offset, roi.width = int(info.roi.x_offset * x), int(info.roi.width * x)
    roi.y_offset, roi.height = int(info.roi.y_offset * y), int(info.roi.height * y)
    return resized
