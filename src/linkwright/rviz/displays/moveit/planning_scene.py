"""The display moveit_rviz_plugin/PlanningScene."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import Any, ClassVar

from linkwright.diagnostics import foreign
from linkwright.graph import Client
from linkwright.messages import get_message, get_service
from linkwright.page.protocol.configuration import PropertyChanged
from linkwright.page.protocol.markers import MarkerShape
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, Schema
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.moveit.base import STATE, MoveItDisplay
from linkwright.rviz.displays.moveit.properties import (
    DESCRIPTION_SPEC,
    GEOMETRY,
    GEOMETRY_SPEC,
    NAMESPACE,
    NAMESPACE_SPEC,
    ROBOT,
    SCENE_TOPIC,
    SCENE_TOPIC_SPEC,
    parse_rgb,
    read_appearance,
    scene_robot_spec,
)
from linkwright.rviz.displays.moveit.robot import JointPositions, UnusableStateError
from linkwright.rviz.displays.moveit.scene import Scene
from linkwright.rviz.displays.moveit.voxels import BY_PROBABILITY, make_octomap_markers, select_rendered

_SERVICE_NAME = "get_planning_scene"
_ATTACHED_NAMESPACE = "Scene Robot holds"


class PlanningSceneDisplay(MoveItDisplay):
    """A display of a planning scene: the robot, attached objects, and surrounding objects.

    The topic carries only changes. The display therefore requests the full scene from move_group, when the display
    starts or as soon as move_group is available.
    """

    CLASS = "moveit_rviz_plugin/PlanningScene"
    MESSAGE = "moveit_msgs/msg/PlanningScene"
    TOPIC = (SCENE_TOPIC,)
    SCHEMA: ClassVar[Schema] = (NAMESPACE_SPEC, DESCRIPTION_SPEC, SCENE_TOPIC_SPEC, GEOMETRY_SPEC, scene_robot_spec(()))

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self.scene = Scene()
        self._client: Client[Any, Any] | None = None
        self._state: Any = None
        self._draw_timer: asyncio.TimerHandle | None = None
        self._reported: set[str] = set()

    def schema(self) -> Schema:
        """Return the properties, with a check box for each link."""
        return (NAMESPACE_SPEC, DESCRIPTION_SPEC, SCENE_TOPIC_SPEC, GEOMETRY_SPEC, scene_robot_spec(self.link_names))

    def description_topic(self) -> str:
        """Return the topic of the robot's description, by default in move_group's namespace.

        An absolute topic name is returned unchanged, as is any name if no namespace is set.
        """
        name, namespace = super().description_topic(), self.properties.text(NAMESPACE).strip("/ ")
        return f"/{namespace}/{name}" if namespace and name and not name.startswith("/") else name

    def start(self) -> None:
        """Subscribe, and request the full scene."""
        super().start()
        self._request_scene()

    def stop(self) -> None:
        """Unsubscribe, and cancel pending requests for the scene."""
        self._cancel_request()
        super().stop()

    def on_enabled_changed(self) -> None:
        """Subscribe and request the full scene if the display is enabled, or unsubscribe."""
        super().on_enabled_changed()
        self._request_scene()

    def on_property_changed(self, path: Path) -> None:
        """Apply a changed property.

        A new namespace or topic also requests the full scene again.
        """
        if path == (NAMESPACE,):
            self._restart()
            self._subscribe_description()
            self._request_scene()
        super().on_property_changed(path)
        if path == self.TOPIC:
            self._request_scene()

    def on_time_reset(self) -> None:
        """Discard the scene and request it again."""
        super().on_time_reset()
        self._request_scene()

    def reset(self) -> None:
        """Discard the scene."""
        self.scene = Scene()
        self._state = None
        self._reported.clear()
        super().reset()

    def on_robot_changed(self) -> None:
        """Apply the last state to the new robot.

        The state may have arrived before the description.
        """
        self.scene.state = JointPositions()
        if self._state is not None:
            self._apply_state(self._state)

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Apply a full scene, or changes to the current scene."""
        previous_name = self.scene.name
        self.scene.apply(message)
        if self.scene.name != previous_name:
            self._publish_name()
        state = message.robot_state
        if state.joint_state.name or state.multi_dof_joint_state.joint_names:
            self._state = state
            self._apply_state(state)
        self._schedule_draw()

    def draw(self) -> None:
        """Draw the robot and the objects of the scene."""
        if self._draw_timer is not None:
            self._draw_timer.cancel()
            self._draw_timer = None
        if not self.enabled:
            return
        self._draw_geometry()
        self._draw_robot()
        self._report_problems()
        self.send_markers()

    # --- drawing -----------------------------------------------------------------------------------------------

    def _schedule_draw(self) -> None:
        if self._draw_timer is None:
            delay = self.properties.number(GEOMETRY, "Scene Display Time")
            self._draw_timer = asyncio.get_running_loop().call_later(delay, self.draw)

    def _draw_geometry(self) -> None:
        is_shown = self.properties.flag(GEOMETRY, "Show Scene Geometry")
        alpha = self.properties.number(GEOMETRY, "Scene Alpha")
        color = (*parse_rgb(self.properties.text(GEOMETRY, "Scene Color")), alpha)
        self.put("objects", self.scene.make_object_markers(GEOMETRY, color) if is_shown else ())
        self.put("octomap", self._make_octomap_markers(alpha) if is_shown else ())

    def _make_octomap_markers(self, alpha: float) -> list[MarkerShape]:
        octomap = self.scene.octomap
        if octomap is None:
            return []
        return make_octomap_markers(
            select_rendered(octomap.cells, self.properties.text(GEOMETRY, "Voxel Rendering")),
            GEOMETRY,
            frame=octomap.frame,
            base=octomap.base,
            alpha=alpha,
            by_probability=self.properties.text(GEOMETRY, "Voxel Coloring") == BY_PROBABILITY,
        )

    def _draw_robot(self) -> None:
        if self.robot is None:
            return
        alpha = self.properties.number(ROBOT, "Robot Alpha")
        color = (*parse_rgb(self.properties.text(ROBOT, "Attached Body Color")), alpha)
        has_state = self._state is not None
        appearance = read_appearance(self.properties, self.robot, ROBOT, (ROBOT,))
        self.put("robot", self.robot.make_markers(self.scene.state, appearance) if has_state else ())
        is_shown = has_state and alpha > 0.0
        self.put(
            "held",
            self.scene.make_attached_markers(self.robot, self.scene.state, _ATTACHED_NAMESPACE, color)
            if is_shown
            else (),
        )

    def _apply_state(self, message: Any) -> None:
        if self.robot is None:
            return
        try:
            self.report_unknown_joints(self.robot.set_state(self.scene.state, message))
        except UnusableStateError as error:
            self.set_status_row(STATE, "error", foreign(error))
            return
        self.delete_status_row(STATE)

    def _report_problems(self) -> None:
        for name in self._reported - self.scene.problems.keys():
            self.delete_status_row(name)
        self._reported = set(self.scene.problems)
        for name, text in self.scene.problems.items():
            self.set_status_row(name, "error", text)

    def _publish_name(self) -> None:
        path = (GEOMETRY, "Scene Name")
        if self.properties.set_read_only(path, self.scene.name):
            self.pages.publish(PropertyChanged(self.property_id(path), self.scene.name))

    # --- requesting the full scene -----------------------------------------------------------------------------

    def _request_scene(self) -> None:
        """Request the full scene from move_group, now or as soon as its service is available."""
        self._cancel_request()
        if not self.enabled:
            return
        namespace = self.properties.text(NAMESPACE).strip("/ ")
        name = f"/{namespace}/{_SERVICE_NAME}" if namespace else f"/{_SERVICE_NAME}"
        self._client = self.context.node.create_client(get_service("moveit_msgs/srv/GetPlanningScene"), name)
        self.context.graph_changes.watch(self._request_if_ready)
        self._request_if_ready()

    def _request_if_ready(self) -> None:
        client = self._client
        if client is None or not client.service_is_ready():
            return
        self.context.graph_changes.unwatch(self._request_if_ready)
        components = get_message("moveit_msgs/msg/PlanningSceneComponents")
        requested_components = components(components=_COMPONENTS)
        future = client.call_async(client.srv_type.Request(components=requested_components))

        def on_response(_: Any) -> None:
            response = future.result()
            if self._client is client and response is not None and not self.scene.has_full_scene:
                self._on_scene(response.scene)

        future.add_done_callback(on_response)

    def _on_scene(self, scene: Any) -> None:
        if not self.host.time.paused:
            self._process(scene, None)

    def _cancel_request(self) -> None:
        self.context.graph_changes.unwatch(self._request_if_ready)
        if self._draw_timer is not None:
            self._draw_timer.cancel()
            self._draw_timer = None
        if self._client is not None:
            with suppress(ValueError):  # the node may already have been destroyed
                self.context.node.destroy_client(self._client)
            self._client = None


_COMPONENTS = 1 | 2 | 4 | 8 | 16 | 32 | 64 | 512
"""The requested components: settings, state, objects with names and shapes, octomap, transforms and colors."""
