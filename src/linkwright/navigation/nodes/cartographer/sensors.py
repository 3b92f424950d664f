"""The subscriptions of a trajectory: scans, clouds, odometry and IMU, converted to the tracking frame."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from linkwright.geometry.single import (
    Transform,
    compose,
    invert,
    normalized,
    rotate,
    rotation_matrix,
    rpy_from_quaternion,
)
from linkwright.graph import SENSOR_DATA_QOS, Duration, Node, TransformException
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.listener import TransformListener
from linkwright.messages import get_message
from linkwright.navigation.nodes.cartographer.configuration import CartographerOptions
from linkwright.navigation.nodes.cartographer.mapping import Mapping
from linkwright.navigation.slam.poses import FloatArray
from linkwright.navigation.slam.scan import PlanarScan, planar_scan, planar_scan_from_points
from linkwright.perception.nodes.pointcloud_to_laserscan import read_points

BUFFER_DURATION = Duration(seconds=10)
_WARNING_PERIOD_S = 5.0


def list_topics(name: str, count: int) -> list[str]:
    """Return the names of a number of topics: ``scan`` alone, or ``scan_1``, ``scan_2``, ...."""
    return [name] if count == 1 else [f"{name}_{number}" for number in range(1, count + 1)]


class Sensors:
    """The subscriptions of a trajectory.

    Args:
        node: the node that subscribes.
        options: the options of the trajectory.
        mapping: receives scans, odometry and rates of rotation.

    Attributes:
        buffer: the transforms that the node receives.
        topics: the topics of the subscriptions, as in the configuration.
    """

    def __init__(self, node: Node, options: CartographerOptions, mapping: Mapping) -> None:
        self._node, self._options, self._mapping = node, options, mapping
        self.buffer = BufferCore(BUFFER_DURATION, logger=node.get_logger().get_child("tf2"))
        self._listener = TransformListener(self.buffer, node)
        self.topics: list[str] = []
        self._subscriptions: list[Any] = []
        self._pulses: dict[str, float] = {}

    def start(self) -> None:
        """Subscribe to the topics of the options."""
        options = self._options
        for name, count, message, convert in (
            ("scan", options.num_laser_scans, "LaserScan", self._convert_scan),
            ("echoes", options.num_multi_echo_laser_scans, "MultiEchoLaserScan", self._convert_echoes),
            ("points2", options.num_point_clouds, "PointCloud2", self._convert_cloud),
        ):
            for topic in list_topics(name, count) if count else ():
                self._subscribe(topic, f"sensor_msgs/msg/{message}", self._make_receiver(topic, convert))
        if options.use_imu_data:
            self._subscribe("imu", "sensor_msgs/msg/Imu", self._on_imu)
        if options.use_odometry:
            self._subscribe("odom", "nav_msgs/msg/Odometry", self._on_odometry)

    def stop(self) -> None:
        """End the subscriptions."""
        for subscription in self._subscriptions:
            subscription.destroy()
        self._subscriptions, self.topics = [], []

    def close(self) -> None:
        """End the subscriptions, and stop receiving transforms."""
        self.stop()
        self._listener.unregister()

    def _subscribe(self, topic: str, message: str, callback: Callable[[Any], None]) -> None:
        self.topics.append(topic)
        self._subscriptions.append(
            self._node.create_subscription(get_message(message), topic, callback, SENSOR_DATA_QOS)
        )

    def _make_receiver(self, topic: str, convert: Callable[[Any, Transform], PlanarScan | None]) -> Any:
        def receive(message: Any) -> None:
            if not self._is_sampled(topic):
                return
            stamp_ns = message.header.stamp.nanoseconds
            mounting = self._find_mounting(message.header.frame_id, stamp_ns)
            scan = None if mounting is None else convert(message, mounting)
            if scan is not None:
                self._mapping.add_scan(topic, scan)

        return receive

    def _is_sampled(self, topic: str) -> bool:
        """Return whether to use a scan, by ``rangefinder_sampling_ratio``."""
        pulse = self._pulses.get(topic, 0.0) + self._options.rangefinder_sampling_ratio
        is_sampled = pulse >= 1.0
        self._pulses[topic] = pulse - 1.0 if is_sampled else pulse
        return is_sampled

    def _find_mounting(self, frame: str, stamp_ns: int) -> Transform | None:
        """Return the pose of a sensor in the tracking frame, or None."""
        tracking = self._options.tracking_frame
        frame = frame.removeprefix("/")
        try:
            return self.buffer.lookup(tracking, frame, stamp_ns)[0]
        except TransformException:
            pass
        try:
            return self.buffer.lookup(tracking, frame, 0)[0]
        except TransformException as error:
            self._node.get_logger().warning(str(error), throttle_duration_sec=_WARNING_PERIOD_S)
            return None

    # --- conversion of messages ---------------------------------------------------------------------------------------

    def _convert_scan(self, message: Any, mounting: Transform) -> PlanarScan:
        return self._convert_ranges(message, np.array(message.ranges, dtype=np.float64), mounting)

    def _convert_echoes(self, message: Any, mounting: Transform) -> PlanarScan:
        """Convert the first echo of each ray."""
        first = [ray.echoes[0] if len(ray.echoes) else np.inf for ray in message.ranges]
        return self._convert_ranges(message, np.array(first, dtype=np.float64), mounting)

    def _convert_ranges(self, message: Any, ranges: FloatArray, mounting: Transform) -> PlanarScan:
        options = self._options
        angles = message.angle_min + np.arange(len(ranges)) * message.angle_increment
        return planar_scan(
            ranges,
            angles,
            (message.range_min, message.range_max),
            (options.min_range, options.max_range),
            (np.array(rotation_matrix(mounting[3:])), np.array(mounting[:3])),
            message.header.stamp.nanoseconds,
            options.missing_data_ray_length,
        )

    def _convert_cloud(self, message: Any, mounting: Transform) -> PlanarScan | None:
        options = self._options
        points = read_points(message)
        if points is None:
            self._node.get_logger().error("a point cloud lacks fields x, y and z, or has too little data", once=True)
            return None
        position = np.array(mounting[:3])
        return planar_scan_from_points(
            points @ np.array(rotation_matrix(mounting[3:])).T + position,
            position,
            (options.min_z, options.max_z),
            (options.min_range, options.max_range),
            options.missing_data_ray_length,
            message.header.stamp.nanoseconds,
        )

    def _on_imu(self, message: Any) -> None:
        stamp_ns = message.header.stamp.nanoseconds
        mounting = self._find_mounting(message.header.frame_id, stamp_ns)
        if mounting is not None:
            velocity = message.angular_velocity
            self._mapping.add_rotation(stamp_ns, rotate(mounting[3:], (velocity.x, velocity.y, velocity.z))[2])

    def _on_odometry(self, message: Any) -> None:
        stamp_ns = message.header.stamp.nanoseconds
        mounting = self._find_mounting(message.child_frame_id, stamp_ns)
        if mounting is None:
            return
        position, orientation = message.pose.pose.position, message.pose.pose.orientation
        quaternion = normalized(orientation.x, orientation.y, orientation.z, orientation.w)
        pose = compose((position.x, position.y, position.z, *quaternion), invert(mounting))
        self._mapping.add_odometry(stamp_ns, np.array((pose[0], pose[1], rpy_from_quaternion(pose[3:])[2])))
