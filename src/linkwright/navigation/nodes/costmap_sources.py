"""Subscriptions of a costmap's layers to laser scans, point clouds, ranges and maps.

Source: nav2_costmap_2d ``ObservationBuffer``, ``StaticLayer``. Messages are queued until their transform is available,
and are processed when the costmap is updated. If a sensor's points do not persist, only its last message with an
available transform is used.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import rotation_matrix
from linkwright.geometry.single import Transform
from linkwright.graph import (
    LATCHED_QOS,
    SENSOR_DATA_QOS,
    DurabilityPolicy,
    Node,
    QoSProfile,
    TransformException,
)
from linkwright.graph.transforms.core import BufferCore
from linkwright.messages import get_message
from linkwright.navigation.costmaps.observations import ObservationBuffer
from linkwright.navigation.costmaps.range_layer import RangeLayer, RangeReading
from linkwright.navigation.costmaps.static_layer import StaticLayer
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.occupancy import BadGridError, grid_from_message
from linkwright.perception.nodes.laser_filters import to_scan
from linkwright.perception.nodes.pointcloud_to_laserscan import read_points
from linkwright.perception.scans.projection import points_from_scan

_MAX_QUEUED_MESSAGES = 50
_MAX_POINTS = 40_000
"""The maximum number of points of a cloud. Every n-th point of a larger cloud is used."""
_RANGE_MARGIN = 1e-4
"""The distance by which a ray without a hit is shorter than the maximum range, in meters."""


class SensorTopic(ABC):
    """The subscription to a sensor's topic, with a queue of messages.

    Args:
        node: the node that subscribes.
        topic: the name of the topic.
        message_name: the message type, without the package sensor_msgs.
        transforms: the transforms between frames.
        frame: the frame of the costmap.
    """

    def __init__(self, node: Node, topic: str, message_name: str, transforms: BufferCore, frame: str) -> None:
        self._transforms, self._frame = transforms, frame
        self._queued_messages: deque[Any] = deque(maxlen=_MAX_QUEUED_MESSAGES)
        message = get_message(f"sensor_msgs/msg/{message_name}")
        self._subscription = node.create_subscription(message, topic, self._receive, SENSOR_DATA_QOS)

    def destroy(self) -> None:
        """Remove the subscription."""
        self._subscription.destroy()

    def process_queue(self) -> None:
        """Pass the queued messages whose transforms are available to the layer.

        Older messages without a transform are dropped.
        """
        messages = list(self._queued_messages)
        placed_messages = [
            (message, pose) for message in messages if (pose := self._find_sensor_pose(message)) is not None
        ]
        if not placed_messages:
            return
        later_messages = messages[messages.index(placed_messages[-1][0]) + 1 :]
        self._queued_messages.clear()
        self._queued_messages.extend(later_messages)
        for message, pose in placed_messages if self.uses_all_messages else placed_messages[-1:]:
            self._observe(message, pose)

    @property
    @abstractmethod
    def uses_all_messages(self) -> bool:
        """Whether all messages are used, instead of only the latest one."""

    @abstractmethod
    def _observe(self, message: Any, pose: Transform) -> None:
        """Pass a message to the layer with the sensor's pose in the frame of the costmap."""

    def _receive(self, message: Any) -> None:
        self._queued_messages.append(message)

    def _find_sensor_pose(self, message: Any) -> Transform | None:
        header = message.header
        try:
            return self._transforms.lookup(self._frame, header.frame_id, header.stamp.nanoseconds)[0]
        except TransformException:
            return None


