"""A node that publishes and receives transforms with the real rclpy but without tf2_ros.

See `tools/ros_types.py`.

``$LINKWRIGHT_ROS_PYTHON -m tests.wire.tf_peer NODE_NAME``. The QoS profiles are those of tf2_ros.
"""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

from tests.wire.node_program import serve_node

PUBLISHER_QOS, STATIC_PUBLISHER_QOS = (
    QoSProfile(depth=100),
    QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL),
)
SUBSCRIPTION_QOS, STATIC_SUBSCRIPTION_QOS = (
    QoSProfile(depth=100),
    QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL),
)


class TfPeer(Node):
    def __init__(self, name: str) -> None:
        super().__init__(name)
        self._publishers_by_topic = {
            "/tf": self.create_publisher(TFMessage, "/tf", PUBLISHER_QOS),
            "/tf_static": self.create_publisher(TFMessage, "/tf_static", STATIC_PUBLISHER_QOS),
        }
        self._received: dict[str, dict[str, list[Any]]] = {"/tf": {}, "/tf_static": {}}
        for topic, qos in (("/tf", SUBSCRIPTION_QOS), ("/tf_static", STATIC_SUBSCRIPTION_QOS)):
            self.create_subscription(
                TFMessage, topic, lambda message, topic=topic: self._on_message(topic, message), qos
            )

    def publish_transform(self, topic: str, parent: str, child: str, x: float) -> None:
        self._publishers_by_topic[topic].publish(TFMessage(transforms=[self._transform(parent, child, x)]))

    def keep_publishing(self, parent: str, child: str, x: float) -> None:
        self.create_timer(0.02, lambda: self.publish_transform("/tf", parent, child, x))

    def received(self, topic: str) -> dict[str, list[Any]]:
        """Return parent frame and x by child frame."""
        return self._received[topic]

    def hashes(self, topic: str) -> list[str]:
        return [str(endpoint.topic_type_hash) for endpoint in self.get_publishers_info_by_topic(topic)]

    def _transform(self, parent: str, child: str, x: float) -> TransformStamped:
        transform = TransformStamped(child_frame_id=child)
        transform.header.frame_id, transform.header.stamp = parent, self.get_clock().now().to_msg()
        transform.transform.translation.x = x
        return transform

    def _on_message(self, topic: str, message: Any) -> None:
        for transform in message.transforms:
            self._received[topic][transform.child_frame_id] = [
                transform.header.frame_id,
                transform.transform.translation.x,
            ]


if __name__ == "__main__":
    serve_node(TfPeer, "publish_transform keep_publishing received hashes")
