"""The display moveit_rviz_plugin/MotionPlanning, without planning."""

from __future__ import annotations

from typing import ClassVar

from linkwright.diagnostics import phrase
from linkwright.graph import QoSProfile
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, Schema
from linkwright.rviz.displays.base.display import DisplayHost
from linkwright.rviz.displays.base.topic_display import SideTopic
from linkwright.rviz.displays.moveit.planning_scene import PlanningSceneDisplay
from linkwright.rviz.displays.moveit.properties import PATH, TRAJECTORY_TOPIC, fraction_spec, parse_rgb, path_specs
from linkwright.rviz.displays.moveit.robot import Appearance
from linkwright.rviz.displays.moveit.trajectory import MotionPlayer

_REQUEST_GROUP = "Planning Request"

_REQUEST_SPEC = PropertySpec(
    _REQUEST_GROUP,
    "group",
    description="The first and last states of the last planned motion, for the links that it moves.",
    children=(
        PropertySpec("Query Start State", "bool", False, "Draw the first state."),
        PropertySpec("Query Goal State", "bool", True, "Draw the last state."),
        PropertySpec("Start State Color", "color", "#00ff00", "Color of the first state."),
        fraction_spec("Start State Alpha", 1.0, "Opacity of the first state."),
        PropertySpec("Goal State Color", "color", "#fa8000", "Color of the last state."),
        fraction_spec("Goal State Alpha", 1.0, "Opacity of the last state."),
    ),
)


class MotionPlanningDisplay(PlanningSceneDisplay):
    """A display of the planning scene and of planned motions.

    The first and the last state of the last motion are also drawn.

    The display does not plan. The properties of planning requests stay in the file, but have no rows in the page.
    """

    CLASS = "moveit_rviz_plugin/MotionPlanning"
    SCHEMA: ClassVar[Schema] = (
        *PlanningSceneDisplay.SCHEMA,
        _REQUEST_SPEC,
        PropertySpec(PATH, "group", description="The motions.", children=path_specs(())),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._player = MotionPlayer(self, (PATH,), self._draw_motion)
        self._motion_topic = SideTopic(host, "moveit_msgs/msg/DisplayTrajectory", self._player.play)

    def schema(self) -> Schema:
        """Return the properties for the scene and for motions."""
        path = PropertySpec(PATH, "group", description="The motions.", children=path_specs(self.link_names))
        return (*super().schema(), _REQUEST_SPEC, path)

    def start(self) -> None:
        """Subscribe to the planning scene and to motions."""
        super().start()
        self._subscribe_motions()

    def stop(self) -> None:
        """Unsubscribe, and stop playing."""
        self._motion_topic.close()
        self._player.clear()
        super().stop()

    def on_enabled_changed(self) -> None:
        """Subscribe if the display is enabled, or unsubscribe."""
        super().on_enabled_changed()
        self._subscribe_motions()

    def on_property_changed(self, path: Path) -> None:
        """Subscribe to another motion topic, or restart the motion if looping was just enabled."""
        if path == (PATH, TRAJECTORY_TOPIC):
            self._player.clear()
            self._subscribe_motions()
        super().on_property_changed(path)
        self._player.on_property_changed(path)

    def on_time_changed(self) -> None:
        """Show the messages that were queued while time was paused."""
        super().on_time_changed()
        self._motion_topic.resume()

    def on_robot_changed(self) -> None:
        """Play the motion again with the new robot."""
        super().on_robot_changed()
        self._player.restart()

    def reset(self) -> None:
        """Discard the scene and the motion."""
        self._player.clear()
        super().reset()

    def draw(self) -> None:
        """Draw the scene and the motion."""
        super().draw()
        if self.enabled:
            self._draw_motion()

    def _draw_motion(self) -> None:
        self._player.draw(PATH)
        self._draw_end_state("Start", 0)
        self._draw_end_state("Goal", -1)
        self.send_markers()

    def _draw_end_state(self, end_name: str, waypoint: int) -> None:
        group, motion, robot = f"{end_name} State", self._player.motion, self.robot
        if robot is None or motion is None or not self.properties.flag(_REQUEST_GROUP, f"Query {end_name} State"):
            self.put(group, ())
            return
        appearance = Appearance(
            group,
            alpha=self.properties.number(_REQUEST_GROUP, f"{end_name} State Alpha"),
            color=parse_rgb(self.properties.text(_REQUEST_GROUP, f"{end_name} State Color")),
            only=robot.links_moved_by(motion.joints),
        )
        self.put(group, robot.make_markers(motion.states[waypoint], appearance))

    def _subscribe_motions(self) -> None:
        self._motion_topic.close()
        topic = self.properties.text(PATH, TRAJECTORY_TOPIC).strip()
        if not self.enabled:
            return
        problem = (
            self._motion_topic.listen(topic, QoSProfile(depth=10))
            if topic
            else phrase("Error subscribing: Empty topic name")
        )
        if problem is None:
            self.delete_status_row(TRAJECTORY_TOPIC)
        else:
            self.set_status_row(TRAJECTORY_TOPIC, "error", problem)
