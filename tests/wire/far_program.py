"""A process with a graph on some host: ``python -m tests.wire.far_program NODE_NAME``."""

from __future__ import annotations

import os
import sys
import threading
import time
from typing import Any

from linkwright.graph import Graph
from linkwright.graph.executors import SingleThreadedExecutor
from linkwright.graph.qos.profile import DurabilityPolicy, HistoryPolicy, QoSProfile
from linkwright.messages import get_message
from linkwright.wire.joining import join
from tests.wire.programs import serve

Image = get_message("sensor_msgs/msg/Image")
QOS = {
    "everything": QoSProfile(history=HistoryPolicy.KEEP_ALL),
    "lasting": QoSProfile(2000, durability=DurabilityPolicy.TRANSIENT_LOCAL),
    "last": QoSProfile(10),
}


class FarProgram:
    def __init__(self, name: str) -> None:
        self.graph = Graph(threads=True)
        self.node = self.graph.create_node(name)
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.numbers: dict[str, list[int]] = {}
        self.published_counts: dict[str, int] = {}
        self.publishers: dict[str, Any] = {}
        transport = join(self.graph)
        assert transport is not None
        transport.wait_until_ready(60)  # returns False if the router rejects this process
        threading.Thread(target=self.executor.spin, daemon=True).start()

    def subscribe(self, topic: str, qos: str) -> None:
        """Record the numbers of the topic's messages."""
        numbers = self.numbers.setdefault(topic, [])
        self.node.create_subscription(Image, topic, lambda message: numbers.append(message.width), QOS[qos])

    def advertise(self, topic: str, qos: str) -> None:
        """Create a publisher."""
        self.published_counts[topic] = 0
        self.publishers[topic] = self.node.create_publisher(Image, topic, QOS[qos])

    def publish_numbers(self, topic: str, count: int, rate: float, size: int) -> None:
        """Publish numbered messages from a thread."""
        publisher, message = self.publishers[topic], Image(data=os.urandom(size))

        def run() -> None:
            start, first = time.monotonic(), self.published_counts[topic]
            for number in range(count):
                message.width = first + number
                publisher.publish(message)
                self.published_counts[topic] += 1
                time.sleep(max(0.0, start + (number + 1) / rate - time.monotonic()))

        threading.Thread(target=run, daemon=True).start()

    def nodes(self) -> list[str]:
        return sorted(name for name, _ in self.node.get_node_names_and_namespaces())


if __name__ == "__main__":
    program = FarProgram(sys.argv[1])
    serve(
        {
            "subscribe": program.subscribe,
            "received": lambda topic: program.numbers[topic],
            "advertise": program.advertise,
            "publish_numbers": program.publish_numbers,
            "published_count": lambda topic: program.published_counts[topic],
            "subscription_count": lambda topic: program.publishers[topic].get_subscription_count(),
            "nodes": program.nodes,
        }
    )
    program.executor.shutdown()
    program.graph.close_threadsafe()
