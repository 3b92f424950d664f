"""Displays for the 3D detections and bounding boxes of vision_msgs."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from typing import Any

import numpy as np

from linkwright.diagnostics import foreign
from linkwright.page.protocol.detections import SolidBoxes
from linkwright.page.protocol.message import DataContent
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, Schema, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.base.topic_display import RecentDisplay
from linkwright.rviz.displays.class_colors import Color, choose_class_color, read_class_colors

ONLY_EDGE, CONFIG_PATH, LIFETIME = "Only Edge", "ConfigPath", "Lifetime"

_BOX_PROPERTIES: Schema = (
    PropertySpec(ONLY_EDGE, "bool", False, "Draw only the edges of the boxes."),
    PropertySpec(
        "Line Width",
        "float",
        0.05,
        "Width of the edges, in meters.",
        minimum=0.01,
        maximum=0.1,
        when=((ONLY_EDGE,), True),
    ),
    PropertySpec("Alpha", "float", 1.0, "Opacity of the boxes.", minimum=0.1, maximum=1.0),
)
_COLOR_PROPERTY = PropertySpec("Color", "color", "#ffff00", "Color of the boxes.")
CLASS_COLORS = PropertySpec(
    CONFIG_PATH, "string", "", "A YAML file with colors of classes, such as 'ball: {r: 255, g: 0, b: 0}'."
)
_CLASS_PROPERTIES: Schema = (
    PropertySpec("Show Score", "bool", False, "Write class and score above each box."),
    CLASS_COLORS,
    PropertySpec(
        LIFETIME, "int", 0, "How many seconds a message is shown; 0 shows it until the next message.", minimum=0
    ),
)


class _BoxDisplay(RecentDisplay):
    """The base class of displays that show the boxes of the last message."""

    def _make_content(
        self, boxes: Sequence[Any], colors: Sequence[Color], scores: Sequence[float], names: Sequence[str]
    ) -> DataContent | None:
        poses = np.array([_pose_to_values(box.center) for box in boxes], dtype=np.float32).reshape(-1, 7)
        sizes = np.array([(box.size.x, box.size.y, box.size.z) for box in boxes], dtype=np.float32).reshape(-1, 3)
        if not self.is_finite(poses, sizes):
            return None
        color_array = np.array(colors, dtype=np.uint8).reshape(-1, 3)
        return SolidBoxes(poses, sizes, color_array, np.array(scores, dtype=np.float32), list(names))


def _pose_to_values(pose: Any) -> tuple[float, ...]:
    """Return a pose message as x y z qx qy qz qw.

    A zero quaternion, the default in messages, becomes the identity rotation.
    """
    position, orientation = pose.position, pose.orientation
    w = orientation.w if any((orientation.x, orientation.y, orientation.z, orientation.w)) else 1.0
    return (position.x, position.y, position.z, orientation.x, orientation.y, orientation.z, w)


class BoundingBox3DArrayDisplay(_BoxDisplay):
    """A display of boxes in one color."""

    CLASS = "vision_msgs_rviz_plugins/BoundingBox3DArray"
    MESSAGE = "vision_msgs/msg/BoundingBox3DArray"
    SCHEMA = (topic_spec(description=MESSAGE, filter_size=10), *_BOX_PROPERTIES, _COLOR_PROPERTY)

    def content(self, message: Any) -> DataContent | None:
        """Return the boxes of a message, all in white.

        Pages replace white with the color of the property.
        """
        boxes = self.boxes_of(message)
        return self._make_content(boxes, [(255, 255, 255)] * len(boxes), [-1.0] * len(boxes), [""] * len(boxes))

    def boxes_of(self, message: Any) -> Sequence[Any]:
        """Return the vision_msgs/msg/BoundingBox3D messages that a message contains."""
        return list(message.boxes)


class BoundingBox3DDisplay(BoundingBox3DArrayDisplay):
    """A display of a single box, placed in the Fixed Frame because the message has no header."""

    CLASS = "vision_msgs_rviz_plugins/BoundingBox3D"
    MESSAGE = "vision_msgs/msg/BoundingBox3D"
    SCHEMA = (topic_spec(description=MESSAGE, filter_size=10), *_BOX_PROPERTIES, _COLOR_PROPERTY)

    def frame_of(self, message: Any) -> tuple[str, int]:
        """Return the Fixed Frame, and 0 for the latest time."""
        return self.host.frames.fixed_frame, 0

    def boxes_of(self, message: Any) -> Sequence[Any]:
        """Return the single box of the message."""
        return [message]


def find_best_result(detection: Any) -> tuple[str, float]:
    """Return the class and score of the most likely hypothesis of a Detection2D or Detection3D.

    If there are no hypotheses, return an empty class and a score of -1.
    """
    best_hypothesis = max(
        (result.hypothesis for result in detection.results), key=lambda hypothesis: hypothesis.score, default=None
    )
    return ("", -1.0) if best_hypothesis is None else (best_hypothesis.class_id, best_hypothesis.score)


class Detection3DArrayDisplay(_BoxDisplay):
    """A display of detections as boxes in the colors of their classes."""

    CLASS = "vision_msgs_rviz_plugins/Detection3DArray"
    MESSAGE = "vision_msgs/msg/Detection3DArray"
    SCHEMA = (topic_spec(description=MESSAGE, filter_size=10), *_BOX_PROPERTIES, *_CLASS_PROPERTIES)

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._table: dict[str, Color] = {}
        self._end_timer: asyncio.TimerHandle | None = None

    def start(self) -> None:
        """Read the class colors, and subscribe."""
        self._read_colors()
        super().start()

    def stop(self) -> None:
        """Unsubscribe, and cancel the timer that hides the boxes."""
        self._cancel_expiry()
        super().stop()

    def on_property_changed(self, path: Path) -> None:
        """Apply new colors or a new lifetime."""
        super().on_property_changed(path)
        if path == (CONFIG_PATH,):
            self._read_colors()
        if path in ((CONFIG_PATH,), (LIFETIME,)):
            self.show_again()

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Show the boxes until the next message.

        If ``Lifetime`` is set, they are hidden after this number of seconds.
        """
        super().process_message(message, pose)
        self._cancel_expiry()
        seconds = int(self.properties.number(LIFETIME))
        if seconds:
            self._end_timer = asyncio.get_running_loop().call_later(seconds, self.reset)

    def reset(self) -> None:
        """Discard the boxes."""
        self._cancel_expiry()
        super().reset()

    def content(self, message: Any) -> DataContent | None:
        """Return the boxes of the detections in a message, with the colors of their classes."""
        detections = self.detections_of(message)
        results = [find_best_result(detection) for detection in detections]
        colors = [choose_class_color(name, self._table) for name, _ in results]
        boxes = [detection.bbox for detection in detections]
        return self._make_content(boxes, colors, [score for _, score in results], [name for name, _ in results])

    def detections_of(self, message: Any) -> Sequence[Any]:
        """Return the vision_msgs/msg/Detection3D messages that a message contains."""
        return list(message.detections)

    def _read_colors(self) -> None:
        path = self.properties.text(CONFIG_PATH).strip()
        self._table = {}
        self.delete_status_row(CONFIG_PATH)
        if path:
            try:
                self._table = read_class_colors(path)
            except ValueError as error:
                self.set_status_row(CONFIG_PATH, "error", foreign(error))

    def _cancel_expiry(self) -> None:
        if self._end_timer is not None:
            self._end_timer.cancel()
            self._end_timer = None


class Detection3DDisplay(Detection3DArrayDisplay):
    """A display of a single detection."""

    CLASS = "vision_msgs_rviz_plugins/Detection3D"
    MESSAGE = "vision_msgs/msg/Detection3D"
    SCHEMA = (topic_spec(description=MESSAGE, filter_size=10), *_BOX_PROPERTIES, *_CLASS_PROPERTIES)

    def detections_of(self, message: Any) -> Sequence[Any]:
        """Return the single detection of the message."""
        return [message]
