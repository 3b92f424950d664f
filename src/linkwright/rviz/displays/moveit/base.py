"""The base class of MoveIt's displays: a robot in any state, and groups of markers."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from linkwright.diagnostics import joined, phrase, quoted_names
from linkwright.graph import DESCRIPTION_QOS, QoSProfile
from linkwright.page.files import MeshIndex
from linkwright.page.protocol.markers import MarkerShape
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path
from linkwright.rviz.displays.base.display import DisplayHost
from linkwright.rviz.displays.base.stored_markers import StoredMarkersDisplay
from linkwright.rviz.displays.base.topic_display import TRANSFORM, SideTopic
from linkwright.rviz.displays.moveit.properties import ALL_LINKS, DESCRIPTION
from linkwright.rviz.displays.moveit.robot import PosableRobot
from linkwright.urdf import Robot

_URDF_ROW = "URDF"
_JOINTS_ROW = "Joints"
STATE = "State"
"""The status row for problems with a state of the robot."""


class MoveItDisplay(StoredMarkersDisplay):
    """A base class for MoveIt's displays.

    A subclass overrides `draw`, which is called when the robot or a property changes.
    """

    DRAWN_AS = "rviz_default_plugins/MarkerArray"

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        self.robot: PosableRobot | None = None
        self.link_names: tuple[str, ...] = ()
        super().__init__(host, identity, config)
        self._description_topic = SideTopic(host, "std_msgs/msg/String", self._on_description)
        self._groups: dict[str, dict[str, MarkerShape]] = {}

    # --- methods to override -----------------------------------------------------------------------------------

    def draw(self) -> None:
        """Draw all markers again.

        An implementation calls `put` for each group, and then `send_markers`.
        """

    def description_topic(self) -> str:
        """Return the topic of the robot's description, or an empty string if none is set."""
        return self.properties.text(DESCRIPTION).strip()

    # --- methods for subclasses --------------------------------------------------------------------------------

    def put(self, group: str, shapes: Iterable[MarkerShape]) -> None:
        """Replace the markers of a group."""
        previous_shapes = self._groups.get(group, {})
        current_shapes = {shape.id: shape for shape in shapes}
        for identity in previous_shapes.keys() - current_shapes.keys():
            self._store.remove(identity)
        for identity, shape in current_shapes.items():
            if identity not in previous_shapes or not _is_same_marker(previous_shapes[identity], shape):
                self._store.put(shape)
        self._groups[group] = current_shapes

    def send_markers(self) -> None:
        """Send the markers passed to `put`, and show in the status which frames have no known pose."""
        self.show_markers()
        self._report_frames()

    def report_unknown_joints(self, joints: list[str]) -> None:
        """Show a warning that names joints unknown to the robot, or clear it if there are none."""
        if joints:
            names, extra_count = quoted_names(joints[:5]), len(joints) - 5
            text = phrase("The robot has no joint {names}", names=names)
            if extra_count > 0:
                text = phrase(
                    "The robot has no joint {names}, and lacks {count} further joints", names=names, count=extra_count
                )
            self.set_status_row(_JOINTS_ROW, "warn", text)
        else:
            self.delete_status_row(_JOINTS_ROW)

    # --- lifecycle ---------------------------------------------------------------------------------------------

    def subscription(self) -> tuple[str, str, QoSProfile]:
        """Return the message type, topic and QoS to subscribe with."""
        return self.MESSAGE, self.properties.text(*self.TOPIC).strip(), QoSProfile(depth=10)

    def start(self) -> None:
        """Subscribe to the display's topic and to the robot's description."""
        super().start()
        self._subscribe_description()

    def stop(self) -> None:
        """Unsubscribe."""
        self._description_topic.close()
        super().stop()

    def on_enabled_changed(self) -> None:
        """Subscribe if the display is enabled, or unsubscribe."""
        super().on_enabled_changed()
        self._subscribe_description()

    def on_property_changed(self, path: Path) -> None:
        """Apply a new topic or description topic, or the check box for all links, and redraw."""
        if path == self.TOPIC:
            self._restart()
            self._subscribe_description()
        elif path == (DESCRIPTION,):
            self._subscribe_description()
        elif path[-1] == ALL_LINKS:
            for name in self.link_names:
                if name != ALL_LINKS:
                    self.properties.set((*path[:-1], name), self.properties.flag(*path))
            self.publish_properties()
        self.draw()

    def on_frames_changed(self) -> None:
        """Show in the status which frames have no known pose."""
        self._report_frames()

    def on_time_changed(self) -> None:
        """Handle the description and the messages that were queued while time was paused."""
        self._description_topic.resume()
        super().on_time_changed()

    def reset(self) -> None:
        """Discard all markers."""
        self._groups.clear()
        self._store.clear()
        self.show_markers()

    def _subscribe_description(self) -> None:
        self._description_topic.close()
        topic = self.description_topic()
        if not self.enabled:
            return
        if not topic:
            self.set_status_row(_URDF_ROW, "error", phrase("Error subscribing: Empty topic name"))
            return
        problem = self._description_topic.listen(topic, DESCRIPTION_QOS)
        if problem is not None:
            self.set_status_row(_URDF_ROW, "error", problem)
        elif self.robot is None:
            self.set_status_row(
                _URDF_ROW, "warn", phrase("No description was received on topic '{topic}' yet", topic=topic)
            )

    def _on_description(self, message: Any) -> None:
        robot = self.context.library.read(message.data).robot
        if robot is None or not robot.links:
            self.set_status_row(
                _URDF_ROW,
                "error",
                phrase("URDF is empty") if not message.data.strip() else phrase("URDF failed Model parse"),
            )
            return
        self.set_status_row(_URDF_ROW, "ok", phrase("URDF parsed OK"))
        self._set_robot(robot, message.data)

    def _set_robot(self, robot: Robot, text: str) -> None:
        self._meshes = MeshIndex(self.context.library.packages(text) or self.context.finder)
        self.robot = PosableRobot(robot, self._meshes)
        links = tuple(self.robot.shaped_links)
        if links != self.link_names:
            self.link_names = links
            self.publish_properties()
        for link, problems in self.robot.problems.items():
            self.set_status_row(link, "error", joined(problems, "; "))
        self.on_robot_changed()
        self.draw()

    def on_robot_changed(self) -> None:
        """Handle a change of the robot, after which `draw` is called."""

    def _report_frames(self) -> None:
        frames = {shape.frame for shapes in self._groups.values() for shape in shapes.values()}
        problems = [problem for frame in sorted(frames) if (problem := self.host.frames.find_problem(frame))]
        if problems:
            self.set_status_row(TRANSFORM, "error", joined(problems, "; "))
        elif frames:
            self.set_status_row(TRANSFORM, "ok", phrase("Transform OK"))
        else:
            self.delete_status_row(TRANSFORM)


def _is_same_marker(first: MarkerShape, other: MarkerShape) -> bool:
    return (
        (first.shape, first.frame, first.pose, first.scale, first.color)
        == (other.shape, other.frame, other.pose, other.scale, other.color)
        and _mesh_identity(first) == _mesh_identity(other)
        and np.array_equal(first.points, other.points)
        and np.array_equal(first.colors, other.colors)
    )


def _mesh_identity(shape: MarkerShape) -> tuple[str | None, bool] | None:
    return (shape.mesh.url, shape.mesh.embedded) if shape.mesh else None
