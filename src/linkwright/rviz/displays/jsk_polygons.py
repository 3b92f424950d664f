"""The display of jsk's polygons, such as planes that were found in a point cloud."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.polygon import triangulate
from linkwright.rviz.config.schema import PropertySpec, Schema, topic_spec
from linkwright.rviz.displays.class_colors import choose_class_color
from linkwright.rviz.displays.marker import MessageMarkersDisplay
from linkwright.rviz.displays.message_drawing import Marker, Rgba, list_positions, make_marker, read_color

_AUTO, _FLAT, _LIKELIHOOD, _LABEL = "Auto", "Flat color", "Likelihood", "Label"
_COLORING, _ONLY_BORDER = "coloring", "only border"
_SHOW_NORMAL, _NORMAL_LENGTH = "show normal", "normal length"
_BORDER_WIDTH, _SHAFT_WIDTH, _HEAD_WIDTH = 0.01, 0.01, 0.02


class PolygonArrayDisplay(MessageMarkersDisplay):
    """A display of polygons in space, each in its own frame, as surfaces or borders, with their normals."""

    CLASS = "jsk_rviz_plugin/PolygonArray"
    MESSAGE = "jsk_recognition_msgs/msg/PolygonArray"
    SCHEMA: ClassVar[Schema] = (
        topic_spec(description=MESSAGE),
        PropertySpec(
            _COLORING,
            "enum",
            _AUTO,
            "The source of the polygons' colors.",
            options=(_AUTO, _FLAT, _LIKELIHOOD, _LABEL),
        ),
        PropertySpec("Color", "color", "#19ff00", "Color of the polygons.", when=((_COLORING,), _FLAT)),
        PropertySpec("Alpha", "float", 1.0, "Opacity of the polygons.", minimum=0.0, maximum=1.0),
        PropertySpec(_ONLY_BORDER, "bool", True, "Draw only the edges of the polygons."),
        PropertySpec(_SHOW_NORMAL, "bool", True, "Draw the normals of the polygons as arrows."),
        PropertySpec(
            _NORMAL_LENGTH, "float", 0.1, "Length of the normals, in meters.", minimum=0.0, when=((_SHOW_NORMAL,), True)
        ),
    )

    def markers(self, message: Any) -> list[Any]:
        """Return a surface or a border, and an arrow, for each polygon with an area."""
        markers = []
        for index, stamped in enumerate(message.polygons):
            corners = list_positions(stamped.polygon.points)
            normal = _find_normal(corners)
            if normal is None:
                continue
            color = self._choose_color(index, message)
            drawn = [self._draw_surface(index, corners, normal, color)]
            if self.properties.flag(_SHOW_NORMAL):
                drawn.append(self._draw_normal(index, corners, normal, color))
            for marker in drawn:
                marker.header = stamped.header
            markers += drawn
        return markers

    def _draw_surface(self, index: int, corners: Array, normal: Array, color: Rgba) -> Any:
        if self.properties.flag(_ONLY_BORDER):
            border = np.concatenate((corners, corners[:1]))
            return make_marker(
                "polygons", index, Marker.LINE_STRIP, color, scale=(_BORDER_WIDTH, 0.0, 0.0), points=border
            )
        flat = np.delete(corners, int(np.abs(normal).argmax()), axis=1)
        triangles = triangulate([(float(x), float(y)) for x, y in flat])
        points = corners[np.array(triangles, dtype=np.intp).ravel()]
        return make_marker("polygons", index, Marker.TRIANGLE_LIST, color, scale=(1.0, 1.0, 1.0), points=points)

    def _draw_normal(self, index: int, corners: Array, normal: Array, color: Rgba) -> Any:
        center = corners.mean(axis=0)
        tip = center + self.properties.number(_NORMAL_LENGTH) * normal
        return make_marker(
            "normals", index, Marker.ARROW, color, scale=(_SHAFT_WIDTH, _HEAD_WIDTH, 0.0), points=(center, tip)
        )

    def _choose_color(self, index: int, message: Any) -> Rgba:
        method, alpha = self.properties.text(_COLORING), self.properties.number("Alpha")
        if method == _FLAT:
            return read_color(self.properties.text("Color"), alpha)
        if method == _LIKELIHOOD:
            likelihood = float(message.likelihood[index]) if index < len(message.likelihood) else 0.0
            share = min(1.0, max(0.0, likelihood)) if math.isfinite(likelihood) else 0.0
            return share, 0.0, 1.0 - share, alpha
        number = index
        if method == _LABEL:
            number = int(message.labels[index]) if index < len(message.labels) else 0
        red, green, blue = choose_class_color(str(number), {})
        return red / 255, green / 255, blue / 255, alpha


def _find_normal(corners: Array) -> Array | None:
    """Return the unit normal about which the corners of a polygon are counterclockwise, or None if it has no area.

    Source: M. E. Newell's method, in Sutherland, Sproull and Schumacker, "A characterization of ten hidden-surface
    algorithms", 1974.
    """
    if len(corners) < 3 or not np.isfinite(corners).all():
        return None
    relative = corners - corners[0]
    doubled: Array = np.cross(relative, np.roll(relative, -1, axis=0)).sum(axis=0)
    length = float(np.linalg.norm(doubled))
    return doubled / length if length > 0.0 else None
