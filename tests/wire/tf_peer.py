"""A node that tells and hears transforms without tf2, with the real rclpy and tf2's messages; see `tools/ros_types.py`.

``$LINKWRIGHT_ROS_PYTHON -m tests.wire.tf_peer NODE_NAME``. The profiles are those of tf2_ros.
"""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

from tests.wire.node_program import serve_node

TELLS, TELLS_LASTING = QoSProfile(depth=100), QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
HEARS, HEARS_LASTING = QoSProfile(depth=100), QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class TfPeer(Node):
    def __init__(self, name: str) -> None:
        super().__init__(name)
        self._tells = {
            "/tf": self.create_publisher(TFMessage, "/tf", TELLS),
            "/tf_static": self.create_publisher(TFMessage, "/tf_static", TELLS_LASTING),
        }
        self._heard: dict[str, dict[str, list[Any]]] = {"/tf": {}, "/tf_static": {}}
        for topic, qos in (("/tf", HEARS), ("/tf_static", HEARS_LASTING)):
            self.create_subscription(TFMessage, topic, lambda text, topic=topic: self._hear(topic, text), qos)

    def tell(self, topic: str, parent: str, child: str, x: float) -> None:
        self._tells[topic].publish(TFMessage(transforms=[self._transform(parent, child, x)]))

    def keep_telling(self, parent: str, child: str, x: float) -> None:
        self.create_timer(0.02, lambda: self.tell("/tf", parent, child, x))

    def heard(self, topic: str) -> dict[str, list[Any]]:
        """Child frame -> parent frame, x, and the name of the node that tells it where one does."""
        return self._heard[topic]

    def hashes(self, topic: str) -> list[str]:
        return [str(endpoint.topic_type_hash) for endpoint in self.get_publishers_info_by_topic(topic)]

    def _transform(self, parent: str, child: str, x: float) -> TransformStamped:
        transform = TransformStamped(child_frame_id=child)
        transform.header.frame_id, transform.header.stamp = parent, self.get_clock().now().to_msg()
        transform.transform.translation.x = x
        return transform

    def _hear(self, topic: str, said: Any) -> None:
        for transform in said.transforms:
            self._heard[topic][transform.child_frame_id] = [
                transform.header.frame_id,
                transform.transform.translation.x,
            ]


if __name__ == "__main__":
    serve_node(TfPeer, "tell keep_telling heard hashes")
