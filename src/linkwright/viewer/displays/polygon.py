"""rviz_default_plugins/Polygon."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.viewer.config.schema import PropertySpec, topic_spec
from linkwright.viewer.displays.base.recent import RecentDisplay
from linkwright.viewer.displays.properties.look import alpha
from linkwright.viewer.protocol.geometry import PolygonLine
from linkwright.viewer.protocol.message import DataContent


class PolygonDisplay(RecentDisplay):
    """The last polygon of a topic, as a closed line."""

    CLASS = "rviz_default_plugins/Polygon"
    MESSAGE = "geometry_msgs/msg/PolygonStamped"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        PropertySpec("Color", "color", "#19ff00", "Colour of the line."),
        alpha("Opacity of the line."),
    )

    def content(self, message: Any) -> DataContent | None:
        """The corners."""
        corners = [(point.x, point.y, point.z) for point in message.polygon.points]
        points = np.array(corners, dtype=np.float32).reshape(-1, 3)
        return PolygonLine(points) if self.is_finite(points) else None
