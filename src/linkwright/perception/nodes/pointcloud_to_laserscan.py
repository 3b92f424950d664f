"""The nodes of pointcloud_to_laserscan: convert point clouds to laser scans and back.

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
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import check_positive, log_unknown_parameters
from linkwright.perception.nodes.laser_filters import to_scan
from linkwright.perception.nodes.lazy_subscriptions import LazySubscriptions
from linkwright.perception.scans.projection import Rays, points_from_scan, scan_from_points

_QUEUE_SIZE = 10
_FORMATS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
"""NumPy's formats for the types of sensor_msgs/msg/PointField."""
_FLOAT32, _INT32 = 7, 5
_MIN_POSITIVE_FLOAT = float(np.finfo(np.float64).tiny)
"""The default of ``min_height``, which is positive: the ROS package uses C++'s ``numeric_limits<double>::min()``."""


class _Converter(SingleNode, ABC):
    """The base of both nodes: it converts messages only while the output topic has a subscriber."""

    INPUT_TYPE: str
    OUTPUT_TYPE: str

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        with handle_start_errors(node):
            self._target_frame: str = node.declare_parameter("target_frame", "").value
            node.declare_parameter("transform_tolerance", 0.01)  # lookups never wait
            depth = int(check_positive(node, "queue_size", node.declare_parameter("queue_size", _QUEUE_SIZE).value))
            input_topic, output_topic = self._declare()
            log_unknown_parameters(node)
        self._poses = FramePoses(node, "Transform failure:")
        self._publisher = node.create_publisher(get_message(self.OUTPUT_TYPE), output_topic, SENSOR_DATA_QOS)
        qos = QoSProfile(depth, ReliabilityPolicy.BEST_EFFORT)
        self._subscriptions = LazySubscriptions(
            graph,
            node,
            [self._publisher],
            lambda: [node.create_subscription(get_message(self.INPUT_TYPE), input_topic, self._receive, qos)],
        )

    def close(self) -> None:
        """Close the node."""
        self._subscriptions.close()
        super().close()

    @abstractmethod
    def _declare(self) -> tuple[str, str]:
        """Declare the remaining parameters, and return the input topic and the output topic."""

    @abstractmethod
    def _receive(self, message: Any) -> None:
        """Convert an input message to an output message."""

    def _to_target_frame(self, points: NDArray[np.float64], header: Any) -> NDArray[np.float64] | None:
        """Return points in the target frame, or None if there is no transform."""
        if not self._target_frame:
            return points
        pose = self._poses.pose(self._target_frame, header.frame_id, header.stamp.nanoseconds)
        if pose is None:
            return None
        transformed: NDArray[np.float64] = points @ rotation_matrix(pose[3:]).T + np.array(pose[:3])
        return transformed


class PointCloudToLaserScan(_Converter):
    """The node that converts point clouds to laser scans.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201).
    """

    DEFAULT_NAME = "pointcloud_to_laserscan"
    INPUT_TYPE, OUTPUT_TYPE = "sensor_msgs/msg/PointCloud2", "sensor_msgs/msg/LaserScan"

    def _declare(self) -> tuple[str, str]:
        node = self._node

        def declare_number(name: str, default: float) -> float:
            value: float = node.declare_parameter(name, default).value
            return value

        self._min_height, self._max_height = (
            declare_number("min_height", _MIN_POSITIVE_FLOAT),
            declare_number("max_height", float(np.finfo(np.float64).max)),
        )
        angle_min, angle_max = declare_number("angle_min", -pi), declare_number("angle_max", pi)
        increment = check_positive(node, "angle_increment", declare_number("angle_increment", pi / 180.0))
        self._scan_time = declare_number("scan_time", 1.0 / 30.0)
        range_min, range_max = (
            declare_number("range_min", 0.0),
            declare_number("range_max", float(np.finfo(np.float64).max)),
        )
        self._rays = Rays(angle_min, angle_max, increment, range_min, range_max)
        inf_epsilon = declare_number("inf_epsilon", 1.0)
        use_inf: bool = node.declare_parameter("use_inf", True).value
        self._empty_range = inf if use_inf else range_max + inf_epsilon
        input_topic: str = node.declare_parameter("point_cloud_topic", "cloud_in").value
        output_topic: str = node.declare_parameter("scan_topic", "scan").value
        return input_topic, output_topic

    def _receive(self, message: Any) -> None:
        points = read_points(message)
        if points is None:
            self._node.get_logger().error("a point cloud lacks fields x, y and z, or has too little data", once=True)
            return
        transformed = self._to_target_frame(points, message.header)
        if transformed is None:
            return
        scan, rays = get_message("sensor_msgs/msg/LaserScan")(), self._rays
        scan.header.stamp = message.header.stamp
        scan.header.frame_id = self._target_frame or message.header.frame_id
        scan.angle_min, scan.angle_max, scan.angle_increment = rays.angle_min, rays.angle_max, rays.angle_increment
        max_float32 = float(np.finfo(np.float32).max)
        scan.range_min, scan.range_max, scan.scan_time = (
            rays.range_min,
            min(rays.range_max, max_float32),
            self._scan_time,
        )
        scan.ranges = scan_from_points(transformed, rays, self._min_height, self._max_height, self._empty_range)
        self._publisher.publish(scan)


