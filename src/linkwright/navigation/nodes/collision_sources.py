"""Sensors of collision_monitor, whose latest points are given in the robot's current frame."""

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
from linkwright.navigation.nodes.plugins import value_of
from linkwright.nodes.settings import bad_value
from linkwright.perception.nodes.laser_filters import scan_of
from linkwright.perception.nodes.pointcloud_to_laserscan import points_of
from linkwright.perception.scans.projection import points_of_scan

_WAITING = 20


class Source:
    """A sensor and its recent messages.

    Args:
        node: the node that subscribes.
        name: the name of the sensor, the prefix of its parameters.
        transforms: the transforms between frames.
        base: the frame of the robot.
        fixed: the frame in which obstacles are static while the robot moves; None to ignore the robot's motion.

    Raises:
        LinkwrightError: NODE433, the type of the sensor is not supported.
    """

    def __init__(self, node: Node, name: str, transforms: BufferCore, base: str, fixed: str | None) -> None:
        self.name = name
        self._node, self._transforms, self._base, self._fixed = node, transforms, base, fixed
        self._waiting: deque[Any] = deque(maxlen=_WAITING)
        kinds: dict[str, tuple[str, Callable[[Any], NDArray[np.float64] | None]]] = {
            "scan": ("LaserScan", _of_scan),
            "pointcloud": ("PointCloud2", self._of_cloud),
            "range": ("Range", self._of_range),
        }
        kind = str(self._value("type", "scan"))
        if kind not in kinds:
            raise bad_value(f"{name}.type", kind, node.get_name(), list(kinds))
        message, self._read = kinds[kind]
        if kind == "pointcloud":
            self._height = float(self._value("min_height", 0.05)), float(self._value("max_height", 0.5))
        if kind == "range":
            self._spacing = float(self._value("obstacles_angle", pi / 180.0))
        self._value("enabled", True)
        topic = str(self._value("topic", "scan"))
        type_ = get_message(f"sensor_msgs/msg/{message}")
        self._subscription = node.create_subscription(type_, topic, self._receive, SENSOR_DATA_QOS)

    def destroy(self) -> None:
        """Remove the subscription."""
        self._subscription.destroy()

    def points(self, now_ns: int, timeout: float) -> Points | None:
        """Return the latest points, of shape (points, 2), or None if they are missing or too old.

        A disabled sensor has no points. With a timeout of 0, missing points count as no points.

        Args:
            now_ns: the current time.
            timeout: the maximum age of the points in seconds, unless the sensor has its own ``source_timeout``; 0 for
                no limit.
        """
        if not self._value("enabled", True):
            return np.zeros((0, 2))
        own = float(self._value("source_timeout", timeout))
        found = self._placed(now_ns, own)
        return np.zeros((0, 2)) if found is None and own == 0.0 else found

    def _placed(self, now_ns: int, timeout: float) -> Points | None:
        found = self._newest()
        if found is None or (timeout and now_ns - found[0].header.stamp.nanoseconds > timeout * 1e9):
            return None
        message, pose = found
        points = self._read(message)
        if points is None:
            return None
        placed: NDArray[np.float64] = points @ rotation_matrix(pose[3:]).T + np.array(pose[:3])
        if self._read == self._of_cloud:
            placed = placed[(placed[:, 2] >= self._height[0]) & (placed[:, 2] <= self._height[1])]
        return placed[:, :2]

    def _newest(self) -> tuple[Any, Transform] | None:
        """Return the latest message whose transform is available, and the sensor's pose.

        Returns None if there is no such message. Transforms often arrive later than the messages.
        """
        for message in reversed(self._waiting):
            pose = self._pose(message.header.frame_id, message.header.stamp.nanoseconds)
            if pose is not None:
                while self._waiting[0] is not message:
                    self._waiting.popleft()
                return message, pose
        return None

    def _pose(self, frame: str, stamp_ns: int) -> Transform | None:
        """Return the sensor's pose at the time of a message, in the robot's current frame.

        Returns None if a transform is not available.
        """
        try:
            if self._fixed is None:
                return self._transforms.lookup(self._base, frame, 0)[0]
            then = self._transforms.lookup(self._fixed, frame, stamp_ns)[0]
            return compose(self._transforms.lookup(self._base, self._fixed, 0)[0], then)
        except TransformException:
            return None

    def _value(self, name: str, default: Any) -> Any:
        return value_of(self._node, f"{self.name}.{name}", default)

    def _receive(self, message: Any) -> None:
        self._waiting.append(message)

    def _of_cloud(self, message: Any) -> NDArray[np.float64] | None:
        points = points_of(message)
        return None if points is None else points[np.isfinite(points).all(axis=1)]

    def _of_range(self, message: Any) -> NDArray[np.float64]:
        """Return points on the arc of a range reading, of shape (points, 3).

        If the reading is outside the limits of the sensor, no points are returned.
        """
        if not message.min_range <= message.range <= message.max_range:
            return np.zeros((0, 3))
        half = message.field_of_view / 2.0
        angles = np.append(np.arange(-half, half, self._spacing), half)
        rays: NDArray[np.float64] = np.stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))], axis=-1)
        return rays * float(message.range)


def _of_scan(message: Any) -> NDArray[np.float64]:
    return points_of_scan(scan_of(message))[0].astype(np.float64)
