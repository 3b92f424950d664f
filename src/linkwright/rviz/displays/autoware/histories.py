"""The displays of Autoware's past poses, as lines."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import Any, ClassVar

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.graph import QoSProfile
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, Schema, alpha, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost
from linkwright.rviz.displays.base.topic_display import SideTopic
from linkwright.rviz.displays.marker import MessageMarkersDisplay
from linkwright.rviz.displays.message_drawing import Marker, make_marker, read_color

_BUFFER, _LINE = "Buffer Size", "Line"
_PATH, _AUTO, _VALUE_TOPIC, _VALUE_TYPE = "Path", "Auto Set Min/Max", "Value Topic", "Value Type"
_COLOR_NAMES = ("Min Color", "Max Color", "Less Color", "Greater Color")
_VALUE_QOS = QoSProfile(depth=10)


def _width_spec() -> PropertySpec:
    return PropertySpec("Width", "float", 0.1, "Width of the line, in meters.", minimum=0.0)


class PoseHistoryDisplay(MessageMarkersDisplay):
    """A display of the last poses of a topic as a line. A pose in another frame starts a new line."""

    CLASS = "rviz_plugins::PoseHistory"
    MESSAGE = "geometry_msgs/msg/PoseStamped"
    SCHEMA: ClassVar[Schema] = (
        topic_spec(description=MESSAGE),
        PropertySpec(_BUFFER, "int", 100, "The number of poses that are kept.", minimum=0, maximum=16000),
        PropertySpec(
            _LINE,
            "bool",
            True,
            "Draw the line.",
            children=(
                _width_spec(),
                alpha("Opacity of the line."),
                PropertySpec("Color", "color", "#ffffff", "Color of the line."),
            ),
        ),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._positions: deque[tuple[float, float, float]] = deque()
        self._values: deque[float] = deque()
        self._last_value = 0.0
        self._frame = ""
        self._latest: Any = None

    def reset(self) -> None:
        """Discard the line."""
        self._positions.clear()
        self._values.clear()
        self._latest = None
        super().reset()

    def markers(self, message: Any) -> Iterator[Any]:
        """Return the line of the last poses, which the message continues if it is new."""
        if message is not self._latest:
            self._latest = message
            self._append(message)
        self._shorten()
        if len(self._positions) > 1 and self.properties.flag(self._line_name()):
            yield self.line(np.array(self._positions))

    def line(self, positions: Array) -> Any:
        """Return the marker of the line."""
        opacity = self.properties.number(_LINE, "Alpha")
        color = read_color(self.properties.text(_LINE, "Color"), opacity)
        scale = (self.properties.number(_LINE, "Width"), 0, 0)
        return make_marker("history", 0, Marker.LINE_STRIP, color, scale=scale, points=positions)

    def pose_of(self, message: Any) -> Any:
        """Return the geometry_msgs/msg/Pose of a message."""
        return message.pose

    def _line_name(self) -> str:
        return _LINE

    def _append(self, message: Any) -> None:
        position = self.pose_of(message).position
        coordinates = (position.x, position.y, position.z)
        if not self.is_finite(coordinates):
            return
        if self._frame != message.header.frame_id:
            self._frame = message.header.frame_id
            self._positions.clear()
            self._values.clear()
        self._positions.append(coordinates)
        self._values.append(self._last_value)

    def _shorten(self) -> None:
        length = int(self.properties.number(_BUFFER))
        while len(self._positions) > length:
            self._positions.popleft()
            self._values.popleft()


class PoseWithCovarianceHistoryDisplay(PoseHistoryDisplay):
    """A display of the last poses with covariance of a topic, colored by the value of another topic."""

    CLASS = "rviz_plugins::ColoredPoseWithCovarianceHistory"
    MESSAGE = "geometry_msgs/msg/PoseWithCovarianceStamped"
    SCHEMA = (
        topic_spec(description=MESSAGE),
        PropertySpec(_VALUE_TYPE, "enum", "Float32", "The type of the values' messages.", options=("Int32", "Float32")),
        PropertySpec(
            _VALUE_TOPIC,
            "topic",
            "",
            "The topic of the values.",
            messages=tuple(f"autoware_internal_debug_msgs/msg/{name}Stamped" for name in ("Float32", "Int32")),
        ),
        PropertySpec(_BUFFER, "int", 100, "The number of poses that are kept.", minimum=0, maximum=100000),
        PropertySpec(
            _PATH,
            "bool",
            True,
            "Draw the line.",
            children=(
                _width_spec(),
                alpha("Opacity of the line."),
                PropertySpec("Min Color", "color", "#0000ff", "Color of the minimum."),
                PropertySpec("Max Color", "color", "#ff0000", "Color of the maximum."),
                PropertySpec("Less Color", "color", "#0000ff", "Color of values below the minimum."),
                PropertySpec("Greater Color", "color", "#ff0000", "Color of values above the maximum."),
            ),
        ),
        PropertySpec(
            _AUTO,
            "bool",
            True,
            "Take the minimum and the maximum of the line.",
            children=(
                PropertySpec("Min Value", "float", 0.0, "The value of Min Color."),
                PropertySpec("Max Value", "float", 1.0, "The value of Max Color."),
            ),
        ),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._side: SideTopic | None = None

    def start(self) -> None:
        """Subscribe to the poses and to the values."""
        super().start()
        self._listen_to_values()

    def stop(self) -> None:
        """Unsubscribe."""
        self._close_values()
        super().stop()

    def on_enabled_changed(self) -> None:
        """Subscribe or unsubscribe."""
        super().on_enabled_changed()
        self._listen_to_values()

    def on_property_changed(self, path: Path) -> None:
        """Subscribe to other values, or draw the line again."""
        super().on_property_changed(path)
        if path in ((_VALUE_TOPIC,), (_VALUE_TYPE,)):
            self._listen_to_values()

    def on_time_changed(self) -> None:
        """Take the values that were queued while time was paused, before the poses."""
        if self._side is not None:
            self._side.resume()
        super().on_time_changed()

    def pose_of(self, message: Any) -> Any:
        """Return the geometry_msgs/msg/Pose of a message."""
        return message.pose.pose

    def line(self, positions: Array) -> Any:
        """Return the marker of the line, with a color for each value."""
        opacity = self.properties.number(_PATH, "Alpha")
        lowest, highest, less, greater = (
            np.array(read_color(self.properties.text(_PATH, name), opacity)) for name in _COLOR_NAMES
        )
        values = np.array(self._values)
        start, end = (self.properties.number(_AUTO, f"{name} Value") for name in ("Min", "Max"))
        if self.properties.flag(_AUTO):
            start, end = float(values.min()), float(values.max())
        ratios = (values - start) / (end - start) if end != start else np.zeros(len(values))
        colors = lowest + np.clip(ratios, 0, 1)[:, None] * (highest - lowest)
        colors[values < start] = less
        colors[values > end] = greater
        scale = (self.properties.number(_PATH, "Width"), 0, 0)
        color = (1.0, 1.0, 1.0, opacity)
        return make_marker("history", 0, Marker.LINE_STRIP, color, scale=scale, points=positions, colors=colors)

    def _line_name(self) -> str:
        return _PATH

    def _listen_to_values(self) -> None:
        self._close_values()
        if not self.enabled:
            return
        topic = self.properties.text(_VALUE_TOPIC).strip()
        if not topic:
            self.set_status_row(_VALUE_TOPIC, "error", phrase("Error subscribing: Empty topic name"))
            return
        message = f"autoware_internal_debug_msgs/msg/{self.properties.text(_VALUE_TYPE)}Stamped"
        self._side = SideTopic(self.host, message, self._on_value)
        problem = self._side.listen(topic, _VALUE_QOS)
        self.set_status_row(_VALUE_TOPIC, "error" if problem else "ok", problem or phrase("OK"))

    def _close_values(self) -> None:
        if self._side is not None:
            self._side.close()
            self._side = None

    def _on_value(self, message: Any) -> None:
        self._last_value = float(message.data)
