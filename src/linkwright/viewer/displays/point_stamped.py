"""rviz_default_plugins/PointStamped."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.viewer.config.schema import PropertySpec, topic_spec
from linkwright.viewer.displays.base.recent import RecentDisplay
from linkwright.viewer.protocol.geometry import PointMarks
from linkwright.viewer.protocol.message import DataContent


class PointStampedDisplay(RecentDisplay):
    """The last points of a topic, as spheres that stay where they were in the Fixed Frame."""

    CLASS = "rviz_default_plugins/PointStamped"
    MESSAGE = "geometry_msgs/msg/PointStamped"
    LENGTH = ("History Length",)
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        PropertySpec("Color", "color", "#cc29cc", "The colour of the points."),
        PropertySpec("Alpha", "float", 1.0, "Opacity: 0 is invisible.", minimum=0.0, maximum=1.0),
        PropertySpec("Radius", "float", 0.2, "Radius of a point, in metres."),
        PropertySpec("History Length", "int", 1, "How many points are shown.", minimum=1, maximum=100000),
    )

    def content(self, message: Any) -> DataContent | None:
        """The point."""
        point = np.array([[message.point.x, message.point.y, message.point.z]], dtype=np.float32)
        return PointMarks(point) if self.is_finite(point[0]) else None
