"""A process with a real rclpy: ``$LINKWRIGHT_ROS_PYTHON -m tests.dds.real_peer NODE_NAME``.

It has a publisher on ``/from_ros``, a lasting one on ``/lasting_from_ros``, a subscription to ``/to_ros`` and a lasting
one to ``/lasting_to_ros``.
"""

from __future__ import annotations

import sys
import threading
from typing import Any

import rclpy
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from tests.dds.programs import serve

LASTING = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class RealPeer:
    def __init__(self, name: str) -> None:
        rclpy.init()
        self.node = Node(name)
        self.heard: dict[str, list[str]] = {"to_ros": [], "lasting_to_ros": []}
        self.publisher = self.node.create_publisher(String, "from_ros", 10)
        self.lasting = self.node.create_publisher(String, "lasting_from_ros", LASTING)
        self.node.create_subscription(String, "to_ros", lambda m: self.heard["to_ros"].append(m.data), 10)
        self.node.create_subscription(
            String, "lasting_to_ros", lambda m: self.heard["lasting_to_ros"].append(m.data), LASTING
        )
        self.lasting.publish(String(data="said before"))
        threading.Thread(target=rclpy.spin, args=(self.node,), daemon=True).start()

    def nodes(self) -> list[list[str]]:
        return sorted([namespace, name] for name, namespace in self.node.get_node_names_and_namespaces())

    def published_by(self, node: str) -> dict[str, list[str]]:
        known = node in self.node.get_node_names()
        return dict(self.node.get_publisher_names_and_types_by_node(node, "/")) if known else {}

    def hashes(self, topic: str) -> list[str]:
        """Of the types of its publishers."""
        return [str(each.topic_type_hash) for each in self.node.get_publishers_info_by_topic(topic)]

    def publish(self, text: str) -> None:
        self.publisher.publish(String(data=text))

    def received(self, topic: str) -> list[str]:
        return self.heard[topic]


def main() -> None:
    peer = RealPeer(sys.argv[1])
    answers: dict[str, Any] = {
        "nodes": peer.nodes,
        "published_by": peer.published_by,
        "hashes": peer.hashes,
        "publish": peer.publish,
        "received": peer.received,
    }
    serve(answers)
    rclpy.shutdown()


if __name__ == "__main__":
    main()
