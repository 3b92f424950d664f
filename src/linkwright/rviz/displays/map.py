"""The display rviz_default_plugins/Map."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Phrase, phrase
from linkwright.page.protocol.configuration import PropertyChanged
from linkwright.page.protocol.images import OccupancyMap
from linkwright.rviz.config.property_store import qos_from_properties
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, Schema, alpha, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.base.topic_display import TOPIC, TRANSFORM, SideTopic, TopicDisplay

_UPDATE_PERIOD_S = 0.1
"""The minimum time in seconds between two maps that are sent because of updates."""

_UPDATE_TOPIC = "Update Topic"
_USE_TIMESTAMP = "Use Timestamp"
_BINARY = "Binary representation"


def _read_only_vector(name: str, axes: str, description: str) -> PropertySpec:
    components = tuple(PropertySpec(axis, "float", 1.0 if axis == "W" else 0.0, read_only=True) for axis in axes)
    return PropertySpec(name, "group", description=description, children=components)


_SCHEMA: Schema = (
    topic_spec(description="nav_msgs/msg/OccupancyGrid", filter_size=10),
    topic_spec(
        _UPDATE_TOPIC,
        description="map_msgs/msg/OccupancyGridUpdate: the topic with updates to parts of the map. The "
        "default is the map's topic with the suffix '_updates'.",
        messages=("map_msgs/msg/OccupancyGridUpdate",),
    ),
    alpha("Opacity of the map: 0 is invisible.", 0.7),
    PropertySpec(
        "Color Scheme", "enum", "map", "The colors for the values of the cells.", options=("map", "costmap", "raw")
    ),
    PropertySpec("Draw Behind", "bool", False, "Draw the map behind everything else, wherever it is."),
    PropertySpec("Resolution", "float", 0.0, "Side of a cell, in meters.", read_only=True),
    PropertySpec("Width", "int", 0, "Cells along x.", read_only=True),
    PropertySpec("Height", "int", 0, "Cells along y.", read_only=True),
    _read_only_vector("Position", "XYZ", "The position of the lower left corner in the map's frame, in meters."),
    _read_only_vector("Orientation", "XYZW", "The rotation of the map in its frame."),
    PropertySpec(
        _USE_TIMESTAMP,
        "bool",
        False,
        "Place the map at the pose of its frame at the map's time, not at the current pose.",
    ),
    PropertySpec(_BINARY, "bool", False, "Show only free and occupied cells."),
    PropertySpec(
        "Binary threshold",
        "int",
        100,
        "The minimum value of an occupied cell.",
        minimum=0,
        maximum=100,
    ),
)


class MapDisplay(TopicDisplay):
    """A display of an occupancy grid with partial updates.

    By default the map follows its frame. With ``Use Timestamp``, the map stays at the pose that its frame had at the
    map's stamp.
    """

    CLASS = "rviz_default_plugins/Map"
    MESSAGE = "nav_msgs/msg/OccupancyGrid"
    SCHEMA = _SCHEMA

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._updates = SideTopic(host, "map_msgs/msg/OccupancyGridUpdate", self._on_update)
        self._map: Any = None
        self._cells: NDArray[np.uint8] = np.empty((0, 0), np.uint8)
        self._owns_cells = False  # False while other displays may share the cells
        self._pose: Pose | None = None
        self._last_send_time = 0.0
        self._send_timer: asyncio.TimerHandle | None = None
        self._derive_update_topic(replace_in_file=False)

    def frame_of(self, message: Any) -> tuple[str, int]:
        """Return the map's frame, by default ``map``, and the time of the frame's pose in ns.

        Without ``Use Timestamp`` the time is 0, the latest transform.
        """
        frame, stamp_ns = super().frame_of(message)
        return frame or "map", stamp_ns if self.properties.flag(_USE_TIMESTAMP) else 0

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Show a map.

        If it is the current map, the updates applied to it are preserved.
        """
        self._pose = pose
        if message is not self._map and not self._accept_map(message):
            return
        self._send()

    def on_property_changed(self, path: Path) -> None:
        """Subscribe to another topic or to other updates, or apply the timestamp setting."""
        if path == (TOPIC,):
            self._derive_update_topic(replace_in_file=True)
            self.pages.publish(PropertyChanged(self.property_id((_UPDATE_TOPIC,)), self.properties.text(_UPDATE_TOPIC)))
        super().on_property_changed(path)
        if path[0] == _UPDATE_TOPIC:
            self._restart()
        elif path == (_USE_TIMESTAMP,):
            self.show_again()

    def on_properties_restored(self) -> None:
        """Derive the update topic from the map's topic if the file does not contain one."""
        super().on_properties_restored()
        self._derive_update_topic(replace_in_file=False)

    def on_frames_changed(self) -> None:
        """Place the map in a new Fixed Frame, and show whether the map's pose is known."""
        super().on_frames_changed()
        if self._map is None or self.properties.flag(_USE_TIMESTAMP):
            return
        frame = self.frame_of(self._map)[0].removeprefix("/")
        problem = self.host.frames.find_problem(frame)
        self.set_status_row(TRANSFORM, "error" if problem else "ok", problem or phrase("Transform OK"))

    def on_time_changed(self) -> None:
        """Show the map and the updates that were queued while time was paused."""
        super().on_time_changed()
        self._updates.resume()

    def reset(self) -> None:
        """Remove the map from the pages.

        If the topic has changed, the map itself is also discarded.
        """
        if self._send_timer is not None:
            self._send_timer.cancel()
            self._send_timer = None
        if self.last_message is None:
            self._map = None
        super().reset()

    def stop(self) -> None:
        """Unsubscribe, and cancel a scheduled update of the pages."""
        super().stop()
        if self._send_timer is not None:
            self._send_timer.cancel()
            self._send_timer = None

    def _derive_update_topic(self, *, replace_in_file: bool) -> None:
        """Derive the update topic from the map's topic, as RViz does.

        If the file contains an update topic, it is replaced only if `replace_in_file` is true. If the file contains
        none, the derived topic is not written to the file.
        """
        topic = self.properties.text(TOPIC).strip()
        update_topic = f"{topic}_updates" if topic else ""
        if self.config.section.text(_UPDATE_TOPIC) is None:
            self.properties.set_read_only((_UPDATE_TOPIC,), update_topic)
        elif replace_in_file:
            self.properties.set((_UPDATE_TOPIC,), update_topic)

    def _subscribe(self) -> None:
        super()._subscribe()
        topic = self.properties.text(TOPIC).strip()
        if not topic:
            return
        self.set_status_row("Message", "warn", phrase("No map received"))
        update_topic = self.properties.text(_UPDATE_TOPIC).strip() or f"{topic}_updates"
        problem = self._updates.listen(update_topic, qos_from_properties(self.properties, _UPDATE_TOPIC))
        self.set_status_row("Update Topic", "error" if problem else "ok", problem or phrase("OK"))

    def _unsubscribe(self) -> None:
        super()._unsubscribe()
        self._updates.close()

    # --- maps --------------------------------------------------------------------------------------------------

    def _accept_map(self, message: Any) -> bool:
        info = message.info
        cells = np.frombuffer(message.data, np.uint8)
        origin = _pose_to_values(info.origin)
        if not np.isfinite([info.resolution, *origin]).all():
            self.set_status_row(
                "Map", "error", phrase("Message contained invalid floating point values (nans or infs)")
            )
        elif info.width * info.height == 0:
            self.set_status_row(
                "Map", "error", phrase("Map is zero-sized ({width}x{height})", width=info.width, height=info.height)
            )
        elif info.width * info.height != cells.size:
            self.set_status_row("Map", "error", _describe_size_mismatch(info, cells))
        else:
            self._map = message
            self._cells, self._owns_cells = cells.reshape(info.height, info.width), False
            self.set_status_row("Message", "ok", phrase("Map received"))
            self.set_status_row("Map", "ok", phrase("Map OK"))
            self._publish_read_only_values(message)
            return True
        return False

    def _publish_read_only_values(self, message: Any) -> None:
        for path, value in _iterate_read_only_values(message.info):
            if self.properties.set_read_only(path, value):
                self.pages.publish(PropertyChanged(self.property_id(path), value))

    def _on_update(self, update: Any) -> None:
        if self._map is None:
            return
        info = self._map.info
        cells = np.frombuffer(update.data, np.uint8)
        right, top = update.x + update.width, update.y + update.height
        if update.x < 0 or update.y < 0 or right > info.width or top > info.height:
            self.set_status_row("Update", "error", phrase("Update area outside of original map area."))
            return
        if cells.size != update.width * update.height:
            self.set_status_row("Update", "error", _describe_size_mismatch(update, cells))
            return
        if not self._owns_cells:
            self._cells, self._owns_cells = self._cells.copy(), True
        self._cells[update.y : top, update.x : right] = cells.reshape(update.height, update.width)
        self.set_status_row("Update", "ok", phrase("Update OK"))
        self._schedule_send()

    def _schedule_send(self) -> None:
        """Schedule sending the map, so that several updates are sent as one map."""
        if self._send_timer is None:
            delay = max(0.0, self._last_send_time + _UPDATE_PERIOD_S - time.monotonic())
            self._send_timer = asyncio.get_running_loop().call_later(delay, self._send_updated)

    def _send_updated(self) -> None:
        self._send_timer = None
        self._send()

    def _send(self) -> None:
        info = self._map.info
        frame, stamp_ns = self.frame_of(self._map)
        use_timestamp = self.properties.flag(_USE_TIMESTAMP)
        content = OccupancyMap(
            width=info.width,
            height=info.height,
            resolution=float(info.resolution),
            origin=_pose_to_values(info.origin),
            cells=self._cells,
        )
        self._last_send_time = time.monotonic()
        self.send(content, frame=frame.removeprefix("/"), pose=self._pose if use_timestamp else None, stamp_ns=stamp_ns)