class LaserScanToPointCloud(_Converter):
    """The node that converts laser scans to point clouds.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201).
    """

    DEFAULT_NAME = "laserscan_to_pointcloud"
    INPUT_TYPE, OUTPUT_TYPE = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"

    def _declare(self) -> tuple[str, str]:
        output_topic: str = self._node.declare_parameter("point_cloud_topic", "cloud").value
        input_topic: str = self._node.declare_parameter("scan_topic", "scan_in").value
        return input_topic, output_topic

    def _receive(self, message: Any) -> None:
        scan = to_scan(message)
        points, indices = points_from_scan(scan)
        transformed = self._to_target_frame(points.astype(np.float64), message.header)
        if transformed is None:
            return
        columns: list[tuple[str, NDArray[Any]]] = [(name, transformed[:, axis]) for axis, name in enumerate("xyz")]
        if len(scan.intensities) == len(scan.ranges):
            columns.append(("intensity", scan.intensities[indices]))
        self._publisher.publish(make_cloud(columns, indices, self._target_frame or scan.frame, message.header.stamp))


def read_points(cloud: Any) -> NDArray[np.float64] | None:
    """Return the points of a sensor_msgs/msg/PointCloud2, shape ``(n, 3)``, as float64.

    Return None if it has no usable fields x, y and z, or too little data.
    """
    fields = {field.name: field for field in cloud.fields}
    count = cloud.width * cloud.height
    data = np.frombuffer(bytes(cloud.data), np.uint8)
    if any(name not in fields or fields[name].datatype not in _FORMATS for name in "xyz"):
        return None
    if len(data) < cloud.row_step * cloud.height or cloud.row_step < cloud.point_step * cloud.width:
        return None
    order = ">" if cloud.is_bigendian else "<"
    dtype = np.dtype(
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
    values = np.ascontiguousarray(rows).reshape(-1).view(dtype)
    points = np.empty((count, 3))
    for axis, name in enumerate("xyz"):
        points[:, axis] = values[name]
    return points


def make_cloud(columns: list[tuple[str, NDArray[Any]]], indices: NDArray[np.int32], frame: str, stamp: Any) -> Any:
    """Return a point cloud with float32 fields and each ray's ``index``, as laser_geometry does."""
    field_class = get_message("sensor_msgs/msg/PointField")
    message = get_message("sensor_msgs/msg/PointCloud2")()
    message.header.stamp, message.header.frame_id = stamp, frame
    dtype = np.dtype([(name, "<f4") for name, _ in columns] + [("index", "<i4")])
    values = np.zeros(len(indices), dtype)
    for name, column in columns:
        values[name] = column
    values["index"] = indices
    message.fields = [
        field_class(name=name, offset=4 * index, datatype=_INT32 if name == "index" else _FLOAT32, count=1)
        for index, name in enumerate(dtype.names or ())
    ]
    message.height, message.width = 1, len(indices)
    message.point_step, message.row_step = dtype.itemsize, dtype.itemsize * len(indices)
    message.is_dense = True
    message.data = np.frombuffer(values.tobytes(), np.uint8)
    return message
