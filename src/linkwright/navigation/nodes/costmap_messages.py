"""Publishers of costmaps, as occupancy grids for displays and as raw costs for other nodes.

Source: nav2_costmap_2d ``Costmap2DPublisher``.
"""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np

from linkwright.graph import LATCHED_QOS, Node
from linkwright.messages import get_message, is_before_iron
from linkwright.navigation.costmaps.costmap import INSCRIBED, LETHAL, UNKNOWN, Costmap
from linkwright.navigation.costmaps.layer import Costs, Window
from linkwright.navigation.costmaps.layered import LayeredCostmap
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.occupancy import occupancy_message


def _compute_percentages() -> Costs:
    costs = np.arange(256)
    table = 1 + 97 * (costs - 1) // 251
    table[0], table[INSCRIBED], table[LETHAL], table[UNKNOWN] = 0, 99, 100, 255
    percentages: Costs = table.astype(np.uint8)
    return percentages


PERCENTAGES = _compute_percentages()
"""The value in an occupancy grid for each cost, as an unsigned byte: 255 is -1."""


def raw_message(costmap: Costmap, frame: str, stamp: Any) -> Any:
    """Convert a costmap to a nav2_msgs/Costmap."""
    message, grid = get_message("nav2_msgs/msg/Costmap")(), costmap.grid
    message.header.frame_id, message.header.stamp = frame, stamp
    metadata = message.metadata
    metadata.layer, metadata.map_load_time, metadata.update_time = "master", stamp, stamp
    metadata.resolution, metadata.size_x, metadata.size_y = grid.resolution, grid.columns, grid.rows
    metadata.origin.position.x, metadata.origin.position.y = grid.x, grid.y
    metadata.origin.orientation.w = 1.0
    message.data = array("B", grid.cells.tobytes())
    return message


class CostmapPublisher:
    """The publishers of a costmap.

    The whole costmap is published on ``costmap`` and ``costmap_raw``, and changes on ``costmap_updates`` (since Iron,
    also on ``costmap_raw_updates``).

    Args:
        node: the node of the costmap.
        costmap: the costmap to publish.
        frame: the frame of the costmap.
        always_full: whether to publish the whole costmap after every change.
    """

    def __init__(self, node: Node, costmap: LayeredCostmap, frame: str, *, always_full: bool) -> None:
        self._node, self._costmap, self._frame = node, costmap, frame
        self._always_full = always_full
        self._pending_window = Window()
        self._published_geometry: tuple[float, float, int, int] | None = None
        self._subscriber_count = 0
        self._full_publisher = node.create_publisher(get_message("nav_msgs/msg/OccupancyGrid"), "costmap", LATCHED_QOS)
        self._raw_publisher = node.create_publisher(get_message("nav2_msgs/msg/Costmap"), "costmap_raw", LATCHED_QOS)
        update_type = get_message("map_msgs/msg/OccupancyGridUpdate")
        self._updates = node.create_publisher(update_type, "costmap_updates", LATCHED_QOS)
        self._raw_update_publisher: Any = None
        if not is_before_iron():
            self._raw_update_publisher = node.create_publisher(
                get_message("nav2_msgs/msg/CostmapUpdate"), "costmap_raw_updates", LATCHED_QOS
            )

    def destroy(self) -> None:
        """Destroy the publishers."""
        for publisher in (self._full_publisher, self._raw_publisher, self._updates, self._raw_update_publisher):
            if publisher is not None:
                publisher.destroy()

    def add_change(self, window: Window) -> None:
        """Add a changed window to the changes that the next `publish` sends."""
        self._pending_window = self._pending_window.union(window)

    def publish(self) -> None:
        """Publish the changes since the last call.

        The whole costmap is published if it moved or was resized, or if there are new subscribers.
        """
        grid = self._costmap.costmap.grid
        geometry = (grid.x, grid.y, grid.rows, grid.columns)
        subscriber_count = self._full_publisher.get_subscription_count() + self._raw_publisher.get_subscription_count()
        is_full = self._always_full or geometry != self._published_geometry or subscriber_count > self._subscriber_count
        window, self._pending_window = self._pending_window.clipped_to(grid), Window()
        self._subscriber_count = subscriber_count
        if not subscriber_count:
            self._published_geometry = None
            return
        self._published_geometry = geometry
        stamp = self._node.get_clock().now().to_msg()
        if is_full:
            percentages = Grid(
                cells=PERCENTAGES[grid.cells].view(np.int8), resolution=grid.resolution, x=grid.x, y=grid.y
            )
            self._full_publisher.publish(occupancy_message(percentages, self._frame, stamp))
        elif not window.is_empty:
            cells = PERCENTAGES[grid.cells[window.cells]].tobytes()
            message = self._make_update_message("map_msgs/msg/OccupancyGridUpdate", array("b", cells), window, stamp)
            message.width, message.height = window.right - window.left, window.bottom - window.top
            self._updates.publish(message)
        if is_full or not window.is_empty:
            self._publish_raw(window, stamp)

    def _publish_raw(self, window: Window, stamp: Any) -> None:
        """Publish the whole costmap on ``costmap_raw``, and the changes on ``costmap_raw_updates``."""
        if self._raw_publisher.get_subscription_count():
            self._raw_publisher.publish(raw_message(self._costmap.costmap, self._frame, stamp))
        if (
            self._raw_update_publisher is not None
            and self._raw_update_publisher.get_subscription_count()
            and not window.is_empty
        ):
            cells = array("B", self._costmap.costmap.grid.cells[window.cells].tobytes())
            message = self._make_update_message("nav2_msgs/msg/CostmapUpdate", cells, window, stamp)
            message.size_x, message.size_y = window.right - window.left, window.bottom - window.top
            self._raw_update_publisher.publish(message)

    def _make_update_message(self, message_type: str, cells: Any, window: Window, stamp: Any) -> Any:
        message = get_message(message_type)()
        message.header.frame_id, message.header.stamp = self._frame, stamp
        message.x, message.y, message.data = window.left, window.top, cells
        return message
