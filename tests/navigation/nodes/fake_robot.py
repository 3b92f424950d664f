"""A fake robot with a map and a laser for navigation nodes.

Its graph has a stepped clock.
"""

from __future__ import annotations

from math import cos, sin

import numpy as np

from linkwright.graph import DESCRIPTION_QOS, SENSOR_DATA_QOS, Graph, JumpClock
from linkwright.messages import Header, Time, TransformStamped, get_message
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.occupancy import occupancy_message

SCAN = get_message("sensor_msgs/msg/LaserScan")
RAY_COUNT = 360


def make_room_cells(rows: int = 60, columns: int = 80) -> Grid:
    """Return a room of 4 by 3 m with walls around it, in cells of 5 cm."""
    cells = np.zeros((rows, columns), np.int8)
    cells[[0, -1]] = 100
    cells[:, [0, -1]] = 100
    return Grid(cells=cells, resolution=0.05)


class FakeRobot:
    """The topics of a robot for its nodes.

    Attributes:
        node: the node that publishes them.
        pose: x, y and yaw of ``base_link`` in ``map``; ``odom`` is ``map``.
    """

    def __init__(self, graph: Graph, clock: JumpClock) -> None:
        self.graph, self.clock = graph, clock
        self.node = graph.create_node("robot")
        self.pose = (1.0, 1.0, 0.0)
        self._tf = self.node.create_publisher("tf2_msgs/msg/TFMessage", "/tf", 100)
        self._map = self.node.create_publisher("nav_msgs/msg/OccupancyGrid", "/map", DESCRIPTION_QOS)
        self._scan = self.node.create_publisher("sensor_msgs/msg/LaserScan", "/scan", SENSOR_DATA_QOS)

    def stamp(self) -> Time:
        return Time.from_nanoseconds(self.clock.now_ns())

    def publish_map(self, grid: Grid) -> None:
        self._map.publish(occupancy_message(grid, "map", self.stamp()))

    def publish_pose(self, x: float | None = None, y: float | None = None, yaw: float | None = None) -> None:
        changes = (x, y, yaw)
        self.pose = tuple(old if new is None else new for old, new in zip(self.pose, changes, strict=True))
        message = self._tf.msg_type()
        message.transforms = [
            self._transform("map", "odom", 0.0, 0.0, 0.0),
            self._transform("odom", "base_link", *self.pose),
        ]
        self._tf.publish(message)

    def _transform(self, parent: str, child: str, x: float, y: float, yaw: float) -> TransformStamped:
        transform = TransformStamped(header=Header(stamp=self.stamp(), frame_id=parent), child_frame_id=child)
        transform.transform.translation.x, transform.transform.translation.y = x, y
        transform.transform.rotation.z, transform.transform.rotation.w = sin(yaw / 2.0), cos(yaw / 2.0)
        return transform

    def publish_scan(self, *ranges: tuple[int, float]) -> None:
        """Publish a full scan: some rays, given in degrees, have a range, and the others reach 5 m."""
        scan = SCAN()
        scan.header.frame_id, scan.header.stamp = "base_link", self.stamp()
        scan.angle_min, scan.angle_increment = 0.0, float(np.radians(1.0))
        scan.angle_max = float(np.radians(RAY_COUNT - 1))
        scan.range_min, scan.range_max = 0.1, 6.0
        values = np.full(RAY_COUNT, 5.0)
        for degrees, range_m in ranges:
            values[degrees] = range_m
        scan.ranges = values.astype(np.float32)
        self._scan.publish(scan)

    async def run(self, seconds: float) -> None:
        await self.graph.settle()
        await self.clock.advance(seconds)
        await self.graph.settle()
