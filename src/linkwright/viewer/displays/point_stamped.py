"""rviz_default_plugins/PointStamped."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np

from linkwright.viewer.displays.base import Stage
from linkwright.viewer.displays.data_display import Pose
from linkwright.viewer.displays.look_properties import alpha
from linkwright.viewer.displays.topic_display import TopicDisplay
from linkwright.viewer.displays.topic_properties import topic_spec
from linkwright.viewer.placing import placed
from linkwright.viewer.property_store import Path
from linkwright.viewer.protocol import PointMarks
from linkwright.viewer.rviz_config import DisplayConfig
from linkwright.viewer.schema import PropertySpec

_LENGTH = "History Length"


class PointStampedDisplay(TopicDisplay):
    """The last points of a topic, as spheres that stay where they were in the Fixed Frame."""

    CLASS = "rviz_default_plugins/PointStamped"
    MESSAGE = "geometry_msgs/msg/PointStamped"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        PropertySpec("Color", "color", "#cc29cc", "The colour of the points."),
        alpha(),
        PropertySpec("Radius", "float", 0.2, "Radius of a point, in metres."),
        PropertySpec(_LENGTH, "int", 1, "How many points are shown.", minimum=1, maximum=100000),
    )

    def __init__(self, stage: Stage, identity: str, config: DisplayConfig) -> None:
        super().__init__(stage, identity, config)
        self._points: deque[Any] = deque()

    def take(self, message: Any, pose: Pose | None) -> None:
        """Add a point."""
        assert pose is not None
        point = np.array([message.point.x, message.point.y, message.point.z])
        if not np.isfinite(point).all():
            self.say("Message", "error", "Message contained invalid floating point values (nans or infs)")
            return
        self.unsay("Message")
        self._points.append(placed(pose, point))
        self._show()

    def changed(self, path: Path) -> None:
        """Show as many points as are asked for."""
        super().changed(path)
        if path == (_LENGTH,) and self._points:
            self._show()

    def reset(self) -> None:
        """Forget the points."""
        self._points.clear()
        super().reset()

    def _show(self) -> None:
        while len(self._points) > self.properties.number(_LENGTH):
            self._points.popleft()
        self.send(PointMarks(np.array(self._points, dtype=np.float32)))
