"""rviz_default_plugins/PointCloud2."""

from __future__ import annotations

from typing import Any

from linkwright.viewer.clouds import Points, points_of_cloud
from linkwright.viewer.config.schema import topic_spec
from linkwright.viewer.displays.base.cloud_display import CloudDisplay
from linkwright.viewer.displays.properties.cloud import STYLE_SPECS, TRANSFORMER_SPECS


class PointCloud2Display(CloudDisplay):
    """A cloud of points."""

    CLASS = "rviz_default_plugins/PointCloud2"
    MESSAGE = "sensor_msgs/msg/PointCloud2"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *STYLE_SPECS,
        *TRANSFORMER_SPECS,
    )

    def points_of(self, message: Any) -> Points:
        """The points with finite coordinates."""
        return points_of_cloud(message)
