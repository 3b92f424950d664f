"""A node whose endpoints have any quality of service, on any rclpy.

Run it with ``-m tests.wire.qos_peer NODE_NAME``.

A quality of service is a dictionary: ``{"preset": "sensor_data"}``, or policies by name and, in seconds,
``deadline``, ``lifespan`` and ``lease``.
"""

from __future__ import annotations

from typing import Any

from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import (
    DurabilityPolicy,
    LivelinessPolicy,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
)
from std_msgs.msg import String

from tests.wire.node_program import serve_node

POLICIES = {"reliability": ReliabilityPolicy, "durability": DurabilityPolicy, "liveliness": LivelinessPolicy}
DURATIONS = {"deadline": "deadline", "lifespan": "lifespan", "lease": "liveliness_lease_duration"}


class QosPeer(Node):
    def __init__(self, name: str) -> None:
        super().__init__(name)
        self._publishers_by_topic: dict[str, Any] = {}
        self._received: dict[str, list[str]] = {}
        self._events: dict[str, list[list[Any]]] = {}
        self._timers_by_topic: dict[str, Any] = {}

    def publisher(self, topic: str, qos: dict[str, Any]) -> None:
        callbacks = self._callbacks(PublisherEventCallbacks, topic)
        self._publishers_by_topic[topic] = self.create_publisher(
            String, topic, make_profile(qos), event_callbacks=callbacks
        )

    def subscription(self, topic: str, qos: dict[str, Any]) -> None:
        texts = self._received.setdefault(topic, [])
        self.create_subscription(
            String,
            topic,
            lambda message: texts.append(message.data),
            make_profile(qos),
            event_callbacks=self._callbacks(SubscriptionEventCallbacks, topic),
        )

    def publish(self, topic: str, text: str) -> None:
        self._publishers_by_topic[topic].publish(String(data=text))

    def keep_publishing(self, topic: str, period: float) -> None:
        self._timers_by_topic[topic] = self.create_timer(period, lambda: self.publish(topic, "again"))

    def stop_publishing(self, topic: str) -> None:
        self._timers_by_topic.pop(topic).cancel()

    def assert_liveliness(self, topic: str) -> None:
        self._publishers_by_topic[topic].assert_liveliness()

    def received(self, topic: str) -> list[str]:
        return self._received[topic]

    def events(self, topic: str) -> list[list[Any]]:
        """Return the events of a topic's endpoints: the kind of each, and its numbers."""
        return self._events.get(topic, [])

    def subscription_counts(self) -> dict[str, int]:
        """Return the number of matched subscriptions by topic."""
        return {topic: publisher.get_subscription_count() for topic, publisher in self._publishers_by_topic.items()}

    def publisher_count(self, topic: str) -> int:
        """Return the number of discovered publishers."""
        return self.count_publishers(topic)

    def _callbacks(self, callbacks_type: Any, topic: str) -> Any:
        events = self._events.setdefault(topic, [])
        callbacks = {
            "incompatible_qos": lambda info: events.append(["incompatible", int(info.last_policy_kind)]),
            "deadline": lambda info: events.append(["deadline", info.total_count]),
            "matched": lambda info: events.append(["matched", info.current_count]),
        }
        if callbacks_type is PublisherEventCallbacks:
            callbacks["liveliness"] = lambda info: events.append(["lost", info.total_count])
        else:
            callbacks["liveliness"] = lambda info: events.append(["alive", info.alive_count, info.not_alive_count])
        return callbacks_type(**callbacks)


def make_profile(qos: dict[str, Any]) -> Any:
    if "preset" in qos:
        return QoSPresetProfiles.get_from_short_key(qos["preset"])
    policies = {name: POLICIES[name][value.upper()] for name, value in qos.items() if name in POLICIES}
    durations = {DURATIONS[name]: Duration(seconds=value) for name, value in qos.items() if name in DURATIONS}
    return QoSProfile(depth=qos.get("depth", 10), **policies, **durations)


if __name__ == "__main__":
    serve_node(
        QosPeer,
        "publisher subscription publish keep_publishing stop_publishing assert_liveliness received events "
        "subscription_counts publisher_count",
    )
