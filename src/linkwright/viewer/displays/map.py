"""rviz_default_plugins/Map."""

from __future__ import annotations

import asyncio
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.viewer.displays.base import Stage
from linkwright.viewer.displays.data_display import Pose
from linkwright.viewer.displays.map_properties import MAP_SCHEMA, UPDATE_TOPIC, USE_TIMESTAMP, readings
from linkwright.viewer.displays.side_topic import SideTopic
from linkwright.viewer.displays.topic_display import TOPIC, TRANSFORM, TopicDisplay
from linkwright.viewer.displays.topic_properties import qos_of
from linkwright.viewer.property_store import Path
from linkwright.viewer.protocol import OccupancyMap, PropertyChanged
from linkwright.viewer.rviz_config import DisplayConfig

_UPDATE_PERIOD = 0.1
"""Seconds between two maps that updates have pages sent."""


class MapDisplay(TopicDisplay):
    """An occupancy grid, with updates of parts of it.

    It goes where its frame goes, or stays where that was at the map's time when the timestamp is used.
    """

    CLASS = "rviz_default_plugins/Map"
    MESSAGE = "nav_msgs/msg/OccupancyGrid"
    SCHEMA = MAP_SCHEMA

    def __init__(self, stage: Stage, identity: str, config: DisplayConfig) -> None:
        super().__init__(stage, identity, config)
        self._updates = SideTopic(stage, "map_msgs/msg/OccupancyGridUpdate", self._updated)
        self._map: Any = None
        self._cells: NDArray[np.uint8] = np.empty((0, 0), np.uint8)
        self._is_own = False  # else the cells are the message's, which others have too
        self._pose: Pose | None = None
        self._sent_at = 0.0
        self._sending: asyncio.TimerHandle | None = None
        self._follow_topic(file_too=False)

    def frame_of(self, message: Any) -> tuple[str, int]:
        """The map's frame, ``map`` where it names none; the latest time unless the timestamp is to be used."""
        frame, stamp_ns = super().frame_of(message)
        return frame or "map", stamp_ns if self.properties.flag(USE_TIMESTAMP) else 0

    def take(self, message: Any, pose: Pose | None) -> None:
        """Show a map; one that was updated meanwhile stays as it is."""
        self._pose = pose
        if message is not self._map and not self._load(message):
            return
        self._send()

    def changed(self, path: Path) -> None:
        """Follow another topic, other updates, or the timestamp."""
        if path == (TOPIC,):
            self._follow_topic(file_too=True)
            self.stage.publish(PropertyChanged(self.property_id((UPDATE_TOPIC,)), self.properties.text(UPDATE_TOPIC)))
        super().changed(path)
        if path[0] == UPDATE_TOPIC:
            self._restart()
        elif path == (USE_TIMESTAMP,):
            self.show_again()

    def recalled(self) -> None:
        """Updates of which the file says nothing again come from beside the topic."""
        super().recalled()
        self._follow_topic(file_too=False)

    def frames_changed(self) -> None:
        """Say whether the map can be placed now."""
        super().frames_changed()
        if self._map is None or self.properties.flag(USE_TIMESTAMP):
            return
        frame = self.frame_of(self._map)[0].removeprefix("/")
        problem = self.stage.frames.problem(frame)
        self.say(TRANSFORM, "error" if problem else "ok", problem or "Transform OK")

    def time_changed(self) -> None:
        """Show the map and the updates that came while time stood still."""
        super().time_changed()
        self._updates.go_on()

    def reset(self) -> None:
        """Draw nothing; a map whose topic was left is forgotten."""
        if self._sending is not None:
            self._sending.cancel()
            self._sending = None
        if self.last is None:
            self._map = None
        super().reset()

    def stop(self) -> None:
        """Listen no more."""
        super().stop()
        if self._sending is not None:
            self._sending.cancel()
            self._sending = None

    def _follow_topic(self, *, file_too: bool) -> None:
        """Have the updates come from beside the topic, as RViz does; a file that names no topic of theirs gets none."""
        topic = self.properties.text(TOPIC).strip()
        updates = f"{topic}_updates" if topic else ""
        if self.config.section.text(UPDATE_TOPIC) is None:
            self.properties.tell((UPDATE_TOPIC,), updates)
        elif file_too:
            self.properties.set((UPDATE_TOPIC,), updates)

    def _subscribe(self) -> None:
        super()._subscribe()
        topic = self.properties.text(TOPIC).strip()
        if not topic:
            return
        self.say("Message", "warn", "No map received")
        updates = self.properties.text(UPDATE_TOPIC).strip() or f"{topic}_updates"
        problem = self._updates.listen(updates, qos_of(self.properties, UPDATE_TOPIC))
        self.say("Update Topic", "error" if problem else "ok", problem or "OK")

    def _unsubscribe(self) -> None:
        super()._unsubscribe()
        self._updates.close()

    # --- maps --------------------------------------------------------------------------------------------------

    def _load(self, message: Any) -> bool:
        info = message.info
        cells = np.frombuffer(message.data, np.uint8)
        origin = _pose_of(info.origin)
        if not np.isfinite([info.resolution, *origin]).all():
            self.say("Map", "error", "Message contained invalid floating point values (nans or infs)")
        elif info.width * info.height == 0:
            self.say("Map", "error", f"Map is zero-sized ({info.width}x{info.height})")
        elif info.width * info.height != cells.size:
            text = f"width = {info.width}, height = {info.height}, data size = {cells.size}"
            self.say("Map", "error", f"Data size doesn't match width*height: {text}")
        else:
            self._map = message
            self._cells, self._is_own = cells.reshape(info.height, info.width), False
            self.say("Message", "ok", "Map received")
            self.say("Map", "ok", "Map OK")
            self._tell(message)
            return True
        return False

    def _tell(self, message: Any) -> None:
        for path, value in readings(message.info):
            if self.properties.tell(path, value):
                self.stage.publish(PropertyChanged(self.property_id(path), value))

    def _updated(self, update: Any) -> None:
        if self._map is None:
            return
        info = self._map.info
        part = np.frombuffer(update.data, np.uint8)
        right, top = update.x + update.width, update.y + update.height
        if update.x < 0 or update.y < 0 or right > info.width or top > info.height:
            self.say("Update", "error", "Update area outside of original map area.")
            return
        if part.size != update.width * update.height:
            text = f"width = {update.width}, height = {update.height}, data size = {part.size}"
            self.say("Update", "error", f"Data size doesn't match width*height: {text}")
            return
        if not self._is_own:
            self._cells, self._is_own = self._cells.copy(), True
        self._cells[update.y : top, update.x : right] = part.reshape(update.height, update.width)
        self.say("Update", "ok", "Update OK")
        self._send_soon()

    def _send_soon(self) -> None:
        """Many updates at once make one map."""
        if self._sending is None:
            wait = max(0.0, self._sent_at + _UPDATE_PERIOD - time.monotonic())
            self._sending = asyncio.get_running_loop().call_later(wait, self._send_updated)

    def _send_updated(self) -> None:
        self._sending = None
        self._send()

    def _send(self) -> None:
        info = self._map.info
        frame, stamp_ns = self.frame_of(self._map)
        timed = self.properties.flag(USE_TIMESTAMP)
        content = OccupancyMap(
            width=info.width,
            height=info.height,
            resolution=float(info.resolution),
            origin=_pose_of(info.origin),
            cells=self._cells,
        )
        self._sent_at = time.monotonic()
        self.send(content, frame=frame.removeprefix("/"), pose=self._pose if timed else None, stamp_ns=stamp_ns)


def _pose_of(origin: Any) -> list[float]:
    """Its x y z qx qy qz qw; a quaternion of zeros is none, and stands for no turn."""
    p, q = origin.position, origin.orientation
    turn = [q.x, q.y, q.z, q.w]
    return [p.x, p.y, p.z, *(turn if any(turn) else [0.0, 0.0, 0.0, 1.0])]
