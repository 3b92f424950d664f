"""Publish velocities as Twist or TwistStamped, depending on the subscribers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from linkwright.graph import EndpointKind, Node, Publisher

TWIST = "geometry_msgs/msg/Twist"
TWIST_STAMPED = "geometry_msgs/msg/TwistStamped"
_QUEUE_DEPTH = 10


def choose_velocity_types(node: Node, topic: str, stamped: bool | None) -> tuple[str, ...]:
    """Return the message types to subscribe to for velocities.

    The result is one type if `stamped` is True or False, and both types if it is None. If TwistStamped is already
    published, it comes first, so that no warning about a type mismatch is logged.
    """
    if stamped is not None:
        return (TWIST_STAMPED if stamped else TWIST,)
    published_types = {endpoint.topic_type for endpoint in node.get_publishers_info_by_topic(topic)}
    return (TWIST_STAMPED, TWIST) if TWIST_STAMPED in published_types else (TWIST, TWIST_STAMPED)


class VelocityTopic:
    """A publisher of velocities on a topic whose type is Twist or TwistStamped.

    If the topic has another type, nothing is published.

    Args:
        node: the node that publishes.
        topic: the name before remapping.
        stamped: whether to publish TwistStamped. None to publish the type that the subscribers expect, or Twist if
            there are no subscribers or subscribers of both types.
        frame_id: the frame in the header of a TwistStamped.

    Attributes:
        name: the full name of the topic, after remapping.
        foreign_type: a type on the topic that is neither Twist nor TwistStamped, or None.

    Raises:
        LinkwrightError: `topic` is not a valid topic name.
    """

    def __init__(self, node: Node, topic: str, stamped: bool | None = None, frame_id: str = "") -> None:
        self._node = node
        self._topic = topic
        self._stamped = stamped
        self.frame_id = frame_id
        self._publisher: Publisher[Any] | None = None
        self.name = node.resolve_topic_name(topic)
        self.foreign_type: str | None = None
        self.update_type()

    @property
    def type_name(self) -> str:
        """The message type that is published, or an empty string if there is no publisher."""
        return self._publisher.type_name if self._publisher is not None else ""

    def update_type(self, *, may_change: bool = True) -> int:
        """Change the published type to the type that the subscribers expect.

        Args:
            may_change: whether the type may change; the type must not change while the robot moves.

        Returns:
            The number of subscribers with the published type.
        """
        own_gid = None if self._publisher is None else self._publisher.gid
        other_endpoints = [
            endpoint
            for endpoint in self._node.graph.endpoints()
            if endpoint.name == self.name and endpoint.gid != own_gid
        ]
        self.foreign_type = min({other.type_name for other in other_endpoints} - {TWIST, TWIST_STAMPED}, default=None)
        if self.foreign_type is not None:
            self.stop()
            self.close()
            return 0
        subscriber_types = [other.type_name for other in other_endpoints if other.kind is EndpointKind.SUBSCRIPTION]
        message_type = self._choose_type(subscriber_types)
        if self._publisher is None or (may_change and self._publisher.type_name != message_type):
            self.close()
            self._publisher = self._node.create_publisher(message_type, self._topic, _QUEUE_DEPTH)
        return subscriber_types.count(self._publisher.type_name)

    def publish(self, linear: Sequence[float], angular: Sequence[float]) -> None:
        """Publish a velocity if there is a publisher.

        Args:
            linear: the linear velocity along x, y and z, in m/s.
            angular: the angular velocity about x, y and z, in rad/s.
        """
        publisher = self._publisher
        if publisher is None:
            return
        message = publisher.msg_type()
        twist = message
        if publisher.type_name == TWIST_STAMPED:
            message.header.stamp = self._node.get_clock().now().to_msg()
            message.header.frame_id = self.frame_id
            twist = message.twist
        for vector, values in ((twist.linear, linear), (twist.angular, angular)):
            vector.x, vector.y, vector.z = map(float, values)
        publisher.publish(message)

    def stop(self) -> None:
        """Publish a velocity of zero."""
        self.publish((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))

    def close(self) -> None:
        """Destroy the publisher."""
        if self._publisher is not None:
            self._node.destroy_publisher(self._publisher)
            self._publisher = None

    def _choose_type(self, subscriber_types: Sequence[str]) -> str:
        if self._stamped is not None:
            return TWIST_STAMPED if self._stamped else TWIST
        return TWIST_STAMPED if TWIST_STAMPED in subscriber_types and TWIST not in subscriber_types else TWIST
