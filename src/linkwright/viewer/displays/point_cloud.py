"""rviz_default_plugins/PointCloud."""

from __future__ import annotations

from typing import Any

from linkwright.viewer.clouds import Points, points_of_legacy_cloud
from linkwright.viewer.config.schema import topic_spec
from linkwright.viewer.displays.base.cloud_display import CloudDisplay
from linkwright.viewer.displays.properties.cloud import STYLE_SPECS, TRANSFORMER_SPECS


class PointCloudDisplay(CloudDisplay):
    """A cloud of points as the old sensor_msgs/msg/PointCloud has it."""

    CLASS = "rviz_default_plugins/PointCloud"
    MESSAGE = "sensor_msgs/msg/PointCloud"
    SCHEMA = (
        topic_spec(description="sensor_msgs/msg/PointCloud", filter_size=10),
        *STYLE_SPECS,
        *TRANSFORMER_SPECS,
    )

    def points_of(self, message: Any) -> Points:
        """The points with finite coordinates."""
        return points_of_legacy_cloud(message)