def _describe_size_mismatch(grid: Any, cells: NDArray[np.uint8]) -> Phrase:
    """Return the status text for a map or update whose size does not match its number of cells.

    `grid` is a MapMetaData or an update.
    """
    return phrase(
        "Data size doesn't match width*height: width = {width}, height = {height}, data size = {size}",
        width=grid.width,
        height=grid.height,
        size=cells.size,
    )


def _pose_to_values(origin: Any) -> list[float]:
    """Return a pose message as x y z qx qy qz qw.

    A zero quaternion becomes the identity rotation.
    """
    position, orientation = origin.position, origin.orientation
    quaternion = [orientation.x, orientation.y, orientation.z, orientation.w]
    return [position.x, position.y, position.z, *(quaternion if any(quaternion) else [0.0, 0.0, 0.0, 1.0])]


def _iterate_read_only_values(info: Any) -> Iterator[tuple[Path, float | int]]:
    """Yield the path and value of each read-only property, from a nav_msgs/msg/MapMetaData."""
    yield ("Resolution",), float(info.resolution)
    yield ("Width",), info.width
    yield ("Height",), info.height
    for name, vector, axes in (
        ("Position", info.origin.position, "xyz"),
        ("Orientation", info.origin.orientation, "xyzw"),
    ):
        for axis in axes:
            yield (name, axis.upper()), float(getattr(vector, axis))
