"""The base of nodes that convert the images of one topic."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar

from linkwright.graph import SENSOR_DATA_QOS, Graph, Node, Subscription
from linkwright.images.decoding import BadImageError
from linkwright.images.transports import ImageSource, Unpacker
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import log_unknown_parameters
from linkwright.perception.nodes.lazy_subscriptions import LazySubscriptions

_IMAGE_TYPE = "sensor_msgs/msg/Image"
_INPUT = "image_raw"
_PUBLISHER_DEPTH = 10


class ImageNode(SingleNode, ABC):
    """A node that converts the images on ``image_raw``, which works while one of its outputs has a subscription.

    Attributes:
        OUTPUTS: the topics of the results.

    Raises:
        LinkwrightError: a parameter has an invalid type (GRAPH201).
    """

    OUTPUTS: ClassVar[tuple[str, ...]]

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        with handle_start_errors(node):
            transport: str = node.declare_parameter("image_transport", "raw").value
            self.declare_parameters(node)
            log_unknown_parameters(node)
        self._source = ImageSource.of(node.resolve_topic_name(_INPUT), transport)
        self._unpacker = Unpacker()
        image_class = get_message(_IMAGE_TYPE)
        self._publishers = [node.create_publisher(image_class, topic, _PUBLISHER_DEPTH) for topic in self.OUTPUTS]
        self._subscriptions = LazySubscriptions(graph, node, self._publishers, self._subscribe)

    def close(self) -> None:
        """Close the node."""
        self._subscriptions.close()
        super().close()

    def declare_parameters(self, node: Node) -> None:
        """Declare the parameters besides ``image_transport``."""

    @abstractmethod
    def convert(self, image: Any) -> None:
        """Publish the results of an image.

        Raises:
            ValueError: the image cannot be used.
            BadImageError: its encoding is not supported, or there are too few bytes.
        """

    @abstractmethod
    def log_failure(self, error: Exception) -> None:
        """Log that an image is left out."""

    def _subscribe(self) -> list[Subscription[Any]]:
        message_class = get_message(self._source.message_type)
        return [self._node.create_subscription(message_class, self._source.topic, self._receive, SENSOR_DATA_QOS)]

    def _receive(self, message: Any) -> None:
        try:
            self.convert(self._unpacker.image(message, self._source.transport_of(message)))
        except (ValueError, BadImageError) as error:
            self.log_failure(error)
