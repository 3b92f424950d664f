"""The publishers of clients, which clients that publish on the same topic share."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field
from typing import Any

from linkwright.bridge.rosbridge.requests import RequestError, full_type_name
from linkwright.bridge.rosbridge.topic_types import find_topic_type
from linkwright.bridge.rosbridge.values import from_json_values
from linkwright.graph import DurabilityPolicy, Duration, Node, Publisher, QoSProfile
from linkwright.messages import get_message
from linkwright.nodes.standstill import VELOCITIES
from linkwright.nodes.velocity_topic import TWIST_STAMPED

_MAX_QUEUE_SIZE = 10_000
_LIFESPAN = Duration(seconds=1)
"""How long a subscription that is found late still receives a message."""


@dataclass(slots=True, eq=False)
class SharedPublisher:
    """A publisher with the clients that use it.

    Attributes:
        publisher: the publisher.
        message_class: the class of its messages.
        users: the clients that use it.
        driver: the client whose velocity, which is not zero, was published last; None if there is none.
        end_timer: destroys the publisher, which no client uses any more.
    """

    publisher: Publisher[Any]
    message_class: Any
    users: set[object] = field(default_factory=set)
    driver: object = None
    end_timer: asyncio.TimerHandle | None = None


class Publications:
    """The publishers of all clients.

    Args:
        node: the node that publishes.
        end_delay_s: the seconds for which a publisher is kept after its last client has gone.
    """

    def __init__(self, node: Node, end_delay_s: float) -> None:
        self._node = node
        self._end_delay_s = end_delay_s
        self._publishers: dict[str, SharedPublisher] = {}

    def open(
        self, user: object, topic: str, type_name: str | None, *, latches: bool = False, queue_size: int = 100
    ) -> SharedPublisher:
        """Return the publisher of a topic for a client.

        Args:
            user: the client.
            topic: the name in the client's request.
            type_name: the type of the messages; None for the type of the topic.
            latches: whether late subscriptions receive the last message.
            queue_size: how many messages are kept for a subscription.

        Raises:
            RequestError: the topic has another type, or is not known.
            LinkwrightError: the topic's name is not valid, or the type is unknown.
        """
        name = self._node.resolve_topic_name(topic)
        expected_type = type_name and full_type_name(type_name, "msg")
        shared = self._publishers.get(name)
        if shared is None:
            message_class = get_message(find_topic_type(self._node, name, expected_type))
            qos = QoSProfile(
                depth=1 if latches else max(1, min(queue_size, _MAX_QUEUE_SIZE)),
                durability=DurabilityPolicy.TRANSIENT_LOCAL,
            )
            if not latches:
                qos.lifespan = _LIFESPAN
            publisher = self._node.create_publisher(message_class, topic, qos)
            shared = self._publishers[name] = SharedPublisher(publisher, message_class)
        elif expected_type is not None and expected_type != shared.message_class.TYPE_NAME:
            raise RequestError(
                f"Tried to register topic {name} with type {expected_type[:200]} but it is already established with "
                f"type {shared.message_class.TYPE_NAME}"
            )
        shared.users.add(user)
        if shared.end_timer is not None:
            shared.end_timer.cancel()
            shared.end_timer = None
        return shared

    def publish(self, user: object, shared: SharedPublisher, values: Any) -> None:
        """Publish a message of a client.

        Raises:
            RequestError: a value does not fit its field.
        """
        now = self._node.get_clock().now
        message = from_json_values(values, shared.message_class, lambda: now().to_msg())
        shared.publisher.publish(message)
        if shared.publisher.type_name in VELOCITIES:
            velocity = message.twist if shared.publisher.type_name == TWIST_STAMPED else message
            shared.driver = user if velocity != type(velocity)() else None

    def close(self, user: object, topic: str, *, is_lost: bool = False) -> None:
        """End the use of a topic's publisher by a client.

        Args:
            user: the client.
            topic: the name in the client's request.
            is_lost: whether the connection to the client has ended. A robot that it drives is stopped.
        """
        name = self._node.resolve_topic_name(topic)
        shared = self._publishers.get(name)
        if shared is None or user not in shared.users:
            return
        if is_lost and shared.driver is user:
            self._stop(shared)
        shared.users.discard(user)
        if not shared.users and shared.end_timer is None:
            loop = asyncio.get_running_loop()
            shared.end_timer = loop.call_later(self._end_delay_s, self._destroy, name)

    def close_all(self) -> None:
        """Cancel the timers of publishers, which the node destroys."""
        for shared in self._publishers.values():
            if shared.end_timer is not None:
                shared.end_timer.cancel()

    def _stop(self, shared: SharedPublisher) -> None:
        shared.driver = None
        message = shared.message_class()
        if shared.publisher.type_name == TWIST_STAMPED:
            message.header.stamp = self._node.get_clock().now().to_msg()
        shared.publisher.publish(message)
        self._node.get_logger().warning(
            f"The client that drives the robot has disconnected: a stop command is sent to '{shared.publisher.name}'"
        )

    def _destroy(self, name: str) -> None:
        self._node.destroy_publisher(self._publishers.pop(name).publisher)
