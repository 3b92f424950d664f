"""Displays that draw geometric messages: GridCells, PointStamped, Polygon and Range."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from linkwright.diagnostics import Phrase, phrase
from linkwright.page.protocol.configuration import StatusLevel
from linkwright.page.protocol.geometry import PointMarks, PolygonLine, RangeCone
from linkwright.page.protocol.message import DataContent
from linkwright.page.protocol.points import CellGrid
from linkwright.rviz.config.schema import (
    PropertySpec,
    alpha,
    topic_spec,
)
from linkwright.rviz.displays.base.display import Pose
from linkwright.rviz.displays.base.topic_display import TOPIC, RecentDisplay, TopicDisplay


class GridCellsDisplay(TopicDisplay):
    """A display of flat cells of equal size."""

    CLASS = "rviz_default_plugins/GridCells"
    MESSAGE = "nav_msgs/msg/GridCells"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        PropertySpec("Color", "color", "#19ff00", "Color of the cells."),
        alpha("Opacity of the cells: 0 is invisible."),
    )

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Show the cells of a message, or the reason why they cannot be drawn."""
        coordinates = [coordinate for cell in message.cells for coordinate in (cell.x, cell.y, cell.z)]
        positions = np.array(coordinates, dtype=np.float64).reshape(-1, 3)
        cell_size = (message.cell_width, message.cell_height)
        if not (np.isfinite(positions).all() and all(map(math.isfinite, cell_size))):
            self._refuse("error", phrase("Message contained invalid floating point values (nans or infs)"))
        elif 0.0 in cell_size:
            self._refuse("error", phrase("One of the Cell's dimension is zero, cells will be invisible."))
        elif not coordinates:
            self._refuse("warn", phrase("Message is empty: there are no cells to be shown."))
        else:
            content = CellGrid(positions.astype(np.float32), float(cell_size[0]), float(cell_size[1]))
            self.send(content, pose=pose, stamp_ns=self.frame_of(message)[1])

    def _refuse(self, level: StatusLevel, text: Phrase) -> None:
        """Remove the cells, and show the reason in the status row of the topic, as in RViz."""
        self.remove_content()
        self.set_status_row(TOPIC, level, text)


class PointStampedDisplay(RecentDisplay):
    """A display of the last points of a topic as spheres.

    The points keep their positions in the Fixed Frame.
    """

    CLASS = "rviz_default_plugins/PointStamped"
    MESSAGE = "geometry_msgs/msg/PointStamped"
    LENGTH = ("History Length",)
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        PropertySpec("Color", "color", "#cc29cc", "The color of the points."),
        PropertySpec("Alpha", "float", 1.0, "Opacity: 0 is invisible.", minimum=0.0, maximum=1.0),
        PropertySpec("Radius", "float", 0.2, "Radius of a point, in meters."),
        PropertySpec("History Length", "int", 1, "The number of points that are shown.", minimum=1, maximum=100000),
    )

    def content(self, message: Any) -> DataContent | None:
        """Return the point of a message, or None if a coordinate is not finite."""
        point = np.array([[message.point.x, message.point.y, message.point.z]], dtype=np.float32)
        return PointMarks(point) if self.is_finite(point[0]) else None


class PolygonDisplay(RecentDisplay):
    """A display of the last polygon of a topic as a closed line."""

    CLASS = "rviz_default_plugins/Polygon"
    MESSAGE = "geometry_msgs/msg/PolygonStamped"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        PropertySpec("Color", "color", "#19ff00", "Color of the line."),
        alpha("Opacity of the line."),
    )

    def content(self, message: Any) -> DataContent | None:
        """Return the corners of the polygon in a message, or None if a coordinate is not finite."""
        corners = [(point.x, point.y, point.z) for point in message.polygon.points]
        points = np.array(corners, dtype=np.float32).reshape(-1, 3)
        return PolygonLine(points) if self.is_finite(points) else None


class RangeDisplay(RecentDisplay):
    """A display of the last measurements of a range sensor, drawn as cones.

    A cone has the angle of the sensor's field of view.
    """

    CLASS = "rviz_default_plugins/Range"
    MESSAGE = "sensor_msgs/msg/Range"
    LENGTH = ("Buffer Length",)
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        PropertySpec("Color", "color", "#ffffff", "Color of the cones."),
        alpha("Opacity of the cones.", 0.5),
        PropertySpec("Buffer Length", "int", 1, "The number of measurements that are shown.", minimum=1),
    )

    def content(self, message: Any) -> DataContent | None:
        """Return the cone of a measurement, with length 0 if the measurement is not valid."""
        angle = float(message.field_of_view)
        return RangeCone(_compute_cone_length(message), angle if math.isfinite(angle) else 0.0)


def _compute_cone_length(message: Any) -> float:
    """Return the length of the cone in meters, as in RViz, according to REP 117.

    A fixed-distance ranger has equal minimum and maximum ranges. It reports -Inf for a detection. A detection is drawn
    at the fixed distance.
    """
    distance, minimum, maximum = float(message.range), float(message.min_range), float(message.max_range)
    if minimum <= distance <= maximum and math.isfinite(distance):
        return distance
    if minimum == maximum and distance == -math.inf:
        return minimum
    return 0.0
