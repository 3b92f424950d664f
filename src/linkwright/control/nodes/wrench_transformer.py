"""wrench_transformer_node of force_torque_sensor_broadcaster, which publishes a wrench in other frames.

Source: force_torque_sensor_broadcaster of ros2_controllers (topics, parameters, messages). As there, force and torque
are rotated, and the torque is not moved to the origin of the other frame. A wrench whose frame is not known yet is
skipped at once, so the parameter ``tf_timeout`` has no effect.
"""

from __future__ import annotations

from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import Graph, Time
from linkwright.graph.parameters.parameter import ParameterType
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.errors import TransformException
from linkwright.graph.transforms.geometry import do_transform_wrench
from linkwright.graph.transforms.listener import TransformListener
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors

_WRENCH = "geometry_msgs/msg/WrenchStamped"
_QUEUE_DEPTH = 10
_LOG_PERIOD_S = 5.0


class WrenchTransformer(SingleNode):
    """The running wrench_transformer_node.

    Its arguments, or the parameter ``target_frames``, name the frames. The topic of a frame is below the namespace of
    the node, or below its name in the root namespace.

    Raises:
        LinkwrightError: NODE906, there are no target frames.
    """

    DEFAULT_NAME = "fts_wrench_transformer"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            self._node.declare_parameter("tf_timeout", 0.1)
            parameter = self._node.declare_parameter("target_frames", ParameterType.STRING_ARRAY).value
            frames = arguments or [str(frame) for frame in parameter or ()]
            if not frames:
                message = phrase("'target_frames' names no frame")
                raise LinkwrightError(
                    Diagnostic("NODE906", message, hint=phrase("set the parameter, or pass the frames as arguments"))
                )
            self._transforms = BufferCore(logger=self._node.get_logger().get_child("tf2"))
            TransformListener(self._transforms, self._node)
            self._node.create_subscription(_WRENCH, "~/wrench", self._on_wrench, _QUEUE_DEPTH)
            suffix = "_filtered" if "filtered" in self._node.resolve_topic_name("~/wrench") else ""
            namespace = self._node.get_namespace().rstrip("/") or f"/{self._node.get_name()}"
            self._publishers: dict[str, Any] = {
                frame: self._node.create_publisher(_WRENCH, f"{namespace}/{frame}/wrench{suffix}", _QUEUE_DEPTH)
                for frame in frames
            }

    def _on_wrench(self, wrench: Any) -> None:
        logger, frame = self._node.get_logger(), wrench.header.frame_id
        if not frame:
            logger.error("Invalid wrench message or frame_id is empty", throttle_duration_sec=_LOG_PERIOD_S)
            return
        for target, publisher in self._publishers.items():
            try:
                transform = self._transforms.lookup_transform_core(target, frame, Time())
            except TransformException as error:
                text = f"Transform exception: {error}"
                logger.error(text, throttle_duration_sec=_LOG_PERIOD_S)  # noqa: TRY400 - the message is for users
                continue
            result = do_transform_wrench(wrench, transform)
            result.header.stamp = wrench.header.stamp
            publisher.publish(result)
