"""The displays of rtabmap's graph and of its statistics."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from linkwright.diagnostics import foreign, phrase
from linkwright.geometry.single import rpy_from_quaternion
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import PropertySpec, Schema, alpha, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.base.topic_display import TopicDisplay
from linkwright.rviz.displays.message_drawing import Marker, list_positions, make_marker, read_color
from linkwright.rviz.displays.placed_markers import PlacedMarkersDisplay

_LINE_WIDTH = 0.02

_GLOBAL = "Global loop closure"
_COLORS: dict[str, tuple[str, str]] = {
    "Neighbor": ("#0000ff", "neighbor links"),
    "Merged neighbor": ("#ffaa00", "merged neighbor links"),
    _GLOBAL: ("#ff0000", "global loop closure links"),
    "Local loop closure": ("#ffff00", "local loop closure links"),
    "Landmark": ("#008000", "landmark links"),
    "User": ("#ff0000", "user links"),
    "Virtual": ("#ff00ff", "virtual links"),
}
"""The properties with the colors of links, each with its default and the links' name."""

_PROPERTY_BY_LINK_TYPE = {
    0: "Neighbor",
    2: "Local loop closure",
    3: "Local loop closure",
    4: "User",
    5: "Virtual",
    6: "Merged neighbor",
    8: "Landmark",
}
"""The property with the color of each type of link; other types have the color of a global loop closure."""


class MapGraphDisplay(PlacedMarkersDisplay):
    """A display of the links between the nodes of a map."""

    CLASS = "rtabmap_rviz_plugins/MapGraph"
    MESSAGE = "rtabmap_msgs/msg/MapGraph"
    SCHEMA: ClassVar[Schema] = (
        topic_spec(description=MESSAGE, filter_size=10),
        *(PropertySpec(name, "color", color, f"Color of {links}.") for name, (color, links) in _COLORS.items()),
        alpha("Opacity of the lines."),
    )

    def markers(self, message: Any) -> list[Any]:
        """Return lines between the poses of linked nodes, in one marker for each color."""
        positions = list_positions([pose.position for pose in message.poses])
        if len(message.poses_id) != len(positions):
            self.set_status_row("Message", "error", phrase("The message does not have one pose for each ID of a node"))
            return []
        if not self.is_finite(positions):
            return []
        index_by_id = {int(node): index for index, node in enumerate(message.poses_id)}
        ends: dict[str, list[int]] = {}
        for link in message.links:
            first, last = index_by_id.get(link.from_id), index_by_id.get(link.to_id)
            if first is not None and last is not None:
                ends.setdefault(_PROPERTY_BY_LINK_TYPE.get(link.type, _GLOBAL), []).extend((first, last))
        opacity = self.properties.number("Alpha")
        return [
            make_marker(
                name,
                0,
                Marker.LINE_LIST,
                read_color(self.properties.text(name), opacity),
                scale=(_LINE_WIDTH, 0.0, 0.0),
                points=positions[np.asarray(indices)],
            )
            for name, indices in ends.items()
        ]


_LOOPS, _PROXIMITIES = "Loop closures", "Proximity detections"


class InfoDisplay(TopicDisplay):
    """A display of rtabmap's statistics, which are rows of its status."""

    CLASS = "rtabmap_rviz_plugins/Info"
    DRAWN_AS = "rviz_default_plugins/MarkerArray"  # the page draws nothing, because nothing is sent
    MESSAGE = "rtabmap_msgs/msg/Info"
    TRANSFORMED = False
    SCHEMA: ClassVar[Schema] = (topic_spec(description=MESSAGE),)

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._counts = {_LOOPS: 0, _PROXIMITIES: 0}
        self._row_names: set[str] = set()

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Show the last loop closure, the number of loop closures, and all statistics."""
        info = ""
        if message.loop_closure_id:
            info = f"{message.ref_id}->{message.loop_closure_id}"
            self._counts[_LOOPS] += 1
        elif message.proximity_detection_id:
            info = f"{message.ref_id}->{message.proximity_detection_id} [Proximity]"
            self._counts[_PROXIMITIES] += 1
        position, orientation = message.loop_closure_transform.translation, message.loop_closure_transform.rotation
        quaternion = (orientation.x, orientation.y, orientation.z, orientation.w)
        is_known = bool(info) and any(quaternion)
        rows = {
            "Info": info,
            "Position (XYZ)": _join(position.x, position.y, position.z) if is_known else "",
            "Orientation (RPY)": _join(*rpy_from_quaternion(quaternion)) if is_known else "",
            **{name: str(count) for name, count in self._counts.items()},
            **{
                name: f"{value:g}"
                for name, value in sorted(zip(message.stats_keys, message.stats_values, strict=False))
            },
        }
        for name in self._row_names - rows.keys():
            self.delete_status_row(name)
        for name, text in rows.items():
            self.set_status_row(name, "ok", foreign(text))
        self._row_names = set(rows)

    def reset(self) -> None:
        """Forget the counts, and remove the rows."""
        self._counts = dict.fromkeys(self._counts, 0)
        for name in self._row_names:
            self.delete_status_row(name)
        self._row_names.clear()
        super().reset()


def _join(*numbers: float) -> str:
    return ";".join(f"{number:g}" for number in numbers)
