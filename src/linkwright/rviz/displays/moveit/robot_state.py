"""The display moveit_rviz_plugin/RobotState."""

from __future__ import annotations

from typing import Any

from linkwright.diagnostics import foreign, phrase
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import PropertySpec, Schema
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.moveit.base import STATE, MoveItDisplay
from linkwright.rviz.displays.moveit.properties import (
    ATTACHED_COLOR_SPEC,
    DESCRIPTION_SPEC,
    fraction_spec,
    links_spec,
    parse_rgb,
    read_link_alphas,
    rgba_from_message,
    visibility_specs,
)
from linkwright.rviz.displays.moveit.robot import Appearance, JointPositions, UnusableStateError
from linkwright.rviz.displays.moveit.scene import Scene

_TOPIC = "Robot State Topic"
_ROBOT_NAMESPACE = "Robot State"
_ATTACHED_NAMESPACE = "Robot State holds"
_HIGHLIGHTS_ROW = "Highlights"


class RobotStateDisplay(MoveItDisplay):
    """A display of a robot in the state, and with the link colors, of the last message."""

    CLASS = "moveit_rviz_plugin/RobotState"
    MESSAGE = "moveit_msgs/msg/DisplayRobotState"
    TOPIC = (_TOPIC,)

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._state = JointPositions()
        self._attached_objects = Scene()

    def schema(self) -> Schema:
        """Return the properties, with a check box for each link."""
        return (
            DESCRIPTION_SPEC,
            PropertySpec(_TOPIC, "topic", "display_robot_state", "The topic of states.", messages=(self.MESSAGE,)),
            *visibility_specs("Visual Enabled", "Collision Enabled"),
            fraction_spec("Robot Alpha", 1.0, "Opacity of the robot."),
            ATTACHED_COLOR_SPEC,
            PropertySpec("Show Highlights", "bool", True, "Draw links in the colors that the message gives them."),
            links_spec(self.link_names),
        )

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Show the robot state of a message."""
        self._read(message)
        self.draw()

    def on_robot_changed(self) -> None:
        """Show the last state with the new robot."""
        if self.last_message is not None:
            self._read(self.last_message)

    def reset(self) -> None:
        """Discard the state."""
        self._state = JointPositions()
        self._attached_objects = Scene()
        super().reset()

    def draw(self) -> None:
        """Draw the robot in the last state."""
        message, robot = self.last_message, self.robot
        if robot is None or message is None or message.hide:
            self.put(_ROBOT_NAMESPACE, ())
            self.put(_ATTACHED_NAMESPACE, ())
            self.send_markers()
            return
        properties = self.properties
        alpha = properties.number("Robot Alpha")
        highlights = {highlight.id: rgba_from_message(highlight.color) for highlight in message.highlight_links}
        appearance = Appearance(
            _ROBOT_NAMESPACE,
            visual=properties.flag("Visual Enabled"),
            collision=properties.flag("Collision Enabled"),
            alpha=alpha,
            alphas=read_link_alphas(properties, robot),
            links=highlights if properties.flag("Show Highlights") else {},
        )
        self.put(_ROBOT_NAMESPACE, robot.make_markers(self._state, appearance))
        color = (*parse_rgb(properties.text("Attached Body Color")), alpha)
        self.put(
            _ATTACHED_NAMESPACE,
            self._attached_objects.make_attached_markers(robot, self._state, _ATTACHED_NAMESPACE, color),
        )
        for name, text in self._attached_objects.problems.items():
            self.set_status_row(name, "error", text)
        unknown_links = sorted(name for name in highlights if not robot.has_link(name))
        if unknown_links:
            self.set_status_row(
                _HIGHLIGHTS_ROW, "warn", phrase("The robot has no link '{name}'", name=unknown_links[0])
            )
        else:
            self.delete_status_row(_HIGHLIGHTS_ROW)
        self.send_markers()

    def _read(self, message: Any) -> None:
        robot = self.robot
        if robot is None:
            return
        for name in self._attached_objects.problems:
            self.delete_status_row(name)
        self._attached_objects = Scene()
        self._attached_objects.attach(message.state.attached_collision_objects)
        state = self._state.copy() if message.state.is_diff else JointPositions()
        try:
            self.report_unknown_joints(robot.set_state(state, message.state))
        except UnusableStateError as error:
            self.set_status_row(STATE, "error", foreign(error))
            return
        self.delete_status_row(STATE)
        self._state = state
