"""Fills a tf buffer from the topics."""

from __future__ import annotations

from linkwright.graph.node import Node
from linkwright.graph.qos import STATIC_TF_SUBSCRIPTION_QOS, TF_QOS
from linkwright.graph.transform_buffer import TransformBuffer
from linkwright.messages import TFMessage


class TransformListener:
    """Subscribes a node to ``/tf`` and ``/tf_static`` for a buffer.

    The topic names are absolute, as in tf2_ros: namespaces do not divide the transforms, remappings can.
    """

    def __init__(self, buffer: TransformBuffer, node: Node) -> None:
        self._buffer = buffer
        self._clock = node.get_clock()
        node.create_subscription(TFMessage, "/tf", self._on_tf, TF_QOS)
        node.create_subscription(TFMessage, "/tf_static", self._on_tf_static, STATIC_TF_SUBSCRIPTION_QOS)

    def _on_tf(self, message: TFMessage) -> None:
        self._buffer.update(message, static=False, now_ns=self._clock.now_ns())

    def _on_tf_static(self, message: TFMessage) -> None:
        self._buffer.update(message, static=True, now_ns=self._clock.now_ns())
