"""Receives the measured rays of the lidars of a simulated world."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from linkwright.diagnostics import Phrase
from linkwright.graph import SENSOR_DATA_QOS
from linkwright.page.protocol.worlds import WorldRays
from linkwright.rviz.displays.base.display import DisplayHost
from linkwright.rviz.displays.base.topic_display import SideTopic
from linkwright.rviz.sensors import DisplayedLidar

RAY_CHOICES = ("Visualized", "All", "None")
"""The sensors to draw: the sensors with ``<visualize>true</visualize>``, all sensors, or none."""
_OTHERS_SUFFIX = "/others"
"""The suffix of the topic for lidars without ``<visualize>``."""
_MAX_STORED_LIDARS = 64
"""The largest number of lidars for which the last rays are stored."""


class LidarRays:
    """Receives the measured rays of lidars.

    The receiver subscribes only while the rays are drawn.

    Args:
        host: the display's host.
        show: called with the rays of a lidar to draw.
        hide: called with the name of a lidar when its rays are no longer drawn.
    """

    def __init__(self, host: DisplayHost, show: Callable[[WorldRays], None], hide: Callable[[str], None]) -> None:
        self._show, self._hide = show, hide
        self._lidars: dict[str, DisplayedLidar] = {}
        self._drawn_lidars: set[str] = set()
        self._last_messages: dict[str, Any] = {}
        self._topics: dict[str, SideTopic] = {}
        self._host = host

    def set_lidars(self, lidars: Iterable[DisplayedLidar]) -> None:
        """Set the lidars of a world, and show their last measurements, if there are any."""
        self._lidars = {lidar.scene.name: lidar for lidar in lidars}
        self._hide_except(set())
        self._last_messages = {name: message for name, message in self._last_messages.items() if name in self._lidars}
        for message in list(self._last_messages.values()):
            self._on_measurement(message)

    def clear(self) -> None:
        """Discard and hide all rays.

        No rays are drawn until new measurements arrive.
        """
        self._last_messages.clear()
        self._hide_except(set())

    def subscribe(self, topic: str, choice: str) -> Phrase | None:
        """Subscribe to the ray topics of exactly the lidars whose rays are drawn.

        Args:
            topic: the topic of the rays; empty for no rays.
            choice: the lidars to draw, see `RAY_CHOICES`.

        Returns:
            RViz's error text if a subscription failed, or None.
        """
        lidars_by_topic: dict[str, list[str]] = {}
        for name, lidar in self._lidars.items():
            if topic and (choice == "All" or (choice == "Visualized" and lidar.scene.visualized)):
                lidars_by_topic.setdefault(topic if lidar.scene.visualized else topic + _OTHERS_SUFFIX, []).append(name)
        self._hide_except({name for names in lidars_by_topic.values() for name in names})
        for ray_topic in self._topics.keys() - lidars_by_topic.keys():
            self._topics.pop(ray_topic).close()
        problem: Phrase | None = None
        for ray_topic in lidars_by_topic.keys() - self._topics.keys():
            self._topics[ray_topic] = SideTopic(self._host, "sensor_msgs/msg/LaserScan", self._on_measurement)
            problem = self._topics[ray_topic].listen(ray_topic, SENSOR_DATA_QOS) or problem
        return problem

    def resume(self) -> None:
        """Process the messages that were queued while time was paused."""
        for topic in self._topics.values():
            topic.resume()

    def close(self) -> None:
        """Unsubscribe."""
        self.subscribe("", "")

    def _hide_except(self, drawn_lidars: set[str]) -> None:
        for name in self._drawn_lidars - drawn_lidars:
            self._hide(name)
        self._drawn_lidars &= drawn_lidars

    def _on_measurement(self, message: Any) -> None:
        name = message.header.frame_id
        lidar = self._lidars.get(name)
        ranges = np.asarray(message.ranges, dtype=np.float32)
        if lidar is not None and ranges.size != lidar.measured_shape[0] * lidar.measured_shape[1]:
            return
        if (
            name in self._last_messages or len(self._last_messages) < _MAX_STORED_LIDARS
        ):  # in recordings, the world may follow its rays
            self._last_messages[name] = message
        if lidar is None:
            return
        rows, columns = lidar.strides
        self._drawn_lidars.add(name)
        self._show(WorldRays(name, ranges.reshape(lidar.measured_shape)[::rows, ::columns].ravel()))
