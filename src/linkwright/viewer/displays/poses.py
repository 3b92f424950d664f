"""rviz_default_plugins/Pose, PoseArray and PoseWithCovariance."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from linkwright.viewer.config.schema import PropertySpec, topic_spec
from linkwright.viewer.displays.base.recent import RecentDisplay
from linkwright.viewer.displays.properties.look import alpha, length
from linkwright.viewer.displays.properties.pose import covariance, pose_shape
from linkwright.viewer.protocol.data import Floats
from linkwright.viewer.protocol.geometry import PoseMarks
from linkwright.viewer.protocol.message import DataContent

NO_COVARIANCE: Floats = np.zeros(0, dtype=np.float32)

_FLAT = (("Shape",), "Arrow (Flat)")
_SOLID = (("Shape",), "Arrow (3D)")
_AXES = (("Shape",), "Axes")


def pose_row(pose: Any) -> tuple[float, ...]:
    """x, y, z, qx, qy, qz, qw of a geometry_msgs/msg/Pose."""
    at, turn = pose.position, pose.orientation
    return (at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w)


def pose_rows(poses: Iterable[Any]) -> Floats:
    """Those of many; shape (N, 7)."""
    return np.array([pose_row(pose) for pose in poses], dtype=np.float32).reshape(-1, 7)


class PoseDisplay(RecentDisplay):
    """The last pose of a topic."""

    CLASS = "rviz_default_plugins/Pose"
    MESSAGE = "geometry_msgs/msg/PoseStamped"
    SCHEMA = (topic_spec(description=MESSAGE, filter_size=10), *pose_shape())

    def content(self, message: Any) -> DataContent | None:
        """The pose."""
        row = pose_row(message.pose)
        return PoseMarks(np.array([row], dtype=np.float32), NO_COVARIANCE) if self.is_finite(row) else None


class PoseWithCovarianceDisplay(RecentDisplay):
    """The last pose of a topic, and how uncertain it is."""

    CLASS = "rviz_default_plugins/PoseWithCovariance"
    MESSAGE = "geometry_msgs/msg/PoseWithCovarianceStamped"
    SCHEMA = (topic_spec(description=MESSAGE, filter_size=10), *pose_shape(), covariance())

    def content(self, message: Any) -> DataContent | None:
        """The pose with its covariance."""
        row = pose_row(message.pose.pose)
        spread = np.asarray(message.pose.covariance, dtype=np.float64)
        if not self.is_finite(row, spread):
            return None
        return PoseMarks(np.array([row], dtype=np.float32), spread.astype(np.float32))


class PoseArrayDisplay(RecentDisplay):
    """The poses of the last message of a topic."""

    CLASS = "rviz_default_plugins/PoseArray"
    MESSAGE = "geometry_msgs/msg/PoseArray"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        PropertySpec(
            "Shape",
            "enum",
            "Arrow (Flat)",
            "Whether poses are drawn as arrows of lines, as solid arrows or as axes.",
            options=("Arrow (Flat)", "Arrow (3D)", "Axes"),
        ),
        PropertySpec("Color", "color", "#ff1900", "Colour of the arrows."),
        alpha("Opacity of the arrows."),
        length("Arrow Length", 0.3, "Length of the arrows, in metres.", _FLAT),
        length("Head Radius", 0.03, "Width of the arrows' heads, in metres.", _SOLID),
        length("Head Length", 0.07, "Length of the arrows' heads, in metres.", _SOLID),
        length("Shaft Radius", 0.01, "Thickness of the arrows' shafts, in metres.", _SOLID),
        length("Shaft Length", 0.23, "Length of the arrows' shafts, in metres.", _SOLID),
        length("Axes Length", 0.3, "Length of each axis, in metres.", _AXES),
        length("Axes Radius", 0.01, "Thickness of each axis, in metres.", _AXES),
    )

    def content(self, message: Any) -> DataContent | None:
        """The poses."""
        rows = pose_rows(message.poses)
        return PoseMarks(rows, NO_COVARIANCE) if self.is_finite(rows) else None
