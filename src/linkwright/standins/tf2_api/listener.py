"""Listeners that fill a buffer from the transform topics (tf2_ros ``TransformListener``)."""

from __future__ import annotations

import threading
from typing import Any

from linkwright.graph.executors import ExternalShutdownException, ReentrantCallbackGroup
from linkwright.graph.qos.profile import STATIC_TF_SUBSCRIPTION_QOS, TF_QOS, QoSProfile
from linkwright.graph.transforms.listener import DEFAULT_STATIC_TF_TOPIC, DEFAULT_TF_TOPIC
from linkwright.messages import TFMessage
from linkwright.standins.rclpy_api.executors import SingleThreadedExecutor
from linkwright.standins.rclpy_api.node import Node

_AUTHORITY = "default_authority"


class TransformListener:
    """Adds the transforms of ``/tf`` and ``/tf_static`` to a buffer.

    The callbacks are in a reentrant group, so that another callback of the node can wait for a transform.

    Args:
        buffer: the buffer to fill.
        node: the node that subscribes; None for a separate node.
        spin_thread: whether a separate thread spins the node.
        qos: the QoS profile for ``/tf``.
        static_qos: the QoS profile for ``/tf_static``.
        tf_topic: the topic to use instead of ``/tf``.
        tf_static_topic: the topic to use instead of ``/tf_static``.
        static_only: whether to subscribe only to ``/tf_static``.
    """

    def __init__(
        self,
        buffer: Any,
        node: Node | None,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | int = TF_QOS,
        static_qos: QoSProfile | int = STATIC_TF_SUBSCRIPTION_QOS,
        tf_topic: str = DEFAULT_TF_TOPIC,
        tf_static_topic: str = DEFAULT_STATIC_TF_TOPIC,
        static_only: bool = False,
    ) -> None:
        self.buffer = buffer
        self.node = node or Node(
            f"transform_listener_impl_{id(self):010x}", enable_rosout=False, start_parameter_services=False
        )
        self.group = ReentrantCallbackGroup()
        self._subscriptions = [
            self.node.create_subscription(
                TFMessage, tf_static_topic, self.static_callback, static_qos, callback_group=self.group
            )
        ]
        if not static_only:
            self._subscriptions.append(
                self.node.create_subscription(TFMessage, tf_topic, self.callback, qos, callback_group=self.group)
            )
        self.executor: SingleThreadedExecutor | None = None
        if spin_thread:
            self.executor = SingleThreadedExecutor(context=self.node.context)
            self.executor.add_node(self.node)
            self.dedicated_listener_thread = threading.Thread(target=self._spin, daemon=True)
            self.dedicated_listener_thread.start()

    def unregister(self) -> None:
        """Destroy the subscriptions, and stop the thread that spins the node."""
        subscriptions, self._subscriptions = self._subscriptions, []
        for subscription in subscriptions:
            self.node.destroy_subscription(subscription)
        if self.executor is not None:
            self.executor.shutdown()
            self.dedicated_listener_thread.join()
            self.executor = None

    def callback(self, data: Any) -> None:
        """Add the transforms in a message of ``/tf`` to the buffer."""
        self.buffer.update(data, static=False, authority=_AUTHORITY)

    def static_callback(self, data: Any) -> None:
        """Add the transforms in a message of ``/tf_static`` to the buffer."""
        self.buffer.update(data, static=True, authority=_AUTHORITY)

    def _spin(self) -> None:
        executor = self.executor
        assert executor is not None
        try:
            executor.spin()
        except ExternalShutdownException:
            return


class StaticTransformListener(TransformListener):
    """Adds only the transforms of ``/tf_static`` to a buffer.

    Args:
        buffer: the buffer to fill.
        node: the node that subscribes.
        spin_thread: whether a separate thread spins the node.
        qos: the QoS profile for ``/tf_static``.
    """

    def __init__(
        self,
        buffer: Any,
        node: Node | None,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | int = STATIC_TF_SUBSCRIPTION_QOS,
    ) -> None:
        super().__init__(buffer, node, spin_thread=spin_thread, static_qos=qos, static_only=True)
