"""A process with zenoh-ros2-sdk.

Run it with ``$LINKWRIGHT_ZENOH_SDK_PYTHON -m tests.wire.sdk_peer NODE_NAME``.

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
        self.received: list[str] = []
        self.requests: list[bool] = []
        self.publisher = ROS2Publisher("/from_sdk", node_name=name, **STRING)
        self.subscriber = ROS2Subscriber("/to_sdk", callback=self.on_message, node_name=name, **STRING)
        self.server = ROS2ServiceServer("/flip_sdk", callback=self.flip, node_name=name, **FLIP)

    def on_message(self, message: Any) -> None:
        self.received.append(message.data)

    def flip(self, request: Any) -> Any:
        self.requests.append(request.data)
        return self.server.response_msg_class(success=not request.data, message=f"{self.name} {len(self.requests)}")

    def publish(self, first: int, count: int) -> None:
        for number in range(first, first + count):
            self.publisher.publish(data=str(number))

    def call(self, clients: int, calls_per_client: int) -> list[list[str | None]]:
        """Call the service from several clients at once, and return their responses."""
        messages: list[list[str | None]] = [[] for _ in range(clients)]

        def run_client(index: int) -> None:
            client = ROS2ServiceClient("/flip", node_name=f"{self.name}_{index}", **FLIP)
            for number in range(calls_per_client):
                response = client.call(data=number % 2 == 1)
                messages[index].append(None if response is None else f"{response.success} {response.message}")
            client.close()

        threads = [threading.Thread(target=run_client, args=(index,)) for index in range(clients)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        return messages


def main() -> None:
    logging.disable()
    peer = SdkPeer(sys.argv[1])
    serve(
        {
            "received": lambda: peer.received,
            "request_count": lambda: len(peer.requests),
            "publish": peer.publish,
            "has_subscription": lambda: bool(peer.publisher.pub.matching_status.matching),
            "call": peer.call,
        }
    )
    os._exit(0)  # threads of the SDK never end, although its session is closed


if __name__ == "__main__":
    main()
