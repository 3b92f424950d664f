"""The sensors of collision_monitor, and their points in the robot's current frame."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import rotation_matrix
from linkwright.geometry.single import Transform, compose
from linkwright.graph import SENSOR_DATA_QOS, Node, TransformException
from linkwright.graph.transforms.core import BufferCore
from linkwright.messages import get_message
from linkwright.navigation.behaviors.zones import Points
from linkwright.navigation.nodes.plugins import get_or_declare
from linkwright.nodes.settings import invalid_value_error
from linkwright.perception.nodes.laser_filters import to_scan
from linkwright.perception.nodes.pointcloud_to_laserscan import read_points
from linkwright.perception.scans.projection import points_from_scan

_MAX_QUEUED_MESSAGES = 20


class Source:
    """A sensor and its recent messages.

    Args:
        node: the node that subscribes.
        name: the name of the sensor, which is also the prefix of its parameters.
        transforms: the transforms between frames.
        base_frame: the frame of the robot.
        fixed_frame: the frame in which obstacles are static while the robot moves; None to ignore the robot's motion.

    Raises:
        LinkwrightError: NODE433, the type of the sensor is not supported.
    """

    def __init__(self, node: Node, name: str, transforms: BufferCore, base_frame: str, fixed_frame: str | None) -> None:
        self.name = name
        self._node, self._transforms, self._base_frame, self._fixed_frame = node, transforms, base_frame, fixed_frame
        self._queued_messages: deque[Any] = deque(maxlen=_MAX_QUEUED_MESSAGES)
        readers: dict[str, tuple[str, Callable[[Any], NDArray[np.float64] | None]]] = {
            "scan": ("LaserScan", _points_from_scan),
            "pointcloud": ("PointCloud2", self._points_from_cloud),
            "range": ("Range", self._points_from_range),
        }
        kind = str(self._get_parameter_value("type", "scan"))
        if kind not in readers:
            raise invalid_value_error(f"{name}.type", kind, node.get_name(), list(readers))
        message, self._read = readers[kind]
        if kind == "pointcloud":
            self._height_range = (
                float(self._get_parameter_value("min_height", 0.05)),
                float(self._get_parameter_value("max_height", 0.5)),
            )
        if kind == "range":
            self._spacing = float(self._get_parameter_value("obstacles_angle", pi / 180.0))
        self._get_parameter_value("enabled", True)
        topic = str(self._get_parameter_value("topic", "scan"))
        type_ = get_message(f"sensor_msgs/msg/{message}")
        self._subscription = node.create_subscription(type_, topic, self._receive, SENSOR_DATA_QOS)

    def destroy(self) -> None:
        """Remove the subscription."""
        self._subscription.destroy()

    def points(self, now_ns: int, timeout: float) -> Points | None:
        """Return the latest points, of shape (points, 2), or None if they are missing or too old.

        A disabled sensor returns an empty array. So does a sensor without data if the timeout is 0.

        Args:
            now_ns: the current time.
            timeout: the maximum age of the points in seconds, unless the sensor has its own ``source_timeout``; 0 for
                no limit.
        """
        if not self._get_parameter_value("enabled", True):
            return np.zeros((0, 2))
        sensor_timeout = float(self._get_parameter_value("source_timeout", timeout))
        current_points = self._find_current_points(now_ns, sensor_timeout)
        return np.zeros((0, 2)) if current_points is None and sensor_timeout == 0.0 else current_points

    def _find_current_points(self, now_ns: int, timeout: float) -> Points | None:
        newest = self._find_newest()
        if newest is None or (timeout and now_ns - newest[0].header.stamp.nanoseconds > timeout * 1e9):
            return None
        message, pose = newest
        points = self._read(message)
        if points is None:
            return None
        robot_points: NDArray[np.float64] = points @ rotation_matrix(pose[3:]).T + np.array(pose[:3])
        if self._read == self._points_from_cloud:
            robot_points = robot_points[
                (robot_points[:, 2] >= self._height_range[0]) & (robot_points[:, 2] <= self._height_range[1])
            ]
        return robot_points[:, :2]

    def _find_newest(self) -> tuple[Any, Transform] | None:
        """Return the latest message whose transform is available, and the sensor's pose.

        Returns None if there is no such message. Transforms often arrive later than the messages.
        """
        for message in reversed(self._queued_messages):
            pose = self._find_sensor_pose(message.header.frame_id, message.header.stamp.nanoseconds)
            if pose is not None:
                while self._queued_messages[0] is not message:
                    self._queued_messages.popleft()
                return message, pose
        return None

    def _find_sensor_pose(self, frame: str, stamp_ns: int) -> Transform | None:
        """Return the sensor's pose at the time of a message, in the robot's current frame.

        Returns None if a transform is not available.
        """
        try:
            if self._fixed_frame is None:
                return self._transforms.lookup(self._base_frame, frame, 0)[0]
            fixed_pose = self._transforms.lookup(self._fixed_frame, frame, stamp_ns)[0]
            return compose(self._transforms.lookup(self._base_frame, self._fixed_frame, 0)[0], fixed_pose)
        except TransformException:
            return None

    def _get_parameter_value(self, name: str, default: Any) -> Any:
        return get_or_declare(self._node, f"{self.name}.{name}", default)

    def _receive(self, message: Any) -> None:
        self._queued_messages.append(message)

    def _points_from_cloud(self, message: Any) -> NDArray[np.float64] | None:
        points = read_points(message)
        return None if points is None else points[np.isfinite(points).all(axis=1)]

    def _points_from_range(self, message: Any) -> NDArray[np.float64]:
        """Return points on the arc of a range reading, of shape (points, 3).

        If the reading is outside the limits of the sensor, no points are returned.
        """
        if not message.min_range <= message.range <= message.max_range:
            return np.zeros((0, 3))
        half_angle = message.field_of_view / 2.0
        angles = np.append(np.arange(-half_angle, half_angle, self._spacing), half_angle)
        rays: NDArray[np.float64] = np.stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))], axis=-1)
        return rays * float(message.range)


def _points_from_scan(message: Any) -> NDArray[np.float64]:
    return points_from_scan(to_scan(message))[0].astype(np.float64)
