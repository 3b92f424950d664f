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
from linkwright.rviz.sensors import ShownLidar

CHOICES = ("Visualized", "All", "None")
"""The choices of sensors to draw: those with ``<visualize>``, all, or none."""
_OTHERS = "/others"
"""Ends the topic of the lidars without ``<visualize>``."""
_MOST_KEPT = 64
"""Lidars whose last rays are stored until the world is known."""


class LidarRays:
    """Receives the measured rays of lidars, and subscribes only while the rays are drawn.

    Args:
        host: the display's host.
        show: called with the rays of a lidar to draw.
        hide: called with the name of a lidar whose rays are no longer drawn.
    """

    def __init__(self, host: DisplayHost, show: Callable[[WorldRays], None], hide: Callable[[str], None]) -> None:
        self._show, self._hide = show, hide
        self._lidars: dict[str, ShownLidar] = {}
        self._shown: set[str] = set()
        self._last: dict[str, Any] = {}
        self._topics: dict[str, SideTopic] = {}
        self._host = host

    def describe(self, lidars: Iterable[ShownLidar]) -> None:
        """Set the lidars of a world, and show their last measurements, if there are any."""
        self._lidars = {lidar.scene.name: lidar for lidar in lidars}
        self._let_go(set())
        self._last = {name: message for name, message in self._last.items() if name in self._lidars}
        for message in list(self._last.values()):
            self._measured(message)

    def forget(self) -> None:
        """Discard and hide all rays; nothing is drawn until new measurements arrive."""
        self._last.clear()
        self._let_go(set())

    def follow(self, topic: str, choice: str) -> Phrase | None:
        """Subscribe to the ray topics of exactly those lidars whose rays are drawn.

        Args:
            topic: the topic of the rays; empty for no rays.
            choice: the lidars to draw, see `CHOICES`.

        Returns:
            RViz's error text if a subscription failed, or None.
        """
        lidars: dict[str, list[str]] = {}
        for name, lidar in self._lidars.items():
            if topic and (choice == "All" or (choice == "Visualized" and lidar.scene.visualized)):
                lidars.setdefault(topic if lidar.scene.visualized else topic + _OTHERS, []).append(name)
        self._let_go({name for names in lidars.values() for name in names})
        for key in self._topics.keys() - lidars.keys():
            self._topics.pop(key).close()
        problem: Phrase | None = None
        for key in lidars.keys() - self._topics.keys():
            self._topics[key] = SideTopic(self._host, "sensor_msgs/msg/LaserScan", self._measured)
            problem = self._topics[key].listen(key, SENSOR_DATA_QOS) or problem
        return problem

    def resume(self) -> None:
        """Process the messages that were queued while time was paused."""
        for topic in self._topics.values():
            topic.resume()

    def close(self) -> None:
        """Unsubscribe."""
        self.follow("", "")

    def _let_go(self, drawn: set[str]) -> None:
        for name in self._shown - drawn:
            self._hide(name)
        self._shown &= drawn

    def _measured(self, message: Any) -> None:
        name = message.header.frame_id
        lidar = self._lidars.get(name)
        ranges = np.asarray(message.ranges, dtype=np.float32)
        if lidar is not None and ranges.size != lidar.measured[0] * lidar.measured[1]:
            return
        if name in self._last or len(self._last) < _MOST_KEPT:  # in recordings, the world may follow its rays
            self._last[name] = message
        if lidar is None:
            return
        rows, columns = lidar.every
        self._shown.add(name)
        self._show(WorldRays(name, ranges.reshape(lidar.measured)[::rows, ::columns].ravel()))
