"""Sends the differences between two descriptions in one scene to pages."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from linkwright.page.protocol.comparison import (
    ComparedDescriptions,
    ComparedItem,
    ComparedLocation,
    ComparedRobot,
    Mark,
)
from linkwright.page.protocol.message import ServerMessage
from linkwright.panels.comparison.old_robot import DESCRIPTION_TOPIC, FRAME_PREFIX, OldRobot, find_leading_joints
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.rviz.config.rviz_config import RvizConfig

if TYPE_CHECKING:
    from linkwright.descriptions.comparison import Comparison, Difference, DifferenceLocation
    from linkwright.descriptions.pairs import Model, Pair
    from linkwright.graph import Node
    from linkwright.rviz.displays.robot_model import RobotModelDisplay
    from linkwright.rviz.visualization.manager import VisualizationManager
    from linkwright.urdf import Robot

_OLD_ROBOT_ALPHA = 0.4
"""The opacity of the old robot, from 0 to 1."""


def add_old_robot(config: RvizConfig, name: str) -> None:
    """Add a translucent display of the old robot to the configuration of the new robot."""
    display = config.make_display("rviz_default_plugins/RobotModel", name)
    for path, value in (
        (("Description Topic", "Value"), DESCRIPTION_TOPIC),
        (("TF Prefix",), FRAME_PREFIX),
        (("Alpha",), f"{_OLD_ROBOT_ALPHA:g}"),
    ):
        display.section.put(path, value, string=path[-1] != "Alpha")
    config.insert(display)


class ComparisonFeature(PageFeature):
    """The feature that compares the robots of two displays when one of them changes.

    It has no effect before a pair is attached.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._pair: Pair | None = None
        self._old_robot: OldRobot | None = None
        self._last_comparison: tuple[Robot, Robot, Comparison] | None = None
        self._sent_messages: dict[VisualizationManager, ComparedDescriptions] = {}

    def attach(self, pair: Pair, node: Node) -> Callable[[str], None]:
        """Start sending the differences between two descriptions to pages.

        Args:
            pair: the descriptions; the displays of `RvizConfig.for_model` and of `add_old_robot` show them.
            node: the node that publishes the old description and its transforms.

        Returns:
            A function to call with each new text of the old description.
        """
        self._pair, self._old_robot = pair, OldRobot(node, self.context.node)
        return self._old_robot.publish

    def configuration_messages(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the differences that were last sent to pages."""
        message = self._make_message(manager)
        if message is None:
            return []
        self._sent_messages[manager] = message
        return [message]

    def on_robot_changed(self) -> None:
        """Compare the robots that the displays show now."""
        if self._pair is None or self._old_robot is None:
            return
        old, new = next(
            (pair for manager in self.managers.all() if None not in (pair := _find_compared_robots(manager))),
            (None, None),
        )
        if old is None or new is None:
            return
        if self._last_comparison is None or self._last_comparison[0] is not old or self._last_comparison[1] is not new:
            comparison = self._pair.compare(old, new)
            self._last_comparison = old, new, comparison
            self._old_robot.publish_poses(old, new, comparison)
        for manager in self.managers.all():
            self._publish(manager)

    def on_edit(self, manager: VisualizationManager) -> None:
        """Send the differences again if they have changed.

        Displays may have been added or removed.

        Displays may have been added or removed.
        """
        self._publish(manager)

    def remove_manager(self, manager: VisualizationManager) -> None:
        """Discard the differences that were sent to the pages of the manager."""
        self._sent_messages.pop(manager, None)

    def _publish(self, manager: VisualizationManager) -> None:
        message = self._make_message(manager)
        if message is not None and message != self._sent_messages.get(manager):
            self._sent_messages[manager] = message
            manager.publish(message)

    def _make_message(self, manager: VisualizationManager) -> ComparedDescriptions | None:
        if self._pair is None or self._last_comparison is None:
            return None
        old, new, comparison = self._last_comparison
        old_marks, new_marks = _find_link_marks(comparison, old, new)
        old_display, new_display = _find_robot_displays(manager)
        return ComparedDescriptions(
            ComparedRobot(_get_display_id(old_display), self._pair.old.label(), old_marks),
            ComparedRobot(_get_display_id(new_display), self._pair.new.label(), new_marks),
            find_leading_joints(old, new, comparison.joints),
            _find_links_of_same_shape(comparison),
            [_make_compared_item(difference, old, new, self._pair) for difference in comparison.differences],
        )


def without_paths(message: ComparedDescriptions) -> ComparedDescriptions:
    """Replace absolute paths in a message with file names for sharing, and return the message."""
    for robot in (message.old, message.new):
        robot.label = _to_shareable_name(robot.label)
    for item in message.items:
        for location in (item.old_place, item.new_place):
            if location is not None:
                location.text, location.file = _to_shareable_name(location.text), ""
    return message


def _to_shareable_name(name: str) -> str:
    return Path(name).name if Path(name).is_absolute() else name


def _find_robot_displays(manager: VisualizationManager) -> tuple[RobotModelDisplay | None, RobotModelDisplay | None]:
    """Return the displays of the old and the new robot, with None for a removed display."""
    models = manager.robot_models()
    old = next((model for model in models if _get_description_topic(model) == DESCRIPTION_TOPIC), None)
    return old, next((model for model in models if _get_description_topic(model) != DESCRIPTION_TOPIC), None)


def _get_description_topic(display: RobotModelDisplay) -> str:
    return display.properties.text("Description Topic")


def _find_compared_robots(manager: VisualizationManager) -> tuple[Robot | None, Robot | None]:
    old, new = _find_robot_displays(manager)
    return None if old is None else old.robot, None if new is None else new.robot


def _get_display_id(display: RobotModelDisplay | None) -> str:
    return "" if display is None else display.id


def _find_link_marks(comparison: Comparison, old: Robot, new: Robot) -> tuple[dict[str, Mark], dict[str, Mark]]:
    """Return the marks of the links that differ by name, for the old and for the new robot."""
    old_marks: dict[str, Mark] = {name: "removed" for name in old.links if name not in comparison.links}
    old_names = {new_name: name for name, new_name in comparison.links.items()}
    new_marks: dict[str, Mark] = {name: "added" for name in new.links if name not in old_names}
    for difference in comparison.differences:
        if difference.subject == "link":
            link: str | None = difference.name
        elif difference.subject == "joint" and difference.kind == "removed":
            link = comparison.links.get(old.joints[difference.name].child)
        else:
            link = new.joints[difference.name].child if difference.subject == "joint" else None
        if link in old_names:
            new_marks[link] = "changed"
    return old_marks, new_marks


def _find_links_of_same_shape(comparison: Comparison) -> dict[str, str]:
    """Return the links with unchanged visuals and collisions: new names by old names."""
    changed_links = {
        difference.name
        for difference in comparison.differences
        if difference.subject == "link" and difference.property.startswith(("visual", "collision"))
    }
    return {old: new for old, new in comparison.links.items() if new not in changed_links}


def _make_compared_item(difference: Difference, old: Robot, new: Robot, pair: Pair) -> ComparedItem:
    kind, name, in_old = _find_element(difference, old, new)
    return ComparedItem(
        subject=difference.subject,
        name=difference.name,
        kind=difference.kind,
        property=difference.property,
        old=difference.old,
        new=difference.new,
        unit=difference.unit,
        element=name,
        element_kind=kind,
        in_old=in_old,
        old_place=_make_compared_location(difference.old_place, pair.old),
        new_place=_make_compared_location(difference.new_place, pair.new),
    )


def _find_element(difference: Difference, old: Robot, new: Robot) -> tuple[Literal["link", "joint"], str, bool]:
    """Return the link or joint of a difference.

    Returns:
        The kind of the element, its name (empty if there is none), and whether only the old robot has it.
    """
    name = difference.name
    if difference.subject == "extension":
        name = name.partition(" ")[2]  # for example, the link of a <gazebo> element
    for robot in (new, old):
        elements: Mapping[str, Mapping[str, object]] = {"link": robot.links, "joint": robot.joints}
        if difference.subject != "joint" and name in elements["link"]:
            return "link", name, robot is old
        if difference.subject != "link" and name in elements["joint"]:
            return "joint", name, robot is old
    return "link", "", False


def _make_compared_location(location: DifferenceLocation | None, model: Model) -> ComparedLocation | None:
    if location is None:
        return None
    span = location.span
    return ComparedLocation(f"{model.display_name(span.file)}:{span.line}:{span.column}", span.file, span.line)
