"""Transform listeners, which fill a tf buffer from ``/tf`` and ``/tf_static``."""

from __future__ import annotations

from typing import Any, Protocol

from linkwright.graph.qos.profile import STATIC_TF_SUBSCRIPTION_QOS, TF_QOS, QoSProfile
from linkwright.messages import TFMessage

DEFAULT_TF_TOPIC = "/tf"
DEFAULT_STATIC_TF_TOPIC = "/tf_static"


class FillableBuffer(Protocol):
    """A buffer that a listener fills."""

    def update(self, message: TFMessage, *, static: bool, now_ns: int) -> None:
        """Store the transforms of a message."""


class TransformListener:
    """Stores the transforms from ``/tf`` and ``/tf_static`` in a buffer.

    The topic names are absolute, as in tf2_ros: namespaces do not separate the transforms, but remappings can.

    Args:
        buffer: receives the transforms.
        node: the node that subscribes.
        qos: the QoS for ``/tf``.
        static_qos: the QoS for ``/tf_static``.
        static_only: whether to subscribe only to ``/tf_static``.
        tf_topic: the topic to use instead of ``/tf``.
        tf_static_topic: the topic to use instead of ``/tf_static``.
    """

    def __init__(
        self,
        buffer: FillableBuffer,
        node: Any,
        *,
        qos: QoSProfile | int | None = None,
        static_qos: QoSProfile | int | None = None,
        static_only: bool = False,
        tf_topic: str = DEFAULT_TF_TOPIC,
        tf_static_topic: str = DEFAULT_STATIC_TF_TOPIC,
    ) -> None:
        self.buffer = buffer
        self.node = node
        self._clock = node.get_clock()
        self._subscriptions = [
            node.create_subscription(
                TFMessage,
                tf_static_topic,
                self.static_callback,
                STATIC_TF_SUBSCRIPTION_QOS if static_qos is None else static_qos,
            )
        ]
        if not static_only:
            self._subscriptions.append(
                node.create_subscription(TFMessage, tf_topic, self.callback, TF_QOS if qos is None else qos)
            )
        for subscription in self._subscriptions:
            subscription.deliver_in_batches()

    def unregister(self) -> None:
        """Destroy the subscriptions.

        The buffer keeps its transforms.
        """
        for subscription in self._subscriptions:
            self.node.destroy_subscription(subscription)
        self._subscriptions = []

    def callback(self, data: TFMessage) -> None:
        """Store a message of ``/tf`` in the buffer."""
        self.buffer.update(data, static=False, now_ns=self._clock.now().nanoseconds)

    def static_callback(self, data: TFMessage) -> None:
        """Store a message of ``/tf_static`` in the buffer."""
        self.buffer.update(data, static=True, now_ns=self._clock.now().nanoseconds)
