"""A node whose endpoints have any quality of service, on whichever rclpy: ``-m tests.wire.qos_peer NODE_NAME``.

A quality of service is given as a dictionary: ``{"preset": "sensor_data"}``, or policies by name and, in seconds,
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
        self._out: dict[str, Any] = {}
        self._heard: dict[str, list[str]] = {}
        self._told: dict[str, list[list[Any]]] = {}
        self._timers_of: dict[str, Any] = {}

    def publisher(self, topic: str, qos: dict[str, Any]) -> None:
        callbacks = self._callbacks(PublisherEventCallbacks, topic)
        self._out[topic] = self.create_publisher(String, topic, profile(qos), event_callbacks=callbacks)

    def subscription(self, topic: str, qos: dict[str, Any]) -> None:
        texts = self._heard.setdefault(topic, [])
        self.create_subscription(
            String,
            topic,
            lambda text: texts.append(text.data),
            profile(qos),
            event_callbacks=self._callbacks(SubscriptionEventCallbacks, topic),
        )

    def say(self, topic: str, text: str) -> None:
        self._out[topic].publish(String(data=text))

    def keep_saying(self, topic: str, period: float) -> None:
        self._timers_of[topic] = self.create_timer(period, lambda: self.say(topic, "again"))

    def fall_silent(self, topic: str) -> None:
        self._timers_of.pop(topic).cancel()

    def assert_liveliness(self, topic: str) -> None:
        self._out[topic].assert_liveliness()

    def heard(self, topic: str) -> list[str]:
        return self._heard[topic]

    def told(self, topic: str) -> list[list[Any]]:
        """The events of an endpoint: kind and what is told."""
        return self._told.get(topic, [])

    def listeners(self) -> dict[str, int]:
        """How many hear what is published on each topic."""
        return {topic: publisher.get_subscription_count() for topic, publisher in self._out.items()}

    def publishers(self, topic: str) -> int:
        """How many are known."""
        return self.count_publishers(topic)

    def _callbacks(self, kind: Any, topic: str) -> Any:
        received = self._told.setdefault(topic, [])
        callbacks = {
            "incompatible_qos": lambda info: received.append(["incompatible", int(info.last_policy_kind)]),
            "deadline": lambda info: received.append(["deadline", info.total_count]),
            "matched": lambda info: received.append(["matched", info.current_count]),
        }
        if kind is PublisherEventCallbacks:
            callbacks["liveliness"] = lambda info: received.append(["lost", info.total_count])
        else:
            callbacks["liveliness"] = lambda info: received.append(["alive", info.alive_count, info.not_alive_count])
        return kind(**callbacks)


def profile(qos: dict[str, Any]) -> Any:
    if "preset" in qos:
        return QoSPresetProfiles.get_from_short_key(qos["preset"])
    policies = {name: POLICIES[name][value.upper()] for name, value in qos.items() if name in POLICIES}
    durations = {DURATIONS[name]: Duration(seconds=value) for name, value in qos.items() if name in DURATIONS}
    return QoSProfile(depth=qos.get("depth", 10), **policies, **durations)


if __name__ == "__main__":
    serve_node(
        QosPeer,
        "publisher subscription say keep_saying fall_silent assert_liveliness heard told listeners publishers",
    )
