"""rviz_default_plugins/LaserScan."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.graph import TransformException
from linkwright.viewer.clouds import Points, ScanProjector, swept
from linkwright.viewer.config.rviz_config import DisplayConfig
from linkwright.viewer.config.schema import topic_spec
from linkwright.viewer.displays.base.cloud_display import CloudDisplay
from linkwright.viewer.displays.base.data_display import Pose
from linkwright.viewer.displays.base.host import DisplayHost
from linkwright.viewer.displays.properties.cloud import STYLE_SPECS, TRANSFORMER_SPECS

_IDENTITY = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


class LaserScanDisplay(CloudDisplay):
    """The echoes of a planar scanner.

    Each ray is placed where the scanner was when it was sent, as laser_geometry does; a scan whose end has no
    transforms yet is placed by its beginning, where RViz would drop it.
    """

    CLASS = "rviz_default_plugins/LaserScan"
    MESSAGE = "sensor_msgs/msg/LaserScan"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *STYLE_SPECS,
        *TRANSFORMER_SPECS,
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._projector = ScanProjector()

    def points_of(self, message: Any) -> Points:
        """Where the rays hit something."""
        return self._projector.points(message)

    def placed(self, points: Points, message: Any, pose: Pose) -> tuple[Points, Pose]:
        """The points in the Fixed Frame if the scanner moved, else in its own frame."""
        steps = len(message.ranges) - 1
        frame, stamp_ns = self.frame_of(message)
        seconds = steps * float(message.time_increment)
        if stamp_ns == 0 or steps < 1 or not 0.0 < seconds < 3600.0:
            return points, pose
        fixed_frame = self.host.frames.fixed_frame
        try:
            end = self.context.transforms.pose(fixed_frame, frame.removeprefix("/"), stamp_ns + int(seconds * 1e9))
        except TransformException:
            return points, pose
        if np.allclose(end, pose, rtol=0.0, atol=1e-9):
            return points, pose
        return swept(points, points.channels["index"] / steps, pose, end), _IDENTITY
