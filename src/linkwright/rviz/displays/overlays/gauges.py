"""The displays of numbers over the scene: a gauge, a plot, and the meter of an acceleration."""

from __future__ import annotations

import math
from collections import deque
from typing import Any, ClassVar

from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import PropertySpec, Schema, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost
from linkwright.rviz.displays.message_drawing import Rgba, read_color
from linkwright.rviz.displays.overlays.base import POINTS_TO_PIXELS, Figure, OverlayDisplay

_FLOAT = "std_msgs/msg/Float32"
_RIM_PX, _RING_PX, _GUIDE_PX, _GAP_PX = 5, 10, 2, 5
"""The widths of a gauge's rim, value and guide, and the gap between rim and value."""


def _pixels(name: str, default: int, description: str, minimum: int = 0) -> PropertySpec:
    return PropertySpec(name, "int", default, f"{description}, in pixels.", minimum=minimum)


def _opacity(name: str, default: float, description: str) -> PropertySpec:
    return PropertySpec(name, "float", default, description, minimum=0.0, maximum=1.0)


def _color_specs(text_size: int) -> Schema:
    return (
        PropertySpec("foreground color", "color", "#19fff0", "Color of the lines and texts."),
        _opacity("foreground alpha", 0.7, "Opacity of the lines and texts."),
        PropertySpec("background color", "color", "#000000", "Color of the background."),
        # RViz spells the name of this property so.
        _opacity("backround alpha", 0.0, "Opacity of the background."),
        PropertySpec("text size", "int", text_size, "Size of the texts, in points.", minimum=1),
        PropertySpec("show caption", "bool", True, "Write the name of the display below."),
        PropertySpec("auto color change", "bool", False, "Change the color when the value comes near the maximum."),
        PropertySpec("max color", "color", "#ff0000", "Color of the maximum.", when=(("auto color change",), True)),
    )


def _mix(first: Rgba, second: Rgba, share: float) -> Rgba:
    red, green, blue = (a + (b - a) * share for a, b in zip(first[:3], second[:3], strict=True))
    return red, green, blue, first[3]


_CHANGE_START = 0.6
"""The share of the range above which the color changes to that of the maximum."""


class _NumberDisplay(OverlayDisplay):
    """A base class of the gauge and the plot, with their place, caption and colors."""

    MESSAGE = _FLOAT

    def _start(self, width: float, height: float) -> Figure:
        """Return a figure with a background, and room for the caption."""
        number = self.properties.number
        background = read_color(self.properties.text("background color"), number("backround alpha"))
        figure = Figure(number("left"), number("top"), width, height + self._caption_height(), background=background)
        if self.properties.flag("show caption"):
            size = self._text_height()
            place, color = (width / 2, height + 0.2 * size), self._foreground()
            figure.add_text(self.config.name, *place, size, color, align="center")
        return figure

    def _text_height(self) -> float:
        return self.properties.number("text size") * POINTS_TO_PIXELS

    def _caption_height(self) -> float:
        return 1.5 * self._text_height() if self.properties.flag("show caption") else 0.0

    def _foreground(self, ratio: float = 0.0) -> Rgba:
        """Return the color of a value, as a share of the range."""
        text, number = self.properties.text, self.properties.number
        color = read_color(text("foreground color"), number("foreground alpha"))
        if not self.properties.flag("auto color change") or ratio <= _CHANGE_START:
            return color
        return _mix(color, read_color(text("max color")), (ratio - _CHANGE_START) / (1 - _CHANGE_START))


