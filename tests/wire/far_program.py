"""A process with a graph of ours on some host: ``python -m tests.wire.far_program NODE_NAME``."""

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
        self.heard: dict[str, list[int]] = {}
        self.said: dict[str, int] = {}
        self.publishers: dict[str, Any] = {}
        transport = join(self.graph)
        assert transport is not None
        transport.wait_until_ready(60)  # or not at all, where it is not let in
        threading.Thread(target=self.executor.spin, daemon=True).start()

    def hear(self, topic: str, qos: str) -> None:
        """Take down the numbers of messages."""
        texts = self.heard.setdefault(topic, [])
        self.node.create_subscription(Image, topic, lambda message: texts.append(message.width), QOS[qos])

    def offer(self, topic: str, qos: str) -> None:
        """Have a publisher."""
        self.said[topic] = 0
        self.publishers[topic] = self.node.create_publisher(Image, topic, QOS[qos])

    def say(self, topic: str, count: int, rate: float, size: int) -> None:
        """Number so many messages, in a thread."""
        publisher, message = self.publishers[topic], Image(data=os.urandom(size))

        def run() -> None:
            begin, first = time.monotonic(), self.said[topic]
            for number in range(count):
                message.width = first + number
                publisher.publish(message)
                self.said[topic] += 1
                time.sleep(max(0.0, begin + (number + 1) / rate - time.monotonic()))

        threading.Thread(target=run, daemon=True).start()

    def nodes(self) -> list[str]:
        return sorted(name for name, _ in self.node.get_node_names_and_namespaces())


if __name__ == "__main__":
    program = FarProgram(sys.argv[1])
    serve(
        {
            "hear": program.hear,
            "heard": lambda topic: program.heard[topic],
            "offer": program.offer,
            "say": program.say,
            "said": lambda topic: program.said[topic],
            "listeners": lambda topic: program.publishers[topic].get_subscription_count(),
            "nodes": program.nodes,
        }
    )
    program.executor.shutdown()
    program.graph.close_threadsafe()
