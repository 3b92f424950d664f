"""rviz_default_plugins/Path."""

from __future__ import annotations

from typing import Any

from linkwright.viewer.config.schema import PropertySpec, topic_spec, vector
from linkwright.viewer.displays.base.recent import RecentDisplay
from linkwright.viewer.displays.poses import NO_COVARIANCE, pose_rows
from linkwright.viewer.displays.properties.look import alpha, length, line_style, line_width
from linkwright.viewer.protocol.geometry import PoseMarks
from linkwright.viewer.protocol.message import DataContent

_AXES = (("Pose Style",), "Axes")
_ARROWS = (("Pose Style",), "Arrows")


class PathDisplay(RecentDisplay):
    """The last paths of a topic, as lines through their poses, with the poses if asked for."""

    CLASS = "rviz_default_plugins/Path"
    MESSAGE = "nav_msgs/msg/Path"
    LENGTH = ("Buffer Length",)
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        line_style(),
        line_width(),
        PropertySpec("Color", "color", "#19ff00", "Colour of the lines."),
        alpha("Opacity of the lines."),
        PropertySpec("Buffer Length", "int", 1, "How many paths are shown.", minimum=1),
        vector("Offset", "How far from their place paths are drawn, in metres of the Fixed Frame."),
        PropertySpec("Pose Style", "enum", "None", "How the poses are drawn.", options=("None", "Axes", "Arrows")),
        length("Length", 0.3, "Length of each axis, in metres.", _AXES),
        length("Radius", 0.03, "Thickness of each axis, in metres.", _AXES),
        PropertySpec("Pose Color", "color", "#ff55ff", "Colour of the arrows.", when=_ARROWS),
        length("Shaft Length", 0.1, "Length of the arrows' shafts, in metres.", _ARROWS),
        length("Head Length", 0.2, "Length of the arrows' heads, in metres.", _ARROWS),
        length("Shaft Diameter", 0.1, "Thickness of the arrows' shafts, in metres.", _ARROWS),
        length("Head Diameter", 0.3, "Width of the arrows' heads, in metres.", _ARROWS),
    )

    def content(self, message: Any) -> DataContent | None:
        """The poses of a path."""
        rows = pose_rows(stamped.pose for stamped in message.poses)
        return PoseMarks(rows, NO_COVARIANCE) if self.is_finite(rows) else None
