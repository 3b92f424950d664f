"""pointcloud_to_laserscan_node and laserscan_to_pointcloud_node.

Source: pointcloud_to_laserscan 2.0 (ROS 2 Humble). A message whose transform to the target frame is unknown is dropped
without waiting.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from math import inf, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import rotation_matrix
from linkwright.graph import SENSOR_DATA_QOS, Graph, QoSProfile, ReliabilityPolicy
from linkwright.messages import get_message
from linkwright.nodes.frame_poses import FramePoses
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, starting
from linkwright.nodes.settings import log_unknown, positive
from linkwright.perception.nodes.laser_filters import scan_of
from linkwright.perception.nodes.lazy import LazySubscriptions
from linkwright.perception.scans.projection import Rays, points_of_scan, scan_of_points

_QUEUE = 10
_FORMATS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
"""The formats of the types of sensor_msgs/msg/PointField."""
_FLOAT32, _INT32 = 7, 5
_TINY = float(np.finfo(np.float64).tiny)


class _Converter(SingleNode, ABC):
    """The base of both nodes: a target frame, two topics, and work only while the output has a subscriber."""

    INPUT_TYPE: str
    OUTPUT_TYPE: str

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        with starting(node):
            self._target: str = node.declare_parameter("target_frame", "").value
            node.declare_parameter("transform_tolerance", 0.01)  # Lookups never wait.
            depth = int(positive(node, "queue_size", node.declare_parameter("queue_size", _QUEUE).value))
            source, result = self._declare()
            log_unknown(node)
        self._poses = FramePoses(node, "Transform failure:")
        self._publisher = node.create_publisher(get_message(self.OUTPUT_TYPE), result, SENSOR_DATA_QOS)
        qos = QoSProfile(depth, ReliabilityPolicy.BEST_EFFORT)
        self._lazy = LazySubscriptions(
            graph,
            node,
            [self._publisher],
            lambda: [node.create_subscription(get_message(self.INPUT_TYPE), source, self._receive, qos)],
        )

    def close(self) -> None:
        """Close the node."""
        self._lazy.close()
        super().close()

    @abstractmethod
    def _declare(self) -> tuple[str, str]:
        """Declare the remaining parameters, and return the topics of input and output."""

    @abstractmethod
    def _receive(self, message: Any) -> None:
        """Convert an input message to an output message."""

    def _placed(self, points: NDArray[np.float64], header: Any) -> NDArray[np.float64] | None:
        """Transform points to the target frame; None if there is no transform."""
        if not self._target:
            return points
        pose = self._poses.pose(self._target, header.frame_id, header.stamp.nanoseconds)
        if pose is None:
            return None
        placed: NDArray[np.float64] = points @ rotation_matrix(pose[3:]).T + np.array(pose[:3])
        return placed


class PointCloudToLaserScan(_Converter):
    """The running pointcloud_to_laserscan_node.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201).
    """

    DEFAULT_NAME = "pointcloud_to_laserscan"
    INPUT_TYPE, OUTPUT_TYPE = "sensor_msgs/msg/PointCloud2", "sensor_msgs/msg/LaserScan"

    def _declare(self) -> tuple[str, str]:
        node = self._node

        def number(name: str, default: float) -> float:
            value: float = node.declare_parameter(name, default).value
            return value

        self._least, self._most = number("min_height", _TINY), number("max_height", float(np.finfo(np.float64).max))
        angle_min, angle_max = number("angle_min", -pi), number("angle_max", pi)
        increment = positive(node, "angle_increment", number("angle_increment", pi / 180.0))
        self._scan_time = number("scan_time", 1.0 / 30.0)
        range_min, range_max = number("range_min", 0.0), number("range_max", float(np.finfo(np.float64).max))
        self._rays = Rays(angle_min, angle_max, increment, range_min, range_max)
        beyond = number("inf_epsilon", 1.0)
        use_inf: bool = node.declare_parameter("use_inf", True).value
        self._nothing = inf if use_inf else range_max + beyond
        source: str = node.declare_parameter("point_cloud_topic", "cloud_in").value
        result: str = node.declare_parameter("scan_topic", "scan").value
        return source, result

    def _receive(self, message: Any) -> None:
        points = points_of(message)
        if points is None:
            self._node.get_logger().error("a cloud has no fields x, y and z, or too little data", once=True)
            return
        placed = self._placed(points, message.header)
        if placed is None:
            return
        scan, rays = get_message("sensor_msgs/msg/LaserScan")(), self._rays
        scan.header.stamp = message.header.stamp
        scan.header.frame_id = self._target or message.header.frame_id
        scan.angle_min, scan.angle_max, scan.angle_increment = rays.angle_min, rays.angle_max, rays.angle_increment
        most = float(np.finfo(np.float32).max)
        scan.range_min, scan.range_max, scan.scan_time = rays.range_min, min(rays.range_max, most), self._scan_time
        scan.ranges = scan_of_points(placed, rays, self._least, self._most, self._nothing)
        self._publisher.publish(scan)


class LaserScanToPointCloud(_Converter):
    """The running laserscan_to_pointcloud_node.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201).
    """

    DEFAULT_NAME = "laserscan_to_pointcloud"
    INPUT_TYPE, OUTPUT_TYPE = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"

    def _declare(self) -> tuple[str, str]:
        result: str = self._node.declare_parameter("point_cloud_topic", "cloud").value
        source: str = self._node.declare_parameter("scan_topic", "scan_in").value
        return source, result

    def _receive(self, message: Any) -> None:
        scan = scan_of(message)
        points, places = points_of_scan(scan)
        placed = self._placed(points.astype(np.float64), message.header)
        if placed is None:
            return
        columns: list[tuple[str, NDArray[Any]]] = [(name, placed[:, axis]) for axis, name in enumerate("xyz")]
        if len(scan.intensities) == len(scan.ranges):
            columns.append(("intensity", scan.intensities[places]))
        self._publisher.publish(_cloud(columns, places, self._target or scan.frame, message.header.stamp))


def points_of(cloud: Any) -> NDArray[np.float64] | None:
    """Return the points of a sensor_msgs/msg/PointCloud2, of shape (n, 3).

    Returns None if it has no coordinates.
    """
    fields = {field.name: field for field in cloud.fields}
    count = cloud.width * cloud.height
    data = np.frombuffer(bytes(cloud.data), np.uint8)
    if any(name not in fields or fields[name].datatype not in _FORMATS for name in "xyz"):
        return None
    if len(data) < cloud.row_step * cloud.height or cloud.row_step < cloud.point_step * cloud.width:
        return None
    order = ">" if cloud.is_bigendian else "<"
    kind = np.dtype(
        {
            "names": list("xyz"),
            "formats": [order + _FORMATS[fields[name].datatype] for name in "xyz"],
            "offsets": [fields[name].offset for name in "xyz"],
            "itemsize": cloud.point_step,
        }
    )
    rows = data[: cloud.row_step * cloud.height].reshape(cloud.height, cloud.row_step)[
        :, : cloud.point_step * cloud.width
    ]
    values = np.ascontiguousarray(rows).reshape(-1).view(kind)
    points = np.empty((count, 3))
    for axis, name in enumerate("xyz"):
        points[:, axis] = values[name]
    return points


def _cloud(columns: list[tuple[str, NDArray[Any]]], places: NDArray[np.int32], frame: str, stamp: Any) -> Any:
    """Return a point cloud of float32 fields and the ray's ``index``, as laser_geometry creates it."""
    field = get_message("sensor_msgs/msg/PointField")
    message = get_message("sensor_msgs/msg/PointCloud2")()
    message.header.stamp, message.header.frame_id = stamp, frame
    kind = np.dtype([(name, "<f4") for name, _ in columns] + [("index", "<i4")])
    values = np.zeros(len(places), kind)
    for name, column in columns:
        values[name] = column
    values["index"] = places
    message.fields = [
        field(name=name, offset=4 * place, datatype=_INT32 if name == "index" else _FLOAT32, count=1)
        for place, name in enumerate(kind.names or ())
    ]
    message.height, message.width = 1, len(places)
    message.point_step, message.row_step = kind.itemsize, kind.itemsize * len(places)
    message.is_dense = True
    message.data = np.frombuffer(values.tobytes(), np.uint8)
    return message
