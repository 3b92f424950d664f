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
from linkwright.rviz.config.property_store import qos_from_properties
from linkwright.rviz.config.tools import TOOL_KINDS, ToolEntry, ToolsConfig, get_tool_name
from linkwright.rviz.config.views import make_view_classes

if TYPE_CHECKING:
    from linkwright.panels.goals import GoalSender
    from linkwright.rviz.visualization.manager import VisualizationManager


class ViewsFeature(PageFeature):
    """The views of pages, which start with the view of the file.

    The view that any page changed last is written to the file.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (ViewChanged, RobotMeasured, SaveView, ChangeSavedView, RemoveSavedView)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._classes = ViewClasses(make_view_classes())

    def opening_messages(self) -> list[ServerMessage]:
        """Return the view classes and their properties."""
        return [self._classes]

    def configuration_messages(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the view of the file and the saved views."""
        return [
            ViewState(manager.view, manager.opened, manager.shows_whole_robot),
            self._make_saved_views_message(manager),
        ]

    def receive(self, page: Page, message: Any) -> None:
        """Handle a changed view of a page, or an edit of the saved views.

        Invalid views are refused.
        """
        manager = self.managers.of(page)
        views = manager.config.views
        try:
            if isinstance(message, ViewChanged):
                views.current = message.view
                return
            if isinstance(message, RobotMeasured):
                manager.fit_to_robot(message.diagonal, message.ground)
                return
            if isinstance(message, SaveView):
                views.save(message.view)
            elif isinstance(message, ChangeSavedView):
                views.change(message.id, message.view)
            elif isinstance(message, RemoveSavedView):
                views.remove(message.id)
        except KeyError:
            return  # Another page has removed the view.
        except ValueError as error:
            self.context.node.get_logger().warning(f"A page sent an invalid view: {error}")
            return
        manager.record_permanent_edit()
        manager.publish(self._make_saved_views_message(manager))

    @staticmethod
    def _make_saved_views_message(manager: VisualizationManager) -> SavedViews:
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
        self._tool_sets: dict[VisualizationManager, _ToolSet] = {}

    def start(self) -> None:
        """Create the publishers of the shared configuration's tools."""
        for manager in self.managers.all():
            self._get_tool_set(manager)

    def configuration_messages(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the tools of the configuration."""
        return [_make_tools_message(self._get_tool_set(manager))]

    def remove_manager(self, manager: VisualizationManager) -> None:
        """Destroy the publishers of the manager's tools."""
        tool_set = self._tool_sets.pop(manager, None)
        if tool_set is not None:
            self._destroy_all(tool_set)

    def receive(self, page: Page, message: Any) -> None:
        """Change or use a tool.

        Messages for removed tools are ignored.
        """
        manager = self.managers.of(page)
        tool_set = self._get_tool_set(manager)
        if isinstance(message, SetToolProperty):
            self._set_property(page, manager, message)
        elif isinstance(message, AddTool):
            self._add(manager, message)
        elif isinstance(message, RemoveTool):
            if tool_set.config.find(message.id) is not None:
                tool_set.config.remove(message.id)
                self._destroy_outputs(tool_set, message.id)
                self._publish_tools(manager)
        elif isinstance(message, PoseChosen):
            self._publish_pose(manager, message)
        elif isinstance(message, PointChosen):
            self._publish_point(manager, message)

    def close(self) -> None:
        """Destroy all publishers."""
        for manager in list(self._tool_sets):
            self.remove_manager(manager)

    def _get_tool_set(self, manager: VisualizationManager) -> _ToolSet:
        """Return the tools of a manager.

        If its configuration was replaced, they are created again.
        """
        tool_set = self._tool_sets.get(manager)
        if tool_set is None or tool_set.config is not manager.config.tools:
            if tool_set is not None:
                self._destroy_all(tool_set)
            tool_set = self._tool_sets[manager] = _ToolSet(manager.config.tools)
            for entry in tool_set.config.entries:
                self._try_create_outputs(tool_set, entry)
        return tool_set

    def _try_create_outputs(self, tool_set: _ToolSet, entry: ToolEntry) -> None:
        try:
            self._create_outputs(tool_set, entry)
        except InvalidTopicNameError as error:
            self.context.node.get_logger().error(f"{get_tool_name(entry.cls)}: {error}")

    def _destroy_all(self, tool_set: _ToolSet) -> None:
        for identity in [*tool_set.publishers, *tool_set.goals]:
            self._destroy_outputs(tool_set, identity)

    # --- settings ----------------------------------------------------------------------------------------------

    def _publish_tools(self, manager: VisualizationManager) -> None:
        manager.record_permanent_edit()
        manager.publish(_make_tools_message(self._tool_sets[manager]))

    def _add(self, manager: VisualizationManager, message: AddTool) -> None:
        tool_set = self._tool_sets[manager]
        try:
            entry = tool_set.config.add(message.cls)
        except ValueError as error:
            self.context.node.get_logger().warning(str(error))
            return
        self._create_outputs(tool_set, entry)
        self._publish_tools(manager)

    def _set_property(self, page: Page, manager: VisualizationManager, message: SetToolProperty) -> None:
        tool_set = self._tool_sets[manager]
        entry = tool_set.config.find(message.id.partition("/")[0])
        path = entry.properties.find(message.id) if entry else None
        if entry is None or path is None:
            return
        previous_value = entry.properties.get(*path)
        try:
            entry.properties.check(path, message.value)
            tool_set.config.write_defaults()
            value = entry.properties.set(path, message.value)
            if path[0] == _TOPIC:
                self._create_outputs(tool_set, entry)
        except (ValueError, InvalidTopicNameError) as error:
            self.context.node.get_logger().warning(f"{get_tool_name(entry.cls)}: {error}")
            entry.properties.set(path, previous_value)
            page.send(ToolPropertyChanged(message.id, previous_value))
            return
        manager.record_permanent_edit()
        manager.publish(ToolPropertyChanged(message.id, value))

    # --- publishers and messages ---------------------------------------------------------------------------------

    def _create_outputs(self, tool_set: _ToolSet, entry: ToolEntry) -> None:
        """Create the publisher or goal sender of a tool for its current topic.

        The previous publisher is destroyed.
        """
        tool_kind = TOOL_KINDS.get(entry.cls)
        if tool_kind is not None and tool_kind.action is not None:
            from linkwright.panels.goals import GoalSender  # This is imported here, because few configurations use it.

            tool_set.goals[entry.id] = GoalSender(self.context.node, *tool_kind.action)
        if tool_kind is None or tool_kind.publishes is None:
            return
        topic = entry.properties.text(_TOPIC).strip()
        if not topic:
            self._destroy_outputs(tool_set, entry.id)
            return
        publisher: Publisher[Any] = self.context.node.create_publisher(
            tool_kind.publishes, topic, qos_from_properties(entry.properties)
        )
        self._destroy_outputs(tool_set, entry.id)
        tool_set.publishers[entry.id] = publisher

    def _destroy_outputs(self, tool_set: _ToolSet, identity: str) -> None:
        publisher = tool_set.publishers.pop(identity, None)
        if publisher is not None:
            self.context.node.destroy_publisher(publisher)
        goal_sender = tool_set.goals.pop(identity, None)
        if goal_sender is not None:
            goal_sender.destroy()

    def _find_with_publisher(
        self, manager: VisualizationManager, identity: str, classes: Collection[str]
    ) -> tuple[ToolEntry, Publisher[Any]] | None:
        """Return a tool and its publisher, or None.

        The result is None if the tool has no publisher, or if its class is not in `classes`.
        """
        tool_set = self._tool_sets[manager]
        entry, publisher = tool_set.config.find(identity), tool_set.publishers.get(identity)
        return None if entry is None or publisher is None or entry.cls not in classes else (entry, publisher)

    def _publish_pose(self, manager: VisualizationManager, choice: PoseChosen) -> None:
        fixed_pose = (choice.x, choice.y, 0.0, 0.0, 0.0, math.sin(choice.yaw / 2), math.cos(choice.yaw / 2))
        goal_sender = self._tool_sets[manager].goals.get(choice.tool)
        if goal_sender is not None:
            message, header_pose = self._make_stamped_message(manager, _POSE, fixed_pose)
            self._log_pose("goal", message.header, _fill_pose(message.pose, header_pose), header_pose)
            from linkwright.page.protocol.navigation import GoalOutcome

            goal_sender.send(message, lambda reason: manager.publish(GoalOutcome(reason, failed=True)))
            return
        tool_and_publisher = self._find_with_publisher(manager, choice.tool, _POSE_TOOLS)
        if tool_and_publisher is None:
            return
        entry, publisher = tool_and_publisher
        message, header_pose = self._make_stamped_message(manager, TOOL_KINDS[entry.cls].publishes, fixed_pose)
        pose = message.pose
        if entry.cls == _INITIAL_POSE:
            for index, axis in ((0, "x"), (7, "y"), (35, "yaw")):
                message.pose.covariance[index] = entry.properties.number(f"Covariance {axis}")
            pose = message.pose.pose
        self._log_pose(_POSE_TOOLS[entry.cls], message.header, _fill_pose(pose, header_pose), header_pose)
        publisher.publish(message)

    def _log_pose(self, kind: str, header: Any, pose: Any, planar_pose: list[float]) -> None:
        self.context.node.get_logger().info(
            f"Setting {kind} pose: Frame:{header.frame_id}, "
            f"Position({pose.position.x:g}, {pose.position.y:g}, 0), "
            f"Orientation(0, 0, {pose.orientation.z:g}, {pose.orientation.w:g}) = Angle: {_compute_yaw(planar_pose):g}"
        )

    def _publish_point(self, manager: VisualizationManager, choice: PointChosen) -> None:
        tool_and_publisher = self._find_with_publisher(manager, choice.tool, (_POINT_TOOL,))
        if tool_and_publisher is None:
            return
        entry, publisher = tool_and_publisher
        message_type = TOOL_KINDS[entry.cls].publishes
        message, header_pose = self._make_stamped_message(
            manager, message_type, (choice.x, choice.y, choice.z, 0.0, 0.0, 0.0, 1.0)
        )
        message.point.x, message.point.y, message.point.z = header_pose[:3]
        publisher.publish(message)

    def _make_stamped_message(
        self, manager: VisualizationManager, message_type: str | None, pose: Transform
    ) -> tuple[Any, list[float]]:
        """Return a message with a header, and the given pose in the frame of the header.

        The given pose is in the Fixed Frame. The caller must write the returned pose to the message.
        """
        assert message_type is not None
        message = get_message(message_type)()
        message.header.frame_id, header_pose = self.context.transforms.to_known_frame(manager.fixed_frame, pose)
        message.header.stamp = self.context.node.get_clock().now().to_msg()
        return message, header_pose.tolist()


def _fill_pose(pose: Any, planar_pose: list[float]) -> Any:
    """Write a position and a quaternion to a geometry_msgs/msg/Pose, and return the message."""
    pose.position.x, pose.position.y, pose.position.z = planar_pose[:3]
    pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = planar_pose[3:]
    return pose


def _compute_yaw(pose: list[float]) -> float:
    return 2 * math.atan2(pose[5], pose[6])


def _make_tools_message(tool_set: _ToolSet) -> Tools:
    return Tools(
        [
            Tool(entry.id, entry.cls, get_tool_name(entry.cls), entry.cls in TOOL_KINDS, entry.properties.rows())
            for entry in tool_set.config.entries
        ],
        [ToolClass(cls, kind.name) for cls, kind in TOOL_KINDS.items()],
    )
