"""The display of Autoware's poses with an ID."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from linkwright.geometry.arrays import rotate
from linkwright.rviz.config.schema import PropertySpec, length_spec, topic_spec
from linkwright.rviz.displays.marker import MessageMarkersDisplay
from linkwright.rviz.displays.message_drawing import (
    Marker,
    list_orientations,
    list_positions,
    make_marker,
    make_text,
)

_AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_UUID = "UUID"


class PoseWithUuidDisplay(MessageMarkersDisplay):
    """A display of the last pose of a topic as axes, with its ID."""

    CLASS = "rviz_plugins/PoseWithUuidStamped"
    MESSAGE = "autoware_planning_msgs/msg/PoseWithUuidStamped"
    OCCASIONAL = True
    SCHEMA = (
        topic_spec(description=MESSAGE),
        PropertySpec("Length", "float", 1.5, "Length of each axis, in meters.", minimum=0.0001),
        PropertySpec("Radius", "float", 0.5, "Radius of each axis, in meters.", minimum=0.0001),
        PropertySpec(
            _UUID,
            "bool",
            False,
            "Write the ID.",
            children=(length_spec("Scale", 0.3, "Height of the text, in meters."),),
        ),
    )

    def markers(self, message: Any) -> Iterator[Any]:
        """Return the axes and the ID."""
        origin = list_positions([message.pose.position])[0]
        orientation = list_orientations([message.pose])[0]
        length, diameter = self.properties.number("Length"), 2 * self.properties.number("Radius")
        for number, axis in enumerate(_AXES):
            ends = [origin, origin + length * rotate(orientation, axis)]
            color = (*axis, 1.0)
            # An arrow without a head is a cylinder between two points.
            scale = (diameter, diameter, 1e-3)
            yield make_marker("axes", number, Marker.ARROW, color, scale=scale, points=ends)
        if self.properties.flag(_UUID):
            text = bytes(message.uuid.uuid).hex()
            yield make_text("id", 0, text, origin, self.properties.number(_UUID, "Scale"), (1.0, 1.0, 1.0, 1.0))
