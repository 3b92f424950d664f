"""rviz_default_plugins/Range."""

from __future__ import annotations

import math
from typing import Any

from linkwright.viewer.config.schema import PropertySpec, topic_spec
from linkwright.viewer.displays.base.recent import RecentDisplay
from linkwright.viewer.displays.properties.look import alpha
from linkwright.viewer.protocol.geometry import RangeCone
from linkwright.viewer.protocol.message import DataContent


class RangeDisplay(RecentDisplay):
    """The last measurements of a range sensor, each as the cone that it saw."""

    CLASS = "rviz_default_plugins/Range"
    MESSAGE = "sensor_msgs/msg/Range"
    LENGTH = ("Buffer Length",)
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        PropertySpec("Color", "color", "#ffffff", "Colour of the cones."),
        alpha("Opacity of the cones.", 0.5),
        PropertySpec("Buffer Length", "int", 1, "How many measurements are shown.", minimum=1),
    )

    def content(self, message: Any) -> DataContent | None:
        """A cone; one of no length where the measurement is none."""
        angle = float(message.field_of_view)
        return RangeCone(_shown(message), angle if math.isfinite(angle) else 0.0)


def _shown(message: Any) -> float:
    """How long the cone is: RViz's rule, that of REP 117 for sensors with a fixed distance."""
    measured, least, most = float(message.range), float(message.min_range), float(message.max_range)
    if least <= measured <= most and math.isfinite(measured):
        return measured
    if least == most and measured == -math.inf:
        return least
    return 0.0
