"""A node that says, hears, serves and asks for any type, on whichever rclpy the interpreter has.

``-m tests.wire.typed_peer NODE_NAME``. Values follow from type and seed (`values`), so that both sides know what is
meant. Topics and services are named after their types.
"""

from __future__ import annotations

import threading
import time
from typing import Any

from rclpy.action import ActionClient, ActionServer
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from tests.wire.node_program import SECONDS, result_of, serve_node
from tests.wire.values import digest, interface, large, message_from_seed, plain

LASTING = QoSProfile(depth=20, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class TypedPeer(Node):
    def __init__(self, name: str) -> None:
        super().__init__(name)
        self._heard: dict[str, list[Any]] = {}
        self._asked: dict[str, list[Any]] = {}
        self._large: list[list[Any]] = []
        self._said: dict[str, Any] = {}

    def knows(self, types: list[str]) -> list[str]:
        """Those of some types that there are here."""
        return [name for name in types if _there_is(name)]

    def fields(self, name: str) -> dict[str, str]:
        return dict(interface(name).get_fields_and_field_types())

    def meant(self, name: str, seeds: int) -> list[Any]:
        return [plain(message_from_seed(interface(name), seed)) for seed in range(seeds)]

    def hear(self, types: list[str]) -> None:
        for name in types:
            messages = self._heard.setdefault(name, [])
            self.create_subscription(interface(name), _topic(name), messages.append, LASTING)

    def say(self, types: list[str], seeds: int) -> None:
        for name in types:
            publisher = self._said[name] = self.create_publisher(interface(name), _topic(name), LASTING)
            for seed in range(seeds):
                publisher.publish(message_from_seed(interface(name), seed))

    def counts(self) -> dict[str, int]:
        return {name: len(messages) for name, messages in self._heard.items()}

    def heard(self, name: str) -> list[Any]:
        return [plain(message) for message in self._heard[name]]

    def hear_large(self, topic: str) -> None:
        """What comes on a topic of images: its number, its size and the sum of its bytes."""
        kind = interface("sensor_msgs/msg/Image")
        self.create_subscription(
            kind, topic, lambda image: self._large.append([image.width, len(image.data), digest(image.data)]), 10
        )

    def say_large(self, topic: str, number: int, size: int) -> None:
        image = interface("sensor_msgs/msg/Image")(width=number, data=large(number, size))
        self._images(topic).publish(image)

    def said_to(self, topic: str) -> int:
        """How many hear what is published on it."""
        return int(self._images(topic).get_subscription_count())

    def heard_large(self) -> list[list[Any]]:
        return self._large

    def answer(self, services: list[str]) -> None:
        """Serve: the answer to the request number n has the values of the seed n."""
        for name in services:
            self.create_service(interface(name), _topic(name), self._server(name))

    def asked(self, name: str) -> list[Any]:
        return self._asked[name]

    def meant_by(self, name: str, seeds: int) -> list[Any]:
        """Requests and answers."""
        kind = interface(name)
        return [
            [plain(message_from_seed(part, seed)) for seed in range(seeds)] for part in (kind.Request, kind.Response)
        ]

    def ask(self, name: str, seeds: int) -> list[Any]:
        """The answers to requests one after another."""
        kind = interface(name)
        client = self.create_client(kind, _topic(name))
        assert client.wait_for_service(SECONDS)
        answers = [plain(result_of(client.call_async(message_from_seed(kind.Request, seed)))) for seed in range(seeds)]
        self.destroy_client(client)
        return answers

    def act(self, name: str) -> None:
        """Carry out goals of a type: feedback of seed 4, result of seed 5."""
        kind = interface(name)

        def execute(goal: Any) -> Any:
            self._asked.setdefault(name, []).append(plain(goal.request))
            until = time.monotonic() + SECONDS / 2
            while not self.count_subscribers(f"{_topic(name)}/_action/feedback") and time.monotonic() < until:
                time.sleep(0.01)  # what is said before the client's subscription is known is lost
            goal.publish_feedback(message_from_seed(kind.Feedback, 4))
            goal.succeed()
            return message_from_seed(kind.Result, 5)

        ActionServer(self, kind, _topic(name), execute)

    def send_goal(self, name: str) -> list[Any]:
        """A goal of seed 3: feedback and result, and what was meant by all three."""
        kind = interface(name)
        client = ActionClient(self, kind, _topic(name))
        assert client.wait_for_server(SECONDS)
        feedback: list[Any] = []
        came = threading.Event()

        def hear(text: Any) -> None:
            feedback.append(plain(text.feedback))
            came.set()

        goal = result_of(client.send_goal_async(message_from_seed(kind.Goal, 3), feedback_callback=hear))
        result = plain(result_of(goal.get_result_async()).result)
        came.wait(SECONDS)
        meant = [
            plain(message_from_seed(part, seed))
            for part, seed in ((kind.Goal, 3), (kind.Feedback, 4), (kind.Result, 5))
        ]
        return [feedback, result, meant]

    def hashes(self, name: str) -> list[str]:
        """As the publishers of its topic tell them."""
        return [str(endpoint.topic_type_hash) for endpoint in self.get_publishers_info_by_topic(_topic(name))]

    def _images(self, topic: str) -> Any:
        if topic not in self._said:
            self._said[topic] = self.create_publisher(interface("sensor_msgs/msg/Image"), topic, 10)
        return self._said[topic]

    def _server(self, name: str) -> Any:
        requests = self._asked.setdefault(name, [])

        def answer(request: Any, _: Any) -> Any:
            requests.append(plain(request))
            return message_from_seed(interface(name).Response, len(requests) - 1)

        return answer


def _topic(name: str) -> str:
    return f"/typed/{name}".lower().replace("/msg/", "/m_").replace("/srv/", "/s_").replace("/action/", "/a_")


def _there_is(name: str) -> bool:
    try:
        interface(name)
    except (ImportError, AttributeError):
        return False
    return True


if __name__ == "__main__":
    serve_node(
        TypedPeer,
        "knows fields meant hear say counts heard hear_large say_large said_to heard_large answer asked "
        "meant_by ask act send_goal hashes",
        threads=4,
    )
