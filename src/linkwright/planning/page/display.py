"""The display moveit_rviz_plugin/MotionPlanning."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from math import isfinite
from typing import Any, ClassVar

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.geometry.single import Transform
from linkwright.graph import QoSProfile
from linkwright.page.outbox import Payload
from linkwright.page.protocol.markers import InteractiveMarkerMoved, MarkerFeedback, MarkerShape
from linkwright.page.protocol.motion_planning import (
    ChoosePlanner,
    ChooseQueryState,
    CommandMotion,
    QueryName,
    SelectSceneObject,
    SetQueryJoint,
)
from linkwright.planning.known_names import leave_out_unknown_names
from linkwright.planning.page.groups import PlanningGroup, read_groups
from linkwright.planning.page.handles import (
    choose_size,
    describe_place,
    make_handle,
    name_handle,
    name_object_handle,
)
from linkwright.planning.page.move_group import MoveGroupClient
from linkwright.planning.page.panel_state import make_panel_state
from linkwright.planning.page.properties import (
    COLLIDING_COLOR,
    GROUP,
    HIDDEN_SPECS,
    MARKER_SIZE,
    REQUEST,
    SHOW_WORKSPACE,
    VIOLATION_COLOR,
    read_settings,
    read_workspace,
    request_spec,
)
from linkwright.planning.page.scene_edits import (
    SCENE_REQUESTS,
    SceneRequest,
    find_object_pose,
    make_differences,
    place_object,
)
from linkwright.planning.page.semantic_source import SemanticSource
from linkwright.planning.page.session import QUERIES, PlanningSession
from linkwright.planning.semantics import Semantics, read_semantics
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, Schema
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.base.topic_display import SideTopic
from linkwright.rviz.displays.moveit.planning_scene import PlanningSceneDisplay
from linkwright.rviz.displays.moveit.properties import (
    NAMESPACE,
    PATH,
    TRAJECTORY_TOPIC,
    parse_rgb,
    path_specs,
)
from linkwright.rviz.displays.moveit.robot import Appearance
from linkwright.rviz.displays.moveit.solids import Color
from linkwright.rviz.displays.moveit.trajectory import MotionPlayer
from linkwright.rviz.markers.shapes import make_marker

_PANEL_KEY = "planning"
_SEMANTICS_ROW = "SRDF"
_REACH_ROW = "Inverse Kinematics"
_MOVE_GROUP_ROW = "move_group"
_WORKSPACE_COLOR: Color = (0.0, 0.0, 0.6, 0.3)
_OBJECT_HANDLE_COLOR = (0.2, 0.6, 1.0)
_TITLES: dict[QueryName, str] = {"start": "Start", "goal": "Goal"}


class MotionPlanningDisplay(PlanningSceneDisplay):
    """A display of the planning scene and of planned motions, from which motions are planned.

    The start and goal states of the planning group are drawn and can be dragged with handles. Without an SRDF, the
    first and the last state of the last motion are drawn instead.
    """

    CLASS = "moveit_rviz_plugin/MotionPlanning"
    DRAWN_AS = CLASS
    SCHEMA: ClassVar[Schema] = (
        *PlanningSceneDisplay.SCHEMA,
        request_spec(()),
        PropertySpec(PATH, "group", description="The motions.", children=path_specs(())),
        *HIDDEN_SPECS,
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        self._groups_by_name: dict[str, PlanningGroup] = {}
        self._cached_schema: tuple[object, Schema] = (None, ())
        self._semantics: Semantics | None = None
        super().__init__(host, identity, config)
        self._player = MotionPlayer(self, (PATH,), self._draw_motion)
        self._motion_topic = SideTopic(host, "moveit_msgs/msg/DisplayTrajectory", self._player.play)
        self._source = SemanticSource(host, self._on_semantics)
        self._session = PlanningSession(
            self._schedule_update,
            lambda: read_settings(self.properties),
            lambda: read_workspace(self.properties),
            self._on_released,
        )
        self._sent_handles: dict[str, tuple[object, list[float]]] = {}
        self._selected_object = ""
        self._sent_state: object = None
        self._update_handle: asyncio.Handle | None = None

    def schema(self) -> Schema:
        """Return the properties for the scene, for planning, and for motions."""
        subject = (self.link_names, tuple(self._groups_by_name))
        if self._cached_schema[0] != subject:
            path = PropertySpec(PATH, "group", description="The motions.", children=path_specs(self.link_names))
            request = request_spec(tuple(self._groups_by_name))
            self._cached_schema = (subject, (*super().schema(), request, path, *HIDDEN_SPECS))
        return self._cached_schema[1]

    # --- lifecycle ---------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Subscribe to the planning scene, to motions and to the SRDF, and connect to move_group."""
        super().start()
        self._subscribe_motions()
        self._connect()

    def stop(self) -> None:
        """Unsubscribe, stop playing, and cancel the motion that is executed."""
        self._motion_topic.close()
        self._player.clear()
        self._disconnect()
        super().stop()

    def on_enabled_changed(self) -> None:
        """Subscribe and connect if the display is enabled, or unsubscribe and disconnect."""
        super().on_enabled_changed()
        self._subscribe_motions()
        self._connect()

    def on_property_changed(self, path: Path) -> None:
        """Apply a changed property."""
        if path == (PATH, TRAJECTORY_TOPIC):
            self._player.clear()
            self._subscribe_motions()
        elif path == (NAMESPACE,):
            self._connect()
        elif path == (REQUEST, GROUP):
            self._choose_group()
        super().on_property_changed(path)
        self._player.on_property_changed(path)
        self._schedule_update()

    def on_time_changed(self) -> None:
        """Show the messages that were queued while time was paused."""
        super().on_time_changed()
        self._motion_topic.resume()
        self._source.resume()

    def on_robot_changed(self) -> None:
        """Play the motion again with the new robot, and read its planning groups."""
        super().on_robot_changed()
        self._session.robot = self.robot
        self._session.set_current(self.scene.state.copy())
        self._read_groups()
        self._player.restart()

    def reset(self) -> None:
        """Discard the scene and the motion."""
        self._player.clear()
        super().reset()
        self._session.set_current(self.scene.state.copy())
        self._schedule_update()

    def data(self) -> list[Payload]:
        """Return the markers, the handles and the state of planning."""
        return [*super().data(), *self._data.values()]

    # --- messages ----------------------------------------------------------------------------------------------

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Apply a full scene, or changes to the current scene."""
        super().process_message(message, pose)
        has_moved = self._session.current != self.scene.state
        objects = message.world.collision_objects or message.robot_state.attached_collision_objects
        if has_moved:
            self._session.set_current(self.scene.state.copy())
        if objects or not message.is_diff:
            for name in QUERIES:
                self._session.check_validity(name)
        self._schedule_update()

    def receive(self, message: Any) -> None:
        """Handle a drag of a handle, or a request of the panel."""
        if isinstance(message, MarkerFeedback):
            self._drag(message)
        elif isinstance(message, CommandMotion):
            self._session.command(message.command)
        elif isinstance(message, ChooseQueryState):
            self._session.choose(message.query, message.choice)
        elif isinstance(message, SetQueryJoint):
            self._session.set_joint(message.query, message.joint, message.position)
        elif isinstance(message, ChoosePlanner):
            self._session.pipeline, self._session.planner = message.pipeline, message.planner
            self._schedule_update()
        elif isinstance(message, SelectSceneObject):
            self._selected_object = message.name
            self._schedule_update()
        elif isinstance(message, SCENE_REQUESTS):
            self._edit_scene(message)
        else:
            super().receive(message)

    def _edit_scene(self, request: SceneRequest) -> None:
        if self.robot is not None:
            arms = {tip.group for group in self._groups_by_name.values() for tip in group.tips}
            joints = {name for arm in arms for name in self._groups_by_name[arm].joint_names}
            for difference in make_differences(request, self.scene, self.robot, joints):
                self._session.apply_scene(difference)

    def _drag(self, feedback: MarkerFeedback) -> None:
        group, handle = self._session.group, feedback.marker
        pose: Transform | None = None
        if feedback.event == "pose_update" and len(feedback.pose) == 7 and all(map(isfinite, feedback.pose)):
            x, y, z, qx, qy, qz, qw = feedback.pose
            pose = (x, y, z, qx, qy, qz, qw)
        if handle == name_object_handle(self._selected_object):
            self._drag_object(handle, pose, is_released=feedback.event == "mouse_up")
            return
        for query in QUERIES:
            for tip in group.tips if group else ():
                if name_handle(query, tip) != handle:
                    continue
                if pose is not None:
                    self._session.drag(query, tip, pose, handle)
                elif feedback.event == "mouse_up":
                    self._session.release(handle)

    def _drag_object(self, handle: str, pose: Transform | None, *, is_released: bool) -> None:
        selected = self.scene.objects.get(self._selected_object)
        if selected is not None and pose is not None:
            self._session.apply_scene(place_object(selected, pose), handle)
        elif is_released:
            self._session.release_object(handle)

    def _on_released(self, handle: str) -> None:
        """Move a handle that the user released to the link in the state that was found."""
        key, _ = self._sent_handles.get(handle, (None, []))
        self._sent_handles[handle] = (key, [])
        self._schedule_update()

    # --- groups and move_group ---------------------------------------------------------------------------------

    def _connect(self) -> None:
        self._disconnect()
        if not self.enabled:
            return
        namespace = self.properties.text(NAMESPACE).strip("/ ")
        prefix = f"{namespace}/" if namespace else ""
        self._source.start(prefix)
        self._session.connect(MoveGroupClient(self.context.node, prefix))
        self.context.graph_changes.watch(self._on_graph_changed)
        self._schedule_update()

    def _disconnect(self) -> None:
        self.context.graph_changes.unwatch(self._on_graph_changed)
        self._source.stop()
        self._session.disconnect()
        if self._update_handle is not None:
            self._update_handle.cancel()
            self._update_handle = None

    def _on_graph_changed(self) -> None:
        self._session.list_pipelines()
        for name in QUERIES:
            self._session.check_validity(name)
        self._schedule_update()

    def _on_semantics(self, text: str) -> None:
        try:
            self._semantics = read_semantics(text)
        except LinkwrightError as error:
            self._semantics = None
            self.set_status_row(_SEMANTICS_ROW, "error", error.diagnostics[0].message)
        self._read_groups()
        self.draw()

    def _read_groups(self) -> None:
        robot, semantics = self.robot, self._semantics
        self._groups_by_name = {}
        if robot is not None and semantics is not None:
            known = leave_out_unknown_names(semantics, robot.description)
            self._groups_by_name = read_groups(robot.description, known, robot.joint_names)
            if known.problems:
                self.set_status_row(_SEMANTICS_ROW, "error", known.problems[0].message)
            else:
                self.delete_status_row(_SEMANTICS_ROW)
        self.publish_properties()
        self._choose_group()

    def _choose_group(self) -> None:
        """Plan for the group of the property, or else for the first group with a handle."""
        groups = self._groups_by_name
        group = groups.get(self.properties.text(REQUEST, GROUP))
        if group is None:
            group = next((item for item in groups.values() if item.tips), next(iter(groups.values()), None))
        self._session.set_group(group)
        self._schedule_update()

    # --- drawing -----------------------------------------------------------------------------------------------

    def draw(self) -> None:
        """Draw the scene, the start and goal states, and the motion."""
        super().draw()
        if self.enabled:
            self._draw_motion()
            self._schedule_update()

    def _draw_motion(self) -> None:
        self._player.draw(PATH)
        if self._session.group is None:
            self._draw_end_state("start", 0)
            self._draw_end_state("goal", -1)
        self.send_markers()

    def _draw_end_state(self, name: QueryName, waypoint: int) -> None:
        """Draw the first or the last state of the motion."""
        group, motion, robot = f"{_TITLES[name]} State", self._player.motion, self.robot
        if robot is None or motion is None or not self._is_query_shown(name):
            self.put(group, ())
        else:
            appearance = self._query_appearance(name, robot.links_moved_by(motion.joints), {})
            self.put(group, robot.make_markers(motion.states[waypoint], appearance))

    def _schedule_update(self) -> None:
        """Draw the states and send the handles and the panel's state, once for all changes of the same moment."""
        if self._update_handle is None and self.enabled:
            self._update_handle = asyncio.get_running_loop().call_soon(self._update)

    def _update(self) -> None:
        self._update_handle = None
        if not self.enabled:
            return
        if self._session.group is not None:
            for name in QUERIES:
                self.put(f"{_TITLES[name]} State", self._make_query_markers(name))
            self.put("workspace", self._make_workspace_marker())
            self.send_markers()
        self._send_handles()
        self._report_planning()
        groups, settings = tuple(self._groups_by_name), read_settings(self.properties)
        state = make_panel_state(
            self._session,
            self.scene,
            groups,
            settings,
            has_state=self._has_state,
            shows_goal=self._is_query_shown("goal"),
        )
        if state != self._sent_state:
            self._sent_state = state
            self.send(state, key=_PANEL_KEY)

    @property
    def _has_state(self) -> bool:
        return self._state is not None

    def _is_query_shown(self, name: QueryName) -> bool:
        return self.properties.flag(REQUEST, f"Query {_TITLES[name]} State")

    def _make_query_markers(self, name: QueryName) -> list[MarkerShape]:
        robot, group = self.robot, self._session.group
        if robot is None or group is None or not self._has_state or not self._is_query_shown(name):
            return []
        state = self._session.state(name)
        colors: dict[str, Color] = {}
        violation = (*parse_rgb(self.properties.text(REQUEST, VIOLATION_COLOR)), 1.0)
        for joint in group.joints:
            if not joint.is_within(state.values.get(joint.name, 0.0)):
                colors[joint.child] = violation
        collision = (*parse_rgb(self.properties.text(REQUEST, COLLIDING_COLOR)), 1.0)
        colors.update(dict.fromkeys(self._session.queries[name].colliding, collision))
        links = robot.links_moved_by(group.joint_names)
        return robot.make_markers(state, self._query_appearance(name, links, colors))

    def _query_appearance(self, name: QueryName, links: set[str], colors: dict[str, Color]) -> Appearance:
        title = _TITLES[name]
        return Appearance(
            f"{title} State",
            alpha=self.properties.number(REQUEST, f"{title} State Alpha"),
            color=parse_rgb(self.properties.text(REQUEST, f"{title} State Color")),
            links=colors,
            only=links,
        )

    def _make_workspace_marker(self) -> list[MarkerShape]:
        if self.robot is None or not self.properties.flag(REQUEST, SHOW_WORKSPACE):
            return []
        center, size = read_workspace(self.properties)
        frame = self.robot.frame_of(self.scene.state)
        pose = [*center, 0.0, 0.0, 0.0, 1.0]
        return [make_marker("Workspace", "box", "cube", pose, size, _WORKSPACE_COLOR, frame=frame)]

    def _send_handles(self) -> None:
        """Send new and changed handles, and the poses of handles that moved.

        A changed handle ends the drag in the page, a new pose does not.
        """
        shown: set[str] = set()
        group, robot = self._session.group, self.robot
        for name in QUERIES:
            if group is None or robot is None or not self._has_state or not self._is_query_shown(name):
                continue
            state = self._session.state(name)
            color = parse_rgb(self.properties.text(REQUEST, f"{_TITLES[name]} State Color"))
            for tip in group.tips:
                handle = name_handle(name, tip)
                shown.add(handle)
                self._send_handle(handle, *describe_place(robot, state, tip), tip.link, color)
        selected = self.scene.objects.get(self._selected_object)
        if selected is not None and robot is not None:
            handle = name_object_handle(selected.id)
            shown.add(handle)
            tips = group.tips if group is not None else ()
            frame = selected.frame or robot.frame_of(self.scene.state)
            link = tips[0].link if tips else robot.link_names[-1]
            self._send_handle(handle, frame, find_object_pose(selected), link, _OBJECT_HANDLE_COLOR)
        for handle in self._sent_handles.keys() - shown:
            del self._sent_handles[handle]
            self.remove_content(f"marker {handle}")
            self.remove_content(f"pose {handle}")

    def _send_handle(self, handle: str, frame: str, pose: Transform, link: str, color: Sequence[float]) -> None:
        """Send a handle if it changed; `link` is the tip of the arm that determines its size."""
        assert self.robot is not None
        size = choose_size(self.robot, link, self.properties.number(REQUEST, MARKER_SIZE))
        sent_key, sent_pose = self._sent_handles.get(handle, (None, []))
        key = (frame, size, tuple(color))
        if key != sent_key:
            self.remove_content(f"pose {handle}")
            self.send(make_handle(handle, frame, pose, size, color, self._meshes), key=f"marker {handle}", frame=frame)
        elif list(pose) != sent_pose:
            self.send(InteractiveMarkerMoved(handle, list(pose)), key=f"pose {handle}", frame=frame)
        self._sent_handles[handle] = (key, list(pose))

    def _report_planning(self) -> None:
        session = self._session
        if session.group is not None and session.client is not None and not session.client.is_ready:
            text = phrase("move_group does not respond; start it to plan")
            self.set_status_row(_MOVE_GROUP_ROW, "warn", text)
        else:
            self.delete_status_row(_MOVE_GROUP_ROW)
        if session.unreachable:
            link = min(session.unreachable).partition(" ")[2]
            self.set_status_row(_REACH_ROW, "warn", phrase("'{link}' cannot reach the pose of its handle", link=link))
        else:
            self.delete_status_row(_REACH_ROW)

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
