"""republish of image_transport: converts images between transports.

The transports are raw, compressed and compressedDepth.

Sources: image_transport 3.1 (ROS 2 Humble) and later, compressed_image_transport, compressed_depth_image_transport. The
transport of the input is the first argument or the parameter ``in_transport``, by default raw. The transport of the
output is the second argument or ``out_transport``; by default there are outputs for all transports. The topics are
``in`` and ``out`` with the name of the transport appended. Remappings of both forms apply: ``in:=/camera/image_raw``,
as in Jazzy, and ``in/compressed:=...``, as in Humble.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from linkwright.diagnostics import install_hint
from linkwright.graph import DEFAULT_QOS, Graph, Node, Publisher, Subscription
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import get_arguments, invalid_value_error, log_unknown_parameters, options_from_arguments
from linkwright.perception.nodes.image_transports import (
    BadImageError,
    compress_depth,
    compress_image,
    decompress_depth,
    decompress_image,
)
from linkwright.perception.nodes.lazy_subscriptions import LazySubscriptions

_IMAGE_TYPE, _COMPRESSED_TYPE = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"
_TRANSPORTS = ("raw", "compressed", "compressedDepth")
_ERROR_PERIOD_S = 5.0


def _pass_through(image: Any) -> Any:
    return image


_DECODERS: dict[str, Callable[[Any], Any]] = {
    "raw": _pass_through,
    "compressed": decompress_image,
    "compressedDepth": decompress_depth,
}
_ENCODERS: dict[str, Callable[[Any], Any]] = {
    "raw": _pass_through,
    "compressed": compress_image,
    "compressedDepth": compress_depth,
}


class ImageRepublisher(SingleNode):
    """The node that republishes images with other transports.

    Raises:
        LinkwrightError: a transport does not exist (NODE433), or there are more than two arguments (NODE432).
    """

    DEFAULT_NAME = "image_republisher"
    USAGE = "republish IN_TRANSPORT [OUT_TRANSPORT] --ros-args -r in:=... -r out:=..."
    WORDS: ClassVar[dict[str, Callable[[str], Any]]] = {"in_transport": str, "out_transport": str}

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        options = options_from_arguments(options, get_arguments(options), self.WORDS, self.USAGE)
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            self._in_transport = self._declare_transport("in_transport", "raw")
            out_transport = self._declare_transport("out_transport", "")
            log_unknown_parameters(self._node)
        self._publishers: dict[str, Publisher[Any]] = {}
        for transport in [out_transport] if out_transport else _TRANSPORTS:
            topic = resolve_transport_topic(self._node, "out", transport)
            self._publishers[transport] = self._node.create_publisher(_get_message_class(transport), topic, DEFAULT_QOS)
        self._subscriptions = LazySubscriptions(graph, self._node, list(self._publishers.values()), self._subscribe)

    def close(self) -> None:
        """Close the node."""
        self._subscriptions.close()
        super().close()

    def _declare_transport(self, parameter: str, default: str) -> str:
        name: str = self._node.declare_parameter(parameter, default).value
        if name not in (*_TRANSPORTS, default):
            raise invalid_value_error(parameter, name, self._node.get_name(), _TRANSPORTS)
        return name

    def _subscribe(self) -> list[Subscription[Any]]:
        topic = resolve_transport_topic(self._node, "in", self._in_transport)
        return [
            self._node.create_subscription(_get_message_class(self._in_transport), topic, self._receive, DEFAULT_QOS)
        ]

    def _receive(self, message: Any) -> None:
        requested_transports = [
            name for name, publisher in self._publishers.items() if publisher.get_subscription_count()
        ]
        if requested_transports == [self._in_transport]:
            self._publishers[self._in_transport].publish(message)
            return
        try:
            image = _DECODERS[self._in_transport](message)
            for transport in requested_transports:
                self._encode_and_publish(transport, image)
        except ModuleNotFoundError:
            self._log_error(f"the transports need Pillow; {install_hint('image')}")
        except BadImageError as error:
            self._log_error(str(error))

    def _encode_and_publish(self, transport: str, image: Any) -> None:
        encoded = _ENCODERS[transport](image)
        if encoded is not None:
            self._publishers[transport].publish(encoded)
        elif len(self._publishers) == 1:
            self._log_error(f"the transport {transport} does not support the encoding {image.encoding}")

    def _log_error(self, reason: str) -> None:
        self._node.get_logger().error(
            f"An image cannot be republished: {reason}", throttle_duration_sec=_ERROR_PERIOD_S
        )


def resolve_transport_topic(node: Node, base: str, transport: str) -> str:
    """Return a transport's topic: the remapped base name with the transport appended."""
    if transport == "raw":
        return base
    resolved = node.resolve_topic_name(base)
    if resolved != node.resolve_topic_name(base, only_expand=True):
        return f"{resolved}/{transport}"
    return f"{base}/{transport}"


def _get_message_class(transport: str) -> Any:
    return get_message(_IMAGE_TYPE if transport == "raw" else _COMPRESSED_TYPE)
