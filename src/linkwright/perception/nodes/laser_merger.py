"""laserscan_multi_merger of ira_laser_tools: it merges the scans of several lasers into one cloud and one scan.

When each laser has measured, its latest points are published in the destination frame.

Source: ira_laser_tools (topics, parameters, defaults; rays without a point have the range ``range_max`` + 1). A scan
whose transform is unknown is dropped without waiting.
"""

from __future__ import annotations

from functools import partial
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import rotation_matrix
from linkwright.graph import SENSOR_DATA_QOS, Graph
from linkwright.messages import get_message
from linkwright.nodes.frame_poses import FramePoses
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import check_positive, log_unknown_parameters
from linkwright.perception.nodes.laser_filters import to_scan
from linkwright.perception.nodes.pointcloud_to_laserscan import make_cloud
from linkwright.perception.scans.projection import Rays, points_from_scan, scan_from_points


class LaserScanMultiMerger(SingleNode):
    """The running node.

    Raises:
        LinkwrightError: a parameter has an invalid value or type (NODE433, GRAPH201).
    """

    DEFAULT_NAME = "laserscan_multi_merger"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        with handle_start_errors(node):
            self._frame: str = node.declare_parameter("destination_frame", "cart_frame").value
            cloud_topic: str = node.declare_parameter("cloud_destination_topic", "/merged_cloud").value
            scan_topic: str = node.declare_parameter("scan_destination_topic", "/scan_multi").value
            topics: str = node.declare_parameter("laserscan_topics", "").value
            self._scan_time: float = node.declare_parameter("scan_time", 0.0333333).value
            self._time_increment: float = node.declare_parameter("time_increment", 0.0).value
            self._rays = Rays(
                node.declare_parameter("angle_min", -2.36).value,
                node.declare_parameter("angle_max", 2.36).value,
                check_positive(node, "angle_increment", node.declare_parameter("angle_increment", 0.0058).value),
                node.declare_parameter("range_min", 0.45).value,
                node.declare_parameter("range_max", 25.0).value,
            )
            log_unknown_parameters(node)
        self._poses = FramePoses(node, "The scan is dropped:")
        self._clouds: dict[str, NDArray[np.float64] | None] = dict.fromkeys(topics.split())
        if not self._clouds:
            node.get_logger().info("Not subscribed to any topic.")
        self._cloud_publisher = node.create_publisher(get_message("sensor_msgs/msg/PointCloud2"), cloud_topic, 1)
        scan_class = get_message("sensor_msgs/msg/LaserScan")
        self._scan_publisher = node.create_publisher(scan_class, scan_topic, 1)
        for topic in self._clouds:
            node.create_subscription(scan_class, topic, partial(self._receive, topic), SENSOR_DATA_QOS)

    def _receive(self, topic: str, message: Any) -> None:
        pose = self._poses.pose(self._frame, message.header.frame_id, message.header.stamp.nanoseconds)
        if pose is None:
            return
        points, _ = points_from_scan(to_scan(message))
        self._clouds[topic] = points @ rotation_matrix(pose[3:]).T + np.array(pose[:3])
        clouds = [cloud for cloud in self._clouds.values() if cloud is not None]
        if len(clouds) == len(self._clouds):
            self._clouds = dict.fromkeys(self._clouds)
            self._publish(np.concatenate(clouds), message.header.stamp)

    def _publish(self, points: NDArray[np.float64], stamp: Any) -> None:
        columns: list[tuple[str, NDArray[Any]]] = [(name, points[:, axis]) for axis, name in enumerate("xyz")]
        indices = np.arange(len(points), dtype=np.int32)
        self._cloud_publisher.publish(make_cloud(columns, indices, self._frame, stamp))
        rays, scan = self._rays, get_message("sensor_msgs/msg/LaserScan")()
        scan.header.stamp, scan.header.frame_id = stamp, self._frame
        scan.angle_min, scan.angle_max, scan.angle_increment = rays.angle_min, rays.angle_max, rays.angle_increment
        scan.range_min, scan.range_max = rays.range_min, rays.range_max
        scan.scan_time, scan.time_increment = self._scan_time, self._time_increment
        scan.ranges = scan_from_points(points, rays, -inf, inf, rays.range_max + 1.0)
        self._scan_publisher.publish(scan)
