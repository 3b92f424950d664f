"""Waiting for a single message (rclpy ``wait_for_message``)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.graph.executors import ReentrantCallbackGroup
from linkwright.graph.loop.future import Future
from linkwright.graph.qos.profile import DEFAULT_QOS, QoSProfile
from linkwright.standins.rclpy_api.executors import SingleThreadedExecutor

if TYPE_CHECKING:
    from linkwright.standins.rclpy_api.node import Node


def wait_for_message(
    msg_type: type[Any],
    node: Node,
    topic: str,
    *args: Any,
    qos_profile: QoSProfile | int = DEFAULT_QOS,
    time_to_wait: float = -1,
) -> tuple[bool, Any]:
    """Wait for the next message of a topic, whether or not the node is spinning.

    Args:
        msg_type: the message class.
        node: the node that subscribes.
        topic: the name of the topic.
        args: `time_to_wait` as a positional argument, which Humble accepts.
        qos_profile: the QoS profile of the subscription.
        time_to_wait: the maximum time to wait, in seconds; negative for no limit.

    Returns:
        ``(True, message)``, or ``(False, None)`` if no message arrived.
    """
    if args:
        (time_to_wait,) = args
    message_future: Future[Any] = Future()

    def receive(message: Any) -> None:
        if not message_future.done():
            message_future.set_result(message)

    subscription = node.create_subscription(
        msg_type, topic, receive, qos_profile, callback_group=ReentrantCallbackGroup()
    )
    executor = SingleThreadedExecutor(context=node.context)
    subscription.set_dispatcher(executor)
    try:
        executor.spin_until_future_complete(message_future, time_to_wait)
    finally:
        node.destroy_subscription(subscription)
        executor.shutdown()
    return message_future.done(), message_future.result() if message_future.done() else None
