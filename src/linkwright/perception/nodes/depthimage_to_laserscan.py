"""depthimage_to_laserscan_node: computes a laser scan from the middle rows of a depth image.

Source: depthimage_to_laserscan 2.5 (ROS 2 Humble).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.graph import SENSOR_DATA_QOS, Graph
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import check_positive, log_unknown_parameters
from linkwright.perception.nodes.lazy_subscriptions import LazySubscriptions
from linkwright.perception.scans.projection import Pinhole, scan_from_depths

_METERS_PER_16UC1_UNIT = 0.001
"""The unit of depths in images with the encoding 16UC1, in m."""
_ERROR_PERIOD_S = 5.0


class DepthImageToLaserScan(SingleNode):
    """The node that converts depth images to laser scans.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201).
    """

    DEFAULT_NAME = "depthimage_to_laserscan"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        self._camera: Pinhole | None = None
        with handle_start_errors(node):
            self._scan_time: float = node.declare_parameter("scan_time", 0.033).value
            self._range_min: float = node.declare_parameter("range_min", 0.45).value
            self._range_max: float = node.declare_parameter("range_max", 10.0).value
            self._scan_height = int(check_positive(node, "scan_height", node.declare_parameter("scan_height", 1).value))
            self._frame: str = node.declare_parameter("output_frame", "camera_depth_frame").value
            log_unknown_parameters(node)
        self._publisher = node.create_publisher(get_message("sensor_msgs/msg/LaserScan"), "scan", 10)
        self._subscriptions = LazySubscriptions(
            graph,
            node,
            [self._publisher],
            lambda: [
                node.create_subscription(
                    get_message("sensor_msgs/msg/CameraInfo"),
                    "depth_camera_info",
                    self._receive_camera_info,
                    SENSOR_DATA_QOS,
                ),
                node.create_subscription(get_message("sensor_msgs/msg/Image"), "depth", self._receive, SENSOR_DATA_QOS),
            ],
        )

    def close(self) -> None:
        """Close the node."""
        self._subscriptions.close()
        super().close()

    def _receive_camera_info(self, message: Any) -> None:
        focal_length, center_column, center_row = message.p[0], message.p[2], message.p[6]
        if not focal_length:
            focal_length, center_column, center_row = message.k[0], message.k[2], message.k[5]
        if focal_length:
            self._camera = Pinhole(float(focal_length), float(center_column), float(center_row))

    def _receive(self, image: Any) -> None:
        if self._camera is None:
            self._log_error("no camera_info with a focal length has arrived")
            return
        try:
            depths = read_depths(image)
            ranges, rays = scan_from_depths(depths, self._camera, self._scan_height, self._range_min, self._range_max)
        except ValueError as error:
            self._log_error(str(error))
            return
        scan = get_message("sensor_msgs/msg/LaserScan")()
        scan.header.stamp = image.header.stamp
        scan.header.frame_id = self._frame or image.header.frame_id
        scan.angle_min, scan.angle_max, scan.angle_increment = rays.angle_min, rays.angle_max, rays.angle_increment
        scan.range_min, scan.range_max, scan.scan_time = rays.range_min, rays.range_max, self._scan_time
        scan.ranges = ranges
        self._publisher.publish(scan)

    def _log_error(self, reason: str) -> None:
        self._node.get_logger().error(
            f"Could not convert depth image to laserscan: {reason}", throttle_duration_sec=_ERROR_PERIOD_S
        )


def read_depths(image: Any) -> NDArray[np.float64]:
    """Return the depths of a sensor_msgs/msg/Image in meters, shape ``(rows, columns)``.

    Pixels without a depth are NaN in integer images, and unchanged in 32FC1 images.

    Raises:
        ValueError: the message is not a depth image, or has too little data.
    """
    dtypes = {"16UC1": "u2", "mono16": "u2", "32FC1": "f4"}
    dtype = dtypes.get(image.encoding)
    if dtype is None:
        raise ValueError(f"Depth image has unsupported encoding: {image.encoding}")
    order = ">" if image.is_bigendian else "<"
    data = np.frombuffer(bytes(image.data), np.uint8)
    row_bytes = np.dtype(dtype).itemsize * image.width
    if image.step < row_bytes or len(data) < image.step * image.height:
        raise ValueError(f"the image has {len(data)} bytes, not {image.height} rows of {row_bytes}")
    rows = data[: image.step * image.height].reshape(image.height, image.step)[:, :row_bytes]
    values = np.ascontiguousarray(rows).view(order + dtype).reshape(image.height, image.width)
    if dtype == "u2":
        return np.where(values > 0, values * _METERS_PER_16UC1_UNIT, np.nan)
    return values.astype(np.float64)
