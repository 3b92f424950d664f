"""A process with a real rclpy.

Run it with ``$LINKWRIGHT_ROS_PYTHON -m tests.wire.real_peer NODE_NAME``.

It has publishers on ``/from_ros``, ``/states_from_ros`` and ``/images_from_ros``, a best-effort one on
``/frames_from_ros``, a latched one on ``/lasting_from_ros``, and subscriptions of the same types to ``/to_ros`` and so
on; services ``/flip`` and ``/echo``; and a parameter ``speed``.
"""

from __future__ import annotations

import sys
import threading
import time
from typing import Any

import rclpy
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image, JointState
from sensor_msgs.srv import SetCameraInfo
from std_msgs.msg import String
from std_srvs.srv import SetBool

from tests.wire.node_program import result_of
from tests.wire.programs import serve

TRANSIENT_LOCAL = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
KINDS = {
    "": (String, 10),
    "lasting_": (String, TRANSIENT_LOCAL),
    "states_": (JointState, 200),
    "images_": (Image, 50),
    "frames_": (Image, QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)),
}


class RealPeer:
    def __init__(self, name: str) -> None:
        rclpy.init()
        self.node = Node(name)
        self.received_messages: dict[str, list[Any]] = {}
        self.publishers: dict[str, Any] = {}
        self.sent = 0
        self.mismatched: list[str] = []
        self.extra_nodes: list[Node] = []
        publisher_events = PublisherEventCallbacks(incompatible_qos=lambda _: self.mismatched.append("publisher"))
        subscription_events = SubscriptionEventCallbacks(
            incompatible_qos=lambda _: self.mismatched.append("subscription")
        )
        for kind, (message_type, qos) in KINDS.items():
            messages = self.received_messages.setdefault(f"{kind}to_ros", [])
            self.publishers[kind] = self.node.create_publisher(
                message_type, f"{kind}from_ros", qos, event_callbacks=publisher_events
            )
            self.node.create_subscription(
                message_type, f"{kind}to_ros", messages.append, qos, event_callbacks=subscription_events
            )
        self.node.create_service(SetBool, "flip", flip)
        self.node.create_service(SetCameraInfo, "echo", echo)
        self.node.declare_parameter("speed", 1.5)
        self.publishers["lasting_"].publish(String(data="said before"))
        threading.Thread(target=rclpy.spin, args=(self.node,), daemon=True).start()

    def make_nodes(self, count: int) -> None:
        self.extra_nodes = [rclpy.create_node(f"extra_{number}") for number in range(count)]

    def nodes(self) -> list[list[str]]:
        return sorted([namespace, name] for name, namespace in self.node.get_node_names_and_namespaces())

    def published_by(self, node: str) -> dict[str, list[str]]:
        is_known = node in self.node.get_node_names()
        return dict(self.node.get_publisher_names_and_types_by_node(node, "/")) if is_known else {}

    def hashes(self, topic: str) -> list[str]:
        """Return the type hashes of a topic's publishers."""
        return [str(endpoint.topic_type_hash) for endpoint in self.node.get_publishers_info_by_topic(topic)]

    def publish(self, text: str) -> None:
        self.publishers[""].publish(String(data=text))

    def publish_state(self, names: list[str], positions: list[float]) -> None:
        self.publishers["states_"].publish(JointState(name=names, position=positions))

    def publish_images(self, count: int, rate: float) -> None:
        """Publish numbered images at a rate, from a thread as a camera driver does.

        The frame ID is the number.
        """

        def work() -> None:
            image = Image(height=480, width=640, encoding="rgb8", step=1920, data=bytes(640 * 480 * 3))
            due = time.monotonic()
            for number in range(count):
                image.header.frame_id = str(number)
                self.publishers["images_"].publish(image)
                self.sent += 1
                due += 1 / rate
                time.sleep(max(0.0, due - time.monotonic()))

        threading.Thread(target=work, daemon=True).start()

    def sent_images(self) -> int:
        return self.sent

    def subscription_count(self, kind: str) -> int:
        """Return the number of matched subscriptions of a kind of topic."""
        return int(self.publishers[kind].get_subscription_count())

    def publisher_count(self, topic: str) -> int:
        """Return the number of publishers of a topic."""
        return int(self.node.count_publishers(topic))

    def wait_for_all(self, kind: str) -> bool:
        """Wait until all subscriptions have acknowledged all messages."""
        return bool(self.publishers[kind].wait_for_all_acked(Duration(seconds=30)))

    def echoes(self, service: str, texts: list[str]) -> list[str]:
        """Call an echo service with several texts at once, and return its answers."""
        client = self.node.create_client(SetCameraInfo, service)
        assert client.wait_for_service(60)
        requests = [SetCameraInfo.Request() for _ in texts]
        for request, text in zip(requests, texts, strict=True):
            request.camera_info.distortion_model = text
        answers = [result_of(client.call_async(request)).status_message for request in requests]
        self.node.destroy_client(client)
        return answers

    def count_correct_echoes(self, service: str, prefix: str, count: int) -> int:
        """Make many calls at once, and return the number of correct answers."""
        texts = [f"{prefix} {number}" for number in range(count)]
        return sum(text == answer for text, answer in zip(texts, self.echoes(service, texts), strict=True))

    def parameters_of(self, node: str) -> list[str]:
        """Return the names of a node's parameters.

        None if it does not answer, as after it was killed.
        """
        client = AsyncParameterClient(self.node, node)
        assert client.wait_for_services(60)
        try:
            return sorted(result_of(client.list_parameters([], 1), 2.0).result.names)
        except TimeoutError:
            return []

    def set_parameter_of(self, node: str, name: str, value: float) -> list[Any]:
        """Set a parameter, and return whether that succeeded, and its value."""
        client = AsyncParameterClient(self.node, node)
        assert client.wait_for_services(60)
        is_successful = result_of(client.set_parameters([Parameter(name, value=value)])).results[0].successful
        return [is_successful, result_of(client.get_parameters([name])).values[0].double_value]

    def received(self, topic: str) -> list[str]:
        return [message.data for message in self.received_messages[topic]]

    def received_states(self) -> list[list[Any]]:
        return [[list(message.name), list(message.position)] for message in self.received_messages["states_to_ros"]]

    def received_images(self, topic: str = "images_to_ros") -> list[int]:
        return [int(message.header.frame_id) for message in self.received_messages[topic]]

    def mismatches(self) -> list[str]:
        return self.mismatched


def flip(request: Any, response: Any) -> Any:
    response.success, response.message = not request.data, "by ROS"
    return response


def echo(request: Any, response: Any) -> Any:
    response.success, response.status_message = True, request.camera_info.distortion_model
    return response


def main() -> None:
    peer = RealPeer(sys.argv[1])
    questions = "make_nodes nodes published_by hashes publish publish_state publish_images received"
    questions += (
        " received_states sent_images subscription_count publisher_count wait_for_all received_images mismatches echoes"
    )
    questions += " count_correct_echoes parameters_of set_parameter_of"
    serve({question: getattr(peer, question) for question in questions.split()})
    rclpy.shutdown()


if __name__ == "__main__":
    main()
