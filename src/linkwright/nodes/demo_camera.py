"""cam2image of image_tools without a camera: publishes a test pattern on ``image``."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, joined, phrase
from linkwright.graph import Graph
from linkwright.graph.qos.profile import HistoryPolicy, QoSProfile, ReliabilityPolicy
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors

_BAND_HEIGHT_FRACTION = 1 / 3
"""The height of the band with a gradient, as a fraction of the image's height."""


class DemoCamera(SingleNode):
    """The running cam2image node, with the same parameters as the ROS node.

    Raises:
        LinkwrightError: NODE421 if a parameter is invalid.
    """

    DEFAULT_NAME = "cam2image"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            self._start()

    def _start(self) -> None:
        node = self._node
        reliability: str = node.declare_parameter("reliability", "reliable").value
        history: str = node.declare_parameter("history", "keep_last").value
        depth: int = node.declare_parameter("depth", 10).value
        frequency: float = node.declare_parameter("frequency", 30.0).value
        width: int = node.declare_parameter("width", 320).value
        height: int = node.declare_parameter("height", 240).value
        node.declare_parameter("burger_mode", True)
        frame_id: str = node.declare_parameter("frame_id", "camera_frame").value
        for name, value in (("frequency", frequency), ("width", width), ("height", height), ("depth", depth)):
            if value <= 0:
                raise LinkwrightError(
                    Diagnostic(
                        "NODE421",
                        phrase("parameter '{name}' must be more than 0, but it is {value}", name=name, value=value),
                    )
                )
        qos = QoSProfile(
            depth=depth,
            history=HistoryPolicy[_parse_policy_name(HistoryPolicy, "history", history)],
            reliability=ReliabilityPolicy[_parse_policy_name(ReliabilityPolicy, "reliability", reliability)],
        )
        self._publisher = node.create_publisher(get_message("sensor_msgs/msg/Image"), "image", qos)
        self._image = _create_test_image(width, height)
        self._frame_id = frame_id
        self._count = 0
        node.create_timer(1.0 / frequency, self._publish)

    def _publish(self) -> None:
        self._count += 1
        self._node.get_logger().info(f"Publishing image #{self._count}")
        height, width, _ = self._image.shape
        message = get_message("sensor_msgs/msg/Image")()
        message.header.stamp = self._node.get_clock().now().to_msg()
        message.header.frame_id = self._frame_id
        message.height, message.width = height, width
        message.encoding = "bgr8"
        message.is_bigendian = 0
        message.step = width * 3
        message.data = np.roll(self._image, self._count * 4, axis=1).reshape(-1)
        self._publisher.publish(message)


def _create_test_image(width: int, height: int) -> NDArray[np.uint8]:
    """Return a test image with bars of eight colors above a ramp from black to white.

    The image has the channel order BGR and the shape (height, width, 3).
    """
    columns = np.arange(width)
    bars = 7 - columns * 8 // width
    image = np.empty((height, width, 3), dtype=np.uint8)
    image[:] = np.stack([bars & 1, bars >> 2 & 1, bars >> 1 & 1], axis=-1) * 255
    image[round(height * (1 - _BAND_HEIGHT_FRACTION)) :] = (columns * 255 // max(1, width - 1))[:, np.newaxis]
    return image


def _parse_policy_name(kind: type[HistoryPolicy | ReliabilityPolicy], name: str, value: str) -> str:
    choices = [policy.name.lower() for policy in kind if policy.name not in ("UNKNOWN", "BEST_AVAILABLE")]
    if value not in choices:
        raise LinkwrightError(
            Diagnostic(
                "NODE421",
                phrase("parameter '{name}' has the invalid value '{value}'", name=name, value=value),
                hint=phrase("choose from {names}", names=joined(choices)),
            )
        )
    return value.upper()