class PieChartDisplay(_NumberDisplay):
    """A display of a number as a ring that is filled by its share of a range."""

    CLASS = "rviz_2d_overlay_plugins/PieChartOverlay"
    SCHEMA: ClassVar[Schema] = (
        topic_spec(description=_FLOAT),
        _pixels("size", 128, "Width and height", 1),
        _pixels("left", 128, "Distance from the left edge"),
        _pixels("top", 128, "Distance from the upper edge"),
        *_color_specs(14),
        _opacity("foreground alpha 2", 0.4, "Opacity of the guide below the ring."),
        PropertySpec("max value", "float", 1.0, "The value that fills the ring."),
        PropertySpec("min value", "float", 0.0, "The value that leaves the ring empty."),
        PropertySpec("med color", "color", "#ff0000", "Color from its threshold on."),
        PropertySpec("max color change threthold", "float", 0.0, "Share of the range for max color; 0 for none."),
        PropertySpec("med color change threthold", "float", 0.0, "Share of the range for med color; 0 for none."),
        PropertySpec("clockwise rotate direction", "bool", False, "Fill the ring clockwise."),
    )

    def figure(self, message: Any) -> Figure | None:
        """Return the ring with the number in it."""
        number, value = self.properties.number, float(message.data)
        size, start, end = number("size"), number("min value"), number("max value")
        ratio = (value - start) / (end - start) if end != start and math.isfinite(value) else 0.0
        color = self._gauge_color(min(abs(ratio), 1.0))
        figure = self._start(size, size)
        center, turn = (size / 2, size / 2), 2 * math.pi
        radius = max(size / 2 - _RIM_PX - _GAP_PX - _RING_PX / 2, 1.0)
        figure.add_arc(center, max((size - _RIM_PX) / 2, 1.0), 0.0, turn, _RIM_PX, color)
        figure.add_arc(center, radius, 0.0, turn, _GUIDE_PX, (*color[:3], number("foreground alpha 2")))
        direction = -1.0 if self.properties.flag("clockwise rotate direction") else 1.0
        filled = direction * turn * min(max(ratio, -1.0), 1.0)
        if filled:
            figure.add_arc(center, radius, -math.pi / 2, filled, _RING_PX, color)
        height = self._text_height()
        figure.add_text(f"{value:.2f}", size / 2, (size - height) / 2, height, color, align="center")
        return figure

    def _gauge_color(self, ratio: float) -> Rgba:
        color = self._foreground(ratio)
        if not self.properties.flag("auto color change"):
            return color
        for name in ("med", "max"):
            threshold = self.properties.number(f"{name} color change threthold")
            if threshold and ratio > threshold:
                color = read_color(self.properties.text(f"{name} color"), color[3])
        return color


class JskPieChartDisplay(PieChartDisplay):
    """The same display, by the name of its older package."""

    CLASS = "jsk_rviz_plugin/PieChart"


class PlotterDisplay(_NumberDisplay):
    """A display of the last numbers of a topic as a line."""

    CLASS = "jsk_rviz_plugin/Plotter2D"
    SCHEMA: ClassVar[Schema] = (
        topic_spec(description=_FLOAT),
        PropertySpec("Show Value", "bool", True, "Write the last value."),
        PropertySpec("Buffer length", "int", 100, "The number of values that are kept.", minimum=2, maximum=100_000),
        _pixels("width", 128, "Width", 1),
        _pixels("height", 128, "Height", 1),
        _pixels("left", 128, "Distance from the left edge"),
        _pixels("top", 128, "Distance from the upper edge"),
        PropertySpec("auto scale", "bool", True, "Take the range of the values that are kept."),
        PropertySpec("max value", "float", 1.0, "The value at the upper edge.", when=(("auto scale",), False)),
        PropertySpec("min value", "float", -1.0, "The value at the lower edge.", when=(("auto scale",), False)),
        *_color_specs(12),
        PropertySpec("linewidth", "int", 1, "Width of the line, in pixels.", minimum=1),
        PropertySpec("border", "bool", True, "Draw a border around the plot."),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._values: deque[float] = deque()
        self._latest: Any = None

    def reset(self) -> None:
        """Discard the values."""
        self._values.clear()
        self._latest = None
        super().reset()

    def figure(self, message: Any) -> Figure | None:
        """Return the line, to which a new message adds a value."""
        if message is not self._latest:
            self._latest = message
            if math.isfinite(message.data):
                self._values.append(float(message.data))
        length = int(self.properties.number("Buffer length"))
        while len(self._values) > length:
            self._values.popleft()
        number = self.properties.number
        width, height = number("width"), number("height")
        figure = self._start(width, height)
        if self._values:
            self._add_line(figure, width, height, length)
        if self.properties.flag("border"):
            corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height), (0.0, 0.0)]
            figure.add_line(corners, 2 * number("linewidth"), self._foreground())
        return figure

    def _add_line(self, figure: Figure, width: float, height: float, length: int) -> None:
        number = self.properties.number
        start, end = number("min value"), number("max value")
        if self.properties.flag("auto scale"):
            start, end = min(self._values), max(self._values)
        shares = [(value - start) / (end - start) if end != start else 0.5 for value in self._values]
        last = min(max(shares[-1], 0.0), 1.0)
        first_x = width * (length - len(shares)) / (length - 1)
        step = width / (length - 1)
        line = [(first_x + step * i, height * (1 - min(max(share, 0.0), 1.0))) for i, share in enumerate(shares)]
        color = self._foreground(last)
        figure.add_line(line, number("linewidth"), color)
        if self.properties.flag("Show Value"):
            text_height = 2 * self._text_height()
            place = (width / 2, (height - text_height) / 2)
            figure.add_text(f"{self._values[-1]:.2f}", *place, text_height, color, align="center")