class PointsTopic(SensorTopic):
    """The subscription to scans or point clouds, for an obstacle layer.

    Args:
        node: the node that subscribes.
        topic: the name of the topic.
        message_name: ``LaserScan`` or ``PointCloud2``.
        buffer: receives the observations.
        transforms: the transforms between frames.
        frame: the frame of the costmap.
        sensor_frame: the frame of the sensor; empty to use the frame of the messages.
        inf_is_valid: whether a ray without a return clears its full length.
    """

    def __init__(
        self,
        node: Node,
        topic: str,
        message_name: str,
        buffer: ObservationBuffer,
        transforms: BufferCore,
        frame: str,
        *,
        sensor_frame: str = "",
        inf_is_valid: bool = False,
    ) -> None:
        super().__init__(node, topic, message_name, transforms, frame)
        self.buffer = buffer
        self._sensor_frame = sensor_frame
        self._inf_is_valid = inf_is_valid
        self._read_points: Callable[[Any], NDArray[np.float64] | None] = (
            self._points_from_scan if message_name == "LaserScan" else read_points
        )

    @property
    def uses_all_messages(self) -> bool:
        """Whether every message is used, because observations persist."""
        return bool(self.buffer.source.observation_persistence)

    def _observe(self, message: Any, pose: Transform) -> None:
        points = self._read_points(message)
        if points is None:
            return
        points = points[:: max(1, ceil(len(points) / _MAX_POINTS))]
        origin = np.array(pose[:3])
        if self._sensor_frame and self._sensor_frame != message.header.frame_id:
            stamp = message.header.stamp.nanoseconds
            try:
                origin = np.array(self._transforms.lookup(self._frame, self._sensor_frame, stamp)[0][:3])
            except TransformException:
                return
        costmap_points = points @ rotation_matrix(pose[3:]).T + np.array(pose[:3])
        self.buffer.add(origin, costmap_points, message.header.stamp.nanoseconds)

    def _points_from_scan(self, message: Any) -> NDArray[np.float64]:
        scan = to_scan(message)
        if self._inf_is_valid:
            scan.ranges[np.isposinf(scan.ranges)] = scan.range_max - _RANGE_MARGIN
        return points_from_scan(scan)[0].astype(np.float64)


class RangeTopic(SensorTopic):
    """The subscription to ranges, for a range layer."""

    def __init__(self, node: Node, topic: str, layer: RangeLayer, transforms: BufferCore, frame: str) -> None:
        super().__init__(node, topic, "Range", transforms, frame)
        self._layer = layer

    @property
    def uses_all_messages(self) -> bool:
        """Always True, because every message updates the probabilities."""
        return True

    def _observe(self, message: Any, pose: Transform) -> None:
        min_range, max_range, distance = message.min_range, message.max_range, message.range
        is_free = self._layer.settings.clear_on_max_reading
        if min_range == max_range:  # A sensor with equal limits only detects presence: -inf is an object, inf is none.
            if not np.isinf(distance) or (distance > 0.0 and not is_free):
                return
            is_free, distance = distance > 0.0, min_range
        elif not min_range <= distance <= max_range:
            return
        else:
            is_free = is_free and distance >= max_range
        direction = rotation_matrix(pose[3:])[:, 0]
        yaw = float(np.arctan2(direction[1], direction[0]))
        horizontal_share = float(np.hypot(direction[0], direction[1]))
        stamp_ns = message.header.stamp.nanoseconds
        self._layer.add(
            RangeReading(pose[0], pose[1], yaw, distance * horizontal_share, message.field_of_view, is_free, stamp_ns)
        )


class MapTopic:
    """The subscription to a map, for a static layer.

    Args:
        node: the node that subscribes.
        topic: the name of the topic.
        layer: receives the map.
        transient_local: whether to receive a map that was published earlier.
        has_updates: whether to subscribe to changed parts of the map, on the same topic with the suffix ``_updates``.
        on_map: called with each full map and its frame.
    """

    def __init__(
        self,
        node: Node,
        topic: str,
        layer: StaticLayer,
        *,
        transient_local: bool,
        has_updates: bool,
        on_map: Callable[[Grid, str], None],
    ) -> None:
        self.frame: str | None = None
        self._node, self._layer, self._on_map = node, layer, on_map
        qos = LATCHED_QOS if transient_local else QoSProfile(10, durability=DurabilityPolicy.VOLATILE)
        message = get_message("nav_msgs/msg/OccupancyGrid")
        self._subscriptions = [node.create_subscription(message, topic, self._receive, qos)]
        if has_updates:
            message = get_message("map_msgs/msg/OccupancyGridUpdate")
            self._subscriptions.append(node.create_subscription(message, f"{topic}_updates", self._on_update, 10))

    def destroy(self) -> None:
        """Remove the subscriptions."""
        for subscription in self._subscriptions:
            subscription.destroy()

    def _receive(self, message: Any) -> None:
        try:
            grid = grid_from_message(message)
        except BadGridError as error:
            self._node.get_logger().error(f"Received map message is malformed. Rejecting: {error}")
            return
        self.frame = message.header.frame_id
        self._layer.set_map(grid)
        self._on_map(grid, message.header.frame_id)

    def _on_update(self, message: Any) -> None:
        cells = np.frombuffer(message.data, np.uint8)
        if cells.size != message.width * message.height or not self._layer.update_map(
            message.y, message.x, cells.reshape(message.height, message.width)
        ):
            self._node.get_logger().warning("an update does not fit into the map, so it is ignored")
