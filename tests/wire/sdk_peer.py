"""A process with zenoh-ros2-sdk: ``$LINKWRIGHT_ZENOH_SDK_PYTHON -m tests.wire.sdk_peer NODE_NAME``.

It publishes on ``/from_sdk``, subscribes to ``/to_sdk``, and serves ``/flip_sdk``. The hashes of types are its own.
"""

from __future__ import annotations

import logging
import os
import sys
import threading
from typing import Any

from zenoh_ros2_sdk import ROS2Publisher, ROS2ServiceClient, ROS2ServiceServer, ROS2Subscriber

from tests.wire.programs import serve

STRING = {"msg_type": "std_msgs/msg/String", "msg_definition": "string data"}
FLIP = {
    "srv_type": "std_srvs/srv/SetBool",
    "request_definition": "bool data",
    "response_definition": "bool success\nstring message",
}


class SdkPeer:
    def __init__(self, name: str) -> None:
        self.name = name
        self.heard: list[str] = []
        self.served: list[bool] = []
        self.publisher = ROS2Publisher("/from_sdk", node_name=name, **STRING)
        self.subscriber = ROS2Subscriber("/to_sdk", callback=self.hear, node_name=name, **STRING)
        self.server = ROS2ServiceServer("/flip_sdk", callback=self.flip, node_name=name, **FLIP)

    def hear(self, message: Any) -> None:
        self.heard.append(message.data)

    def flip(self, request: Any) -> Any:
        self.served.append(request.data)
        return self.server.response_msg_class(success=not request.data, message=f"{self.name} {len(self.served)}")

    def say(self, first: int, count: int) -> None:
        for number in range(first, first + count):
            self.publisher.publish(data=str(number))

    def call(self, clients: int, calls_per_client: int) -> list[list[str | None]]:
        """What several clients are told, each of which asks so many times, all at once."""
        messages: list[list[str | None]] = [[] for _ in range(clients)]

        def ask(which: int) -> None:
            client = ROS2ServiceClient("/flip", node_name=f"{self.name}_{which}", **FLIP)
            for number in range(calls_per_client):
                response = client.call(data=number % 2 == 1)
                messages[which].append(None if response is None else f"{response.success} {response.message}")
            client.close()

        asking = [threading.Thread(target=ask, args=(which,)) for which in range(clients)]
        for thread in asking:
            thread.start()
        for thread in asking:
            thread.join()
        return messages


def main() -> None:
    logging.disable()
    peer = SdkPeer(sys.argv[1])
    serve(
        {
            "heard": lambda: peer.heard,
            "served": lambda: len(peer.served),
            "say": peer.say,
            "listeners": lambda: bool(peer.publisher.pub.matching_status.matching),
            "call": peer.call,
        }
    )
    os._exit(0)  # threads of the SDK would keep it for ever; its session is gone all the same


if __name__ == "__main__":
    main()