_METER_START_RAD, _METER_END_RAD = math.radians(40), math.radians(320)
_METER_LIMIT = 10.0
"""The acceleration at the ends of the meter, m/s²."""
_WHITE: Rgba = (1.0, 1.0, 1.0, 1.0)
_HAND_PX, _LINE_PX = 4, 2


class AccelerationMeterDisplay(OverlayDisplay):
    """A display of the acceleration along x as the hand of a meter."""

    CLASS = "rviz_plugins/AccelerationMeter"
    MESSAGE = "geometry_msgs/msg/AccelWithCovarianceStamped"
    SCHEMA: ClassVar[Schema] = (
        topic_spec(description=MESSAGE),
        PropertySpec("Text Color", "color", "#19fff0", "Color of the text."),
        PropertySpec("Emergency Color", "color", "#ff5050", "Color of the text beyond the thresholds."),
        _pixels("Left", 896, "Distance from the left edge"),
        _pixels("Top", 128, "Distance from the upper edge"),
        _pixels("Length", 256, "Width and height", 10),
        PropertySpec("Value height offset", "int", 0, "Distance by which the text is lower, in pixels."),
        PropertySpec("Max Emergency Threshold", "float", 1.0, "The largest normal acceleration.", minimum=0.01),
        PropertySpec("Min Emergency Threshold", "float", -2.5, "The smallest normal acceleration.", maximum=-0.01),
        PropertySpec("Value Scale", "float", 1 / 6.667, "Height of the text, relative to the width.", minimum=0.01),
    )

    def figure(self, message: Any) -> Figure | None:
        """Return the dial, the hand and the number."""
        number, value = self.properties.number, float(message.accel.accel.linear.x)
        length = number("Length")
        figure = Figure(number("Left"), number("Top"), length, length)
        center, radius = (length / 2, length / 2), length / 2 - _LINE_PX

        def place(angle: float, share: float) -> tuple[float, float]:
            """Return a place on a ray; the angle is clockwise from below."""
            return center[0] - share * radius * math.sin(angle), center[1] + share * radius * math.cos(angle)

        for share in (1.0, 0.25):
            start, turn = -math.pi / 2 - _METER_START_RAD, _METER_START_RAD - _METER_END_RAD
            figure.add_arc(center, share * radius, start, turn, _LINE_PX, _WHITE)
        for angle in (_METER_START_RAD, _METER_END_RAD):
            figure.add_line([place(angle, 0.25), place(angle, 1.0)], _LINE_PX, _WHITE)
        ratio = (min(max(value, -_METER_LIMIT), _METER_LIMIT) + _METER_LIMIT) / (2 * _METER_LIMIT)
        if math.isfinite(value):
            angle = _METER_START_RAD + ratio * (_METER_END_RAD - _METER_START_RAD)
            figure.add_line([center, place(angle, 1.0)], _HAND_PX, _WHITE)
        is_normal = number("Min Emergency Threshold") <= value <= number("Max Emergency Threshold")
        color = read_color(self.properties.text("Text Color" if is_normal else "Emergency Color"))
        height = max(1.0, length * number("Value Scale"))
        y = (length - height + number("Value height offset")) / 2
        figure.add_text(f"{value:.2f}m/s^2", length / 2, y, height, color, align="center")
        return figure
