"""The views and the tools of a configuration, for the pages that show it."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.geometry.single import Transform
from linkwright.graph import InvalidTopicNameError, Publisher
from linkwright.messages import get_message
from linkwright.page.audience import Page
from linkwright.page.protocol.message import ServerMessage
from linkwright.page.protocol.views_and_tools import (
    AddTool,
    ChangeSavedView,
    PointChosen,
    PoseChosen,
    RemoveSavedView,
    RemoveTool,
    RobotMeasured,
    SavedView,
    SavedViews,
    SaveView,
    SetToolProperty,
    Tool,
    ToolClass,
    ToolPropertyChanged,
    Tools,
    ViewChanged,
    ViewClasses,
    ViewState,
)
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.rviz.config.property_store import qos_of
from linkwright.rviz.config.tools import TOOL_KINDS, ToolEntry, ToolsConfig, tool_name
from linkwright.rviz.config.views import view_classes

if TYPE_CHECKING:
    from linkwright.panels.goals import GoalSender
    from linkwright.rviz.visualization.manager import VisualizationManager


class ViewsFeature(PageFeature):
    """The views of pages, which start with the file's view.

    The file receives the view that a page changed last.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (ViewChanged, RobotMeasured, SaveView, ChangeSavedView, RemoveSavedView)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._classes = ViewClasses(view_classes())

    def opening(self) -> list[ServerMessage]:
        """Return the view classes and their properties."""
        return [self._classes]

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the view of the file and the saved views."""
        return [ViewState(manager.view, manager.opened, manager.shows_whole_robot), self._saved(manager)]

    def receive(self, page: Page, message: Any) -> None:
        """Handle a changed view of a page, or an edit of the saved views; invalid views are refused."""
        manager = self.managers.of(page)
        views = manager.config.views
        try:
            if isinstance(message, ViewChanged):
                views.current = message.view
                return
            if isinstance(message, RobotMeasured):
                manager.measured(message.diagonal, message.ground)
                return
            if isinstance(message, SaveView):
                views.save(message.view)
            elif isinstance(message, ChangeSavedView):
                views.change(message.id, message.view)
            elif isinstance(message, RemoveSavedView):
                views.remove(message.id)
        except KeyError:
            return  # another page has removed the view
        except ValueError as error:
            self.context.node.get_logger().warning(f"A page sent an invalid view: {error}")
            return
        manager.edited()
        manager.publish(self._saved(manager))

    @staticmethod
    def _saved(manager: VisualizationManager) -> SavedViews:
        return SavedViews([SavedView(identity, view) for identity, view in manager.config.views.saved.items()])


_TOPIC = "Topic"
_INITIAL_POSE = "rviz_default_plugins/SetInitialPose"
_POSE_TOOLS = {_INITIAL_POSE: "estimate", "rviz_default_plugins/SetGoal": "goal"}
_POSE = "geometry_msgs/msg/PoseStamped"
_POINT_TOOL = "rviz_default_plugins/PublishPoint"


@dataclass(slots=True)
class _ToolSet:
    """The tools of a configuration, and their publishers and goal senders by ID."""

    config: ToolsConfig
    publishers: dict[str, Publisher[Any]] = field(default_factory=dict)
    goals: dict[str, GoalSender] = field(default_factory=dict)


class ToolsFeature(PageFeature):
    """The tools of a configuration for the pages that show it.

    Publishers are created when the viewer starts, as in RViz, so that subscribers discover them before the first
    message.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (SetToolProperty, AddTool, RemoveTool, PoseChosen, PointChosen)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._shelves: dict[VisualizationManager, _ToolSet] = {}

    def start(self) -> None:
        """Create the publishers of the shared configuration's tools."""
        for manager in self.managers.all():
            self._tool_set(manager)

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the tools of the configuration."""
        return [_tools_message(self._tool_set(manager))]

    def manager_closed(self, manager: VisualizationManager) -> None:
        """Destroy the publishers of the manager's tools."""
        shelf = self._shelves.pop(manager, None)
        if shelf is not None:
            self._clear(shelf)

    def receive(self, page: Page, message: Any) -> None:
        """Change or use a tool; messages for removed tools are ignored."""
        manager = self.managers.of(page)
        shelf = self._tool_set(manager)
        if isinstance(message, SetToolProperty):
            self._set(page, manager, message)
        elif isinstance(message, AddTool):
            self._add(manager, message)
        elif isinstance(message, RemoveTool):
            if shelf.config.find(message.id) is not None:
                shelf.config.remove(message.id)
                self._withdraw(shelf, message.id)
                self._changed(manager)
        elif isinstance(message, PoseChosen):
            self._publish_pose(manager, message)
        elif isinstance(message, PointChosen):
            self._publish_point(manager, message)

    def close(self) -> None:
        """Destroy all publishers."""
        for manager in list(self._shelves):
            self.manager_closed(manager)

    def _tool_set(self, manager: VisualizationManager) -> _ToolSet:
        """Return the tools of a manager; they are created again if the configuration was replaced."""
        shelf = self._shelves.get(manager)
        if shelf is None or shelf.config is not manager.config.tools:
            if shelf is not None:
                self._clear(shelf)
            shelf = self._shelves[manager] = _ToolSet(manager.config.tools)
            for entry in shelf.config.entries:
                self._try_announce(shelf, entry)
        return shelf

    def _try_announce(self, shelf: _ToolSet, entry: ToolEntry) -> None:
        try:
            self._announce(shelf, entry)
        except InvalidTopicNameError as error:
            self.context.node.get_logger().error(f"{tool_name(entry.cls)}: {error}")

    def _clear(self, shelf: _ToolSet) -> None:
        for identity in [*shelf.publishers, *shelf.goals]:
            self._withdraw(shelf, identity)

    # --- settings ----------------------------------------------------------------------------------------------

    def _changed(self, manager: VisualizationManager) -> None:
        manager.edited()
        manager.publish(_tools_message(self._shelves[manager]))

    def _add(self, manager: VisualizationManager, message: AddTool) -> None:
        shelf = self._shelves[manager]
        try:
            entry = shelf.config.add(message.cls)
        except ValueError as error:
            self.context.node.get_logger().warning(str(error))
            return
        self._announce(shelf, entry)
        self._changed(manager)

    def _set(self, page: Page, manager: VisualizationManager, message: SetToolProperty) -> None:
        shelf = self._shelves[manager]
        entry = shelf.config.find(message.id.partition("/")[0])
        path = entry.properties.find(message.id) if entry else None
        if entry is None or path is None:
            return
        before = entry.properties.get(*path)
        try:
            entry.properties.check(path, message.value)
            shelf.config.write_defaults()
            value = entry.properties.set(path, message.value)
            if path[0] == _TOPIC:
                self._announce(shelf, entry)
        except (ValueError, InvalidTopicNameError) as error:
            self.context.node.get_logger().warning(f"{tool_name(entry.cls)}: {error}")
            entry.properties.set(path, before)
            page.send(ToolPropertyChanged(message.id, before))
            return
        manager.edited()
        manager.publish(ToolPropertyChanged(message.id, value))

    # --- publishers and messages ---------------------------------------------------------------------------------

    def _announce(self, shelf: _ToolSet, entry: ToolEntry) -> None:
        """Create a tool's publisher or goal sender for its current topic, and destroy the former one."""
        kind = TOOL_KINDS.get(entry.cls)
        if kind is not None and kind.action is not None:
            from linkwright.panels.goals import GoalSender  # few configurations use it

            shelf.goals[entry.id] = GoalSender(self.context.node, *kind.action)
        if kind is None or kind.publishes is None:
            return
        topic = entry.properties.text(_TOPIC).strip()
        if not topic:
            self._withdraw(shelf, entry.id)
            return
        made: Publisher[Any] = self.context.node.create_publisher(kind.publishes, topic, qos_of(entry.properties))
        self._withdraw(shelf, entry.id)
        shelf.publishers[entry.id] = made

    def _withdraw(self, shelf: _ToolSet, identity: str) -> None:
        publisher = shelf.publishers.pop(identity, None)
        if publisher is not None:
            self.context.node.destroy_publisher(publisher)
        goals = shelf.goals.pop(identity, None)
        if goals is not None:
            goals.destroy()

    def _find(
        self, manager: VisualizationManager, identity: str, classes: Collection[str]
    ) -> tuple[ToolEntry, Publisher[Any]] | None:
        """Return a tool and its publisher, or None if the tool has no publisher or another class."""
        shelf = self._shelves[manager]
        entry, publisher = shelf.config.find(identity), shelf.publishers.get(identity)
        return None if entry is None or publisher is None or entry.cls not in classes else (entry, publisher)

    def _publish_pose(self, manager: VisualizationManager, chosen: PoseChosen) -> None:
        place = (chosen.x, chosen.y, 0.0, 0.0, 0.0, math.sin(chosen.yaw / 2), math.cos(chosen.yaw / 2))
        goals = self._shelves[manager].goals.get(chosen.tool)
        if goals is not None:
            message, known = self._stamped(manager, _POSE, place)
            self._log_pose("goal", message.header, _fill(message.pose, known), known)
            from linkwright.page.protocol.navigation import GoalOutcome

            goals.send(message, lambda reason: manager.publish(GoalOutcome(reason, failed=True)))
            return
        found = self._find(manager, chosen.tool, _POSE_TOOLS)
        if found is None:
            return
        entry, publisher = found
        message, known = self._stamped(manager, TOOL_KINDS[entry.cls].publishes, place)
        pose = message.pose
        if entry.cls == _INITIAL_POSE:
            for index, axis in ((0, "x"), (7, "y"), (35, "yaw")):
                message.pose.covariance[index] = entry.properties.number(f"Covariance {axis}")
            pose = message.pose.pose
        self._log_pose(_POSE_TOOLS[entry.cls], message.header, _fill(pose, known), known)
        publisher.publish(message)

    def _log_pose(self, kind: str, header: Any, pose: Any, place: list[float]) -> None:
        self.context.node.get_logger().info(
            f"Setting {kind} pose: Frame:{header.frame_id}, "
            f"Position({pose.position.x:g}, {pose.position.y:g}, 0), "
            f"Orientation(0, 0, {pose.orientation.z:g}, {pose.orientation.w:g}) = Angle: {_angle(place):g}"
        )

    def _publish_point(self, manager: VisualizationManager, chosen: PointChosen) -> None:
        found = self._find(manager, chosen.tool, (_POINT_TOOL,))
        if found is None:
            return
        entry, publisher = found
        kind = TOOL_KINDS[entry.cls].publishes
        message, place = self._stamped(manager, kind, (chosen.x, chosen.y, chosen.z, 0.0, 0.0, 0.0, 1.0))
        message.point.x, message.point.y, message.point.z = place[:3]
        publisher.publish(message)

    def _stamped(self, manager: VisualizationManager, kind: str | None, pose: Transform) -> tuple[Any, list[float]]:
        """Return a message with a header, and the pose in the frame of that header.

        The given pose is in the Fixed Frame. The caller writes the returned pose to the message.
        """
        assert kind is not None
        message = get_message(kind)()
        message.header.frame_id, place = self.context.transforms.known(manager.fixed_frame, pose)
        message.header.stamp = self.context.node.get_clock().now().to_msg()
        return message, place.tolist()


def _fill(pose: Any, place: list[float]) -> Any:
    """Write a position and a quaternion to a geometry_msgs/msg/Pose, and return the message."""
    pose.position.x, pose.position.y, pose.position.z = place[:3]
    pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = place[3:]
    return pose


def _angle(pose: list[float]) -> float:
    return 2 * math.atan2(pose[5], pose[6])


def _tools_message(shelf: _ToolSet) -> Tools:
    return Tools(
        [
            Tool(entry.id, entry.cls, tool_name(entry.cls), entry.cls in TOOL_KINDS, entry.properties.rows())
            for entry in shelf.config.entries
        ],
        [ToolClass(cls, kind.name) for cls, kind in TOOL_KINDS.items()],
    )
