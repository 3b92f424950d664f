"""A node that publishes, receives, serves and calls any type.

It runs on any rclpy of the interpreter.

``-m tests.wire.typed_peer NODE_NAME``. Values follow from type and seed (`values`), so that both sides know what to
expect. Topics and services are named after their types.
"""

from __future__ import annotations

import threading
import time
from typing import Any

from rclpy.action import ActionClient, ActionServer
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from tests.wire.node_program import TIMEOUT_S, result_of, serve_node
from tests.wire.values import load_interface, make_bytes, message_from_seed, sha256_of, to_json_value

LATCHED = QoSProfile(depth=20, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class TypedPeer(Node):
    def __init__(self, name: str) -> None:
        super().__init__(name)
        self._received: dict[str, list[Any]] = {}
        self._requests: dict[str, list[Any]] = {}
        self._large: list[list[Any]] = []
        self._publishers_by_topic: dict[str, Any] = {}

    def available_types(self, types: list[str]) -> list[str]:
        """Return the given types that this interpreter has."""
        return [name for name in types if _is_available(name)]

    def fields(self, name: str) -> dict[str, str]:
        return dict(load_interface(name).get_fields_and_field_types())

    def expected(self, name: str, seeds: int) -> list[Any]:
        return [to_json_value(message_from_seed(load_interface(name), seed)) for seed in range(seeds)]

    def subscribe(self, types: list[str]) -> None:
        for name in types:
            messages = self._received.setdefault(name, [])
            self.create_subscription(load_interface(name), _topic(name), messages.append, LATCHED)

    def publish(self, types: list[str], seeds: int) -> None:
        for name in types:
            publisher = self._publishers_by_topic[name] = self.create_publisher(
                load_interface(name), _topic(name), LATCHED
            )
            for seed in range(seeds):
                publisher.publish(message_from_seed(load_interface(name), seed))

    def counts(self) -> dict[str, int]:
        return {name: len(messages) for name, messages in self._received.items()}

    def received(self, name: str) -> list[Any]:
        return [to_json_value(message) for message in self._received[name]]

    def subscribe_large(self, topic: str) -> None:
        """Record the number, size and digest of each image on a topic."""
        image_type = load_interface("sensor_msgs/msg/Image")
        self.create_subscription(
            image_type,
            topic,
            lambda image: self._large.append([image.width, len(image.data), sha256_of(image.data)]),
            10,
        )

    def publish_large(self, topic: str, number: int, size: int) -> None:
        image = load_interface("sensor_msgs/msg/Image")(width=number, data=make_bytes(number, size))
        self._images(topic).publish(image)

    def subscription_count(self, topic: str) -> int:
        """Return the number of matched subscriptions."""
        return int(self._images(topic).get_subscription_count())

    def received_large(self) -> list[list[Any]]:
        return self._large

    def serve(self, services: list[str]) -> None:
        """Serve these services: the response to request n has the values of seed n."""
        for name in services:
            self.create_service(load_interface(name), _topic(name), self._server(name))

    def requests(self, name: str) -> list[Any]:
        return self._requests[name]

    def expected_calls(self, name: str, seeds: int) -> list[Any]:
        """Return the expected requests and responses of these seeds."""
        service_type = load_interface(name)
        return [
            [to_json_value(message_from_seed(message_type, seed)) for seed in range(seeds)]
            for message_type in (service_type.Request, service_type.Response)
        ]

    def call(self, name: str, seeds: int) -> list[Any]:
        """Call a service once for each seed, one call after another, and return the responses."""
        service_type = load_interface(name)
        client = self.create_client(service_type, _topic(name))
        assert client.wait_for_service(TIMEOUT_S)
        responses = [
            to_json_value(result_of(client.call_async(message_from_seed(service_type.Request, seed))))
            for seed in range(seeds)
        ]
        self.destroy_client(client)
        return responses

    def serve_action(self, name: str) -> None:
        """Serve an action: the feedback has the values of seed 4, the result those of seed 5."""
        action_type = load_interface(name)

        def execute(goal: Any) -> Any:
            self._requests.setdefault(name, []).append(to_json_value(goal.request))
            deadline = time.monotonic() + TIMEOUT_S / 2
            while not self.count_subscribers(f"{_topic(name)}/_action/feedback") and time.monotonic() < deadline:
                time.sleep(0.01)  # feedback published before the client's subscription is known is lost
            goal.publish_feedback(message_from_seed(action_type.Feedback, 4))
            goal.succeed()
            return message_from_seed(action_type.Result, 5)

        ActionServer(self, action_type, _topic(name), execute)

    def send_goal(self, name: str) -> list[Any]:
        """Send a goal with the values of seed 3.

        Return feedback, result, and the expected values of all three.
        """
        action_type = load_interface(name)
        client = ActionClient(self, action_type, _topic(name))
        assert client.wait_for_server(TIMEOUT_S)
        feedback: list[Any] = []
        has_feedback = threading.Event()

        def on_feedback(message: Any) -> None:
            feedback.append(to_json_value(message.feedback))
            has_feedback.set()

        goal = result_of(client.send_goal_async(message_from_seed(action_type.Goal, 3), feedback_callback=on_feedback))
        result = to_json_value(result_of(goal.get_result_async()).result)
        has_feedback.wait(TIMEOUT_S)
        expected = [
            to_json_value(message_from_seed(message_type, seed))
            for message_type, seed in ((action_type.Goal, 3), (action_type.Feedback, 4), (action_type.Result, 5))
        ]
        return [feedback, result, expected]

    def hashes(self, name: str) -> list[str]:
        """Return the type hashes that a topic's publishers announce."""
        return [str(endpoint.topic_type_hash) for endpoint in self.get_publishers_info_by_topic(_topic(name))]

    def _images(self, topic: str) -> Any:
        if topic not in self._publishers_by_topic:
            self._publishers_by_topic[topic] = self.create_publisher(load_interface("sensor_msgs/msg/Image"), topic, 10)
        return self._publishers_by_topic[topic]

    def _server(self, name: str) -> Any:
        requests = self._requests.setdefault(name, [])

        def serve(request: Any, _: Any) -> Any:
            requests.append(to_json_value(request))
            return message_from_seed(load_interface(name).Response, len(requests) - 1)

        return serve


def _topic(name: str) -> str:
    return f"/typed/{name}".lower().replace("/msg/", "/m_").replace("/srv/", "/s_").replace("/action/", "/a_")


def _is_available(name: str) -> bool:
    try:
        load_interface(name)
    except (ImportError, AttributeError):
        return False
    return True


if __name__ == "__main__":
    serve_node(
        TypedPeer,
        "available_types fields expected subscribe publish counts received subscribe_large publish_large "
        "subscription_count received_large serve requests expected_calls call serve_action send_goal hashes",
        threads=4,
    )
