"""The displays of jsk's bounding boxes."""

from __future__ import annotations

import colorsys
import math
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np

from linkwright.rviz.config.schema import PropertySpec, Schema, topic_spec
from linkwright.rviz.displays.class_colors import choose_class_color
from linkwright.rviz.displays.marker import MessageMarkersDisplay
from linkwright.rviz.displays.message_drawing import Marker, Rgba, make_marker, read_color

_AUTO, _FLAT, _LABEL, _VALUE = "Auto", "Flat color", "Label", "Value"
_COLORING, _ALPHA_METHOD = "coloring", "alpha method"
_ONLY_EDGE, _SHOW_COORDS, _THRESHOLD = "only edge", "show coords", "value threshold"
_BY_VALUE = ((_ALPHA_METHOD,), "value")

_MIN_SIZE = 1e-9
_CORNERS = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
_EDGES = [(first, first | bit) for bit in (1, 2, 4) for first in range(8) if not first & bit]
"""Pairs of corners that differ in one coordinate."""
_AXES = np.array([(0, 0, 0), (1, 0, 0), (0, 0, 0), (0, 1, 0), (0, 0, 0), (0, 0, 1)])
_AXIS_COLORS = [(1.0, 0.0, 0.0, 1.0)] * 2 + [(0.0, 1.0, 0.0, 1.0)] * 2 + [(0.0, 0.0, 1.0, 1.0)] * 2
_AXIS_WIDTH = 0.02


class BoundingBoxArrayDisplay(MessageMarkersDisplay):
    """A display of boxes, each in its own frame, colored by their order, their labels or their values."""

    CLASS = "jsk_rviz_plugin/BoundingBoxArray"
    MESSAGE = "jsk_recognition_msgs/msg/BoundingBoxArray"
    SCHEMA: ClassVar[Schema] = (
        topic_spec(description=MESSAGE),
        PropertySpec(
            _COLORING, "enum", _AUTO, "The source of the boxes' colors.", options=(_AUTO, _FLAT, _LABEL, _VALUE)
        ),
        PropertySpec(_ALPHA_METHOD, "enum", "flat", "The source of the opacity.", options=("flat", "value")),
        PropertySpec("color", "color", "#19ff00", "Color of the boxes.", when=((_COLORING,), _FLAT)),
        PropertySpec("alpha", "float", 0.8, "Opacity of the boxes.", when=((_ALPHA_METHOD,), "flat")),
        PropertySpec("alpha min", "float", 0.0, "Opacity of boxes with the value 0.", when=_BY_VALUE),
        PropertySpec("alpha max", "float", 1.0, "Opacity of boxes with the value 1.", when=_BY_VALUE),
        PropertySpec(_ONLY_EDGE, "bool", False, "Draw only the edges of the boxes."),
        PropertySpec(
            "line width", "float", 0.005, "Width of the edges, in meters.", minimum=0.0, when=((_ONLY_EDGE,), True)
        ),
        PropertySpec(_SHOW_COORDS, "bool", False, "Draw the axes of the boxes."),
        PropertySpec(_THRESHOLD, "float", 0.0, "Leave out boxes with a smaller value."),
    )

    def boxes_of(self, message: Any) -> Sequence[Any]:
        """Return the jsk_recognition_msgs/msg/BoundingBox messages that a message contains."""
        return list(message.boxes)

    def threshold(self) -> float:
        """Return the smallest value of the boxes that are drawn."""
        return self.properties.number(_THRESHOLD)

    def markers(self, message: Any) -> list[Any]:
        """Return a box, or its edges, and its axes for each box with a size."""
        number, flag = self.properties.number, self.properties.flag
        boxes = [
            (index, box)
            for index, box in enumerate(self.boxes_of(message))
            if _has_size(box) and not box.value < self.threshold()
        ]
        values = [float(box.value) for _, box in boxes]
        bounds = (min(values), max(values)) if values else (0.0, 0.0)
        markers = []
        for index, box in boxes:
            color = self._choose_color(index, box, bounds)
            size = (box.dimensions.x, box.dimensions.y, box.dimensions.z)
            if flag(_ONLY_EDGE):
                points = (_CORNERS * size)[np.ravel(_EDGES)]
                width = (number("line width"), 0.0, 0.0)
                markers.append(
                    make_marker("boxes", index, Marker.LINE_LIST, color, scale=width, pose=box.pose, points=points)
                )
            else:
                markers.append(make_marker("boxes", index, Marker.CUBE, color, scale=size, pose=box.pose))
            if flag(_SHOW_COORDS):
                markers.append(
                    make_marker(
                        "axes",
                        index,
                        Marker.LINE_LIST,
                        color,
                        scale=(_AXIS_WIDTH, 0.0, 0.0),
                        pose=box.pose,
                        points=_AXES * min(size),
                        colors=_AXIS_COLORS,
                    )
                )
        headers = {index: box.header for index, box in boxes}
        for marker in markers:
            marker.header = headers[marker.id]
        return markers

    def _choose_color(self, index: int, box: Any, bounds: tuple[float, float]) -> Rgba:
        number, method = self.properties.number, self.properties.text(_COLORING)
        opacity = number("alpha")
        if self.properties.text(_ALPHA_METHOD) == "value":
            opacity = number("alpha min") + box.value * (number("alpha max") - number("alpha min"))
        opacity = min(1.0, max(0.0, opacity))
        if method == _FLAT:
            return read_color(self.properties.text("color"), opacity)
        if method == _VALUE:
            least, most = bounds
            if least == most:
                return 1.0, 1.0, 1.0, opacity
            return *colorsys.hsv_to_rgb((1 - (box.value - least) / (most - least)) * 2 / 3, 1.0, 1.0), opacity
        red, green, blue = choose_class_color(str(box.label if method == _LABEL else index), {})
        return red / 255, green / 255, blue / 255, opacity


class BoundingBoxDisplay(BoundingBoxArrayDisplay):
    """A display of a single box."""

    CLASS = "jsk_rviz_plugin/BoundingBox"
    MESSAGE = "jsk_recognition_msgs/msg/BoundingBox"
    SCHEMA: ClassVar[Schema] = (topic_spec(description=MESSAGE), *BoundingBoxArrayDisplay.SCHEMA[1:-1])

    def boxes_of(self, message: Any) -> Sequence[Any]:
        """Return the box."""
        return [message]

    def threshold(self) -> float:
        """Return the smallest number: the box is always drawn."""
        return -math.inf


def _has_size(box: Any) -> bool:
    sizes = (box.dimensions.x, box.dimensions.y, box.dimensions.z)
    return all(size >= _MIN_SIZE and math.isfinite(size) for size in sizes)
