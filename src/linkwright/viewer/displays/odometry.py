"""rviz_default_plugins/Odometry."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from linkwright.viewer.config.rviz_config import DisplayConfig
from linkwright.viewer.config.schema import PropertySpec, topic_spec
from linkwright.viewer.displays.base.host import DisplayHost
from linkwright.viewer.displays.base.recent import RecentDisplay
from linkwright.viewer.displays.poses import pose_row
from linkwright.viewer.displays.properties.pose import covariance, pose_shape
from linkwright.viewer.protocol.geometry import PoseMarks
from linkwright.viewer.protocol.message import DataContent

_NORM_TOLERANCE = 10e-3


class OdometryDisplay(RecentDisplay):
    """The way of a robot: a mark wherever it was a bit further or turned a bit more than at the mark before."""

    CLASS = "rviz_default_plugins/Odometry"
    MESSAGE = "nav_msgs/msg/Odometry"
    LENGTH = ("Keep",)
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        PropertySpec(
            "Position Tolerance", "float", 0.1, "Metres from the last mark that make for a new one.", minimum=0.0
        ),
        PropertySpec(
            "Angle Tolerance", "float", 0.1, "Radians from the last mark that make for a new one.", minimum=0.0
        ),
        PropertySpec("Keep", "int", 100, "How many marks are kept; 0 for all of them.", minimum=0),
        *pose_shape(nested=True),
        covariance(),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._marked: tuple[float, ...] | None = None

    def content(self, message: Any) -> DataContent | None:
        """The pose with its covariance, unless it is too near to the last."""
        row = pose_row(message.pose.pose)
        spread = np.asarray(message.pose.covariance, dtype=np.float64)
        if not self.is_finite(row, spread):
            return None
        if abs(sum(part * part for part in row[3:]) - 1.0) >= _NORM_TOLERANCE:
            self.refuse("Message contained unnormalized quaternion (squares of values don't add to 1)")
            return None
        if self._is_near(row):
            return None
        self._marked = row
        return PoseMarks(np.array([row], dtype=np.float32), spread.astype(np.float32))

    def reset(self) -> None:
        """Forget the marks; the next message makes one."""
        self._marked = None
        super().reset()

    def _is_near(self, row: tuple[float, ...]) -> bool:
        if self._marked is None:
            return False
        cosine = sum(a * b for a, b in zip(self._marked[3:], row[3:], strict=True))
        angle = math.acos(min(1.0, max(-1.0, 2.0 * cosine * cosine - 1.0)))
        return math.dist(self._marked[:3], row[:3]) < self.properties.number(
            "Position Tolerance"
        ) and angle < self.properties.number("Angle Tolerance")
