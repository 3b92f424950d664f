"""A base class for displays that draw over the scene, and the parts of their figures."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from linkwright.graph import QoSProfile
from linkwright.page.protocol.message import Bytes
from linkwright.page.protocol.overlays import HorizontalSide, OverlayFigure, OverlayShape, VerticalSide
from linkwright.rviz.config.property_store import qos_from_properties
from linkwright.rviz.config.schema import Path
from linkwright.rviz.displays.base.display import Pose
from linkwright.rviz.displays.base.topic_display import TopicDisplay
from linkwright.rviz.displays.message_drawing import Rgba

NO_PIXELS: Bytes = np.zeros(0, dtype=np.uint8)
POINTS_TO_PIXELS = 4 / 3
"""The height of a text of one point, in CSS pixels."""

_ARC_STEP_RAD = math.radians(5)


@dataclass(slots=True)
class Figure:
    """A figure over the scene, in CSS pixels, at a distance from two sides of the window.

    Attributes:
        x: the distance from the side `horizontal`, or from the middle.
        y: the distance from the side `vertical`, or from the middle.
        background: the color of the whole figure.
        corner: the radius of the background's corners.
        shapes: the parts, the first at the back.
        image: an image that fills the figure, red, green, blue and opacity, shape (rows, columns, 4).
    """

    x: float
    y: float
    width: float
    height: float
    horizontal: HorizontalSide = "left"
    vertical: VerticalSide = "top"
    background: Rgba = (0.0, 0.0, 0.0, 0.0)
    corner: float = 0.0
    shapes: list[OverlayShape] = field(default_factory=list)
    image: Bytes | None = None

    def add_text(
        self,
        text: str,
        x: float,
        y: float,
        height: float,
        color: Rgba,
        *,
        align: HorizontalSide = "left",
        wrap: float = 0.0,
        is_above: bool = False,
    ) -> None:
        """Add a text, whose place is its upper edge, or its lower edge with `is_above`."""
        points = [float(x), float(y)]
        self.shapes.append(OverlayShape("text", points, list(color), float(height), text, align, wrap, is_above))

    def add_line(self, points: Sequence[tuple[float, float]], width: float, color: Rgba) -> None:
        """Add a line through points."""
        self.shapes.append(OverlayShape("line", _flatten(points), list(color), float(width)))

    def add_area(self, points: Sequence[tuple[float, float]], color: Rgba) -> None:
        """Add a filled polygon."""
        self.shapes.append(OverlayShape("area", _flatten(points), list(color)))

    def add_arc(
        self, center: tuple[float, float], radius: float, start: float, turn: float, width: float, color: Rgba
    ) -> None:
        """Add an arc from an angle by a turn, rad, counterclockwise from the right."""
        count = max(2, math.ceil(abs(turn) / _ARC_STEP_RAD) + 1)
        angles = (start + turn * i / (count - 1) for i in range(count))
        line = [(center[0] + radius * math.cos(angle), center[1] - radius * math.sin(angle)) for angle in angles]
        self.add_line(line, width, color)


def _flatten(points: Sequence[tuple[float, float]]) -> list[float]:
    return [float(coordinate) for point in points for coordinate in point]


class OverlayDisplay(TopicDisplay):
    """A base class for displays that draw the last message of a topic over the scene.

    A subclass sets `CLASS`, `MESSAGE` and `SCHEMA`, and overrides `figure`.
    """

    DRAWN_AS = "rviz_2d_overlay_plugins/TextOverlay"
    TRANSFORMED = False

    def subscription(self) -> tuple[str, str, QoSProfile]:
        """Return the message type, topic and QoS to subscribe with."""
        (name,) = self.TOPIC
        return self.MESSAGE, self.properties.text(name).strip(), qos_from_properties(self.properties, name)

    @abstractmethod
    def figure(self, message: Any) -> Figure | None:
        """Return the figure of a message; None to show nothing."""

    def process_message(self, message: Any, pose: Pose | None) -> None:  # a message has no place in the scene
        """Show the figure of a message."""
        self.show_figure(self.figure(message))

    def on_property_changed(self, path: Path) -> None:
        """Subscribe again if necessary, and draw the last message again."""
        if path[0] == self.TOPIC[0]:
            self._restart()
        else:
            self.show_again()

    def show_figure(self, figure: Figure | None) -> None:
        """Send a figure to the pages, or remove the last one."""
        if figure is None or figure.width <= 0 or figure.height <= 0:
            self.remove_content()
            return
        image = figure.image
        texts = [shape.text for shape in figure.shapes if shape.text]
        content = OverlayFigure(
            label="\n".join([self.config.name, *texts]),
            horizontal=figure.horizontal,
            vertical=figure.vertical,
            x=float(figure.x),
            y=float(figure.y),
            width=float(figure.width),
            height=float(figure.height),
            background=list(figure.background),
            corner=figure.corner,
            shapes=figure.shapes,
            image_width=0 if image is None else image.shape[1],
            image_height=0 if image is None else image.shape[0],
            pixels=NO_PIXELS if image is None else np.ascontiguousarray(image).reshape(-1),
        )
        self.send(content)
