"""Sends pages the differences of two descriptions that are shown in one scene."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from linkwright.page.protocol.comparison import (
    ComparedDescriptions,
    ComparedItem,
    ComparedPlace,
    ComparedRobot,
    Mark,
)
from linkwright.page.protocol.message import ServerMessage
from linkwright.panels.comparison.old_robot import PREFIX, TOPIC, OldRobot, joints_that_follow
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.rviz.config.rviz_config import RvizConfig

if TYPE_CHECKING:
    from linkwright.descriptions.comparison import Comparison, Difference, Place
    from linkwright.descriptions.pairs import Model, Pair
    from linkwright.graph import Node
    from linkwright.rviz.displays.robot_model import RobotModelDisplay
    from linkwright.rviz.visualization.manager import VisualizationManager
    from linkwright.urdf import Robot

_ALPHA = 0.4


def show_old(config: RvizConfig, name: str) -> None:
    """Add a translucent display of the old robot to the configuration of the new robot."""
    display = config.make("rviz_default_plugins/RobotModel", name)
    for path, value in (
        (("Description Topic", "Value"), TOPIC),
        (("TF Prefix",), PREFIX),
        (("Alpha",), f"{_ALPHA:g}"),
    ):
        display.section.put(path, value, string=path[-1] != "Alpha")
    config.insert(display)


class ComparisonFeature(PageFeature):
    """Compares the robots of two displays whenever one of them changes, once a pair is attached."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._pair: Pair | None = None
        self._old: OldRobot | None = None
        self._compared: tuple[Robot, Robot, Comparison] | None = None
        self._sent: dict[VisualizationManager, ComparedDescriptions] = {}

    def attach(self, pair: Pair, node: Node) -> Callable[[str], None]:
        """Begin to show pages the differences between two descriptions.

        Args:
            pair: the descriptions; their displays are those of `RvizConfig.for_model` and of `show_old`.
            node: publishes the old description and its transforms.

        Returns:
            A function to call with each new text of the old description.
        """
        self._pair, self._old = pair, OldRobot(node, self.context.node)
        return self._old.publish

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the differences that were last sent to pages."""
        message = self._message(manager)
        if message is None:
            return []
        self._sent[manager] = message
        return [message]

    def robot_changed(self) -> None:
        """Compare the robots that the displays show now."""
        if self._pair is None or self._old is None:
            return
        old, new = next(
            (pair for manager in self.managers.all() if None not in (pair := _robots(manager))), (None, None)
        )
        if old is None or new is None:
            return
        if self._compared is None or self._compared[0] is not old or self._compared[1] is not new:
            comparison = self._pair.compare(old, new)
            self._compared = old, new, comparison
            self._old.place(old, new, comparison)
        for manager in self.managers.all():
            self._publish(manager)

    def edited(self, manager: VisualizationManager) -> None:
        """Compare again, since displays may have been added or removed."""
        self._publish(manager)

    def manager_closed(self, manager: VisualizationManager) -> None:
        """Discard the differences that were sent to the manager's pages."""
        self._sent.pop(manager, None)

    def _publish(self, manager: VisualizationManager) -> None:
        message = self._message(manager)
        if message is not None and message != self._sent.get(manager):
            self._sent[manager] = message
            manager.publish(message)

    def _message(self, manager: VisualizationManager) -> ComparedDescriptions | None:
        if self._pair is None or self._compared is None:
            return None
        old, new, comparison = self._compared
        old_marks, new_marks = _marks(comparison, old, new)
        shows_old, shows_new = _displays(manager)
        return ComparedDescriptions(
            ComparedRobot(_identity(shows_old), self._pair.old.label(), old_marks),
            ComparedRobot(_identity(shows_new), self._pair.new.label(), new_marks),
            joints_that_follow(old, new, comparison.joints),
            _links_of_same_shape(comparison),
            [_item(difference, old, new, self._pair) for difference in comparison.differences],
        )


def without_paths(message: ComparedDescriptions) -> ComparedDescriptions:
    """Replace absolute paths in a comparison by file names, so that it can be shared; return it."""
    for compared_robot in (message.old, message.new):
        compared_robot.label = _shareable(compared_robot.label)
    for item in message.items:
        for place in (item.old_place, item.new_place):
            if place is not None:
                place.text, place.file = _shareable(place.text), ""
    return message


def _shareable(name: str) -> str:
    return Path(name).name if Path(name).is_absolute() else name


def _displays(manager: VisualizationManager) -> tuple[RobotModelDisplay | None, RobotModelDisplay | None]:
    """Return the displays of the old and of the new robot; None for a display that was removed."""
    models = manager.robot_models()
    old = next((model for model in models if _topic_of(model) == TOPIC), None)
    return old, next((model for model in models if _topic_of(model) != TOPIC), None)


def _topic_of(display: RobotModelDisplay) -> str:
    return display.properties.text("Description Topic")


def _robots(manager: VisualizationManager) -> tuple[Robot | None, Robot | None]:
    old, new = _displays(manager)
    return None if old is None else old.robot, None if new is None else new.robot


def _identity(display: RobotModelDisplay | None) -> str:
    return "" if display is None else display.id


def _marks(comparison: Comparison, old: Robot, new: Robot) -> tuple[dict[str, Mark], dict[str, Mark]]:
    """Return the marks of the links that differ, by name: of the old robot, and of the new robot."""
    of_old: dict[str, Mark] = {name: "removed" for name in old.links if name not in comparison.links}
    before = {after: name for name, after in comparison.links.items()}
    of_new: dict[str, Mark] = {name: "added" for name in new.links if name not in before}
    for difference in comparison.differences:
        if difference.subject == "link":
            link: str | None = difference.name
        elif difference.subject == "joint" and difference.kind == "removed":
            link = comparison.links.get(old.joints[difference.name].child)
        else:
            link = new.joints[difference.name].child if difference.subject == "joint" else None
        if link in before:
            of_new[link] = "changed"
    return of_old, of_new


def _links_of_same_shape(comparison: Comparison) -> dict[str, str]:
    """Return the links whose visuals and collisions are unchanged: new names by old names."""
    other = {
        difference.name
        for difference in comparison.differences
        if difference.subject == "link" and difference.property.startswith(("visual", "collision"))
    }
    return {old: new for old, new in comparison.links.items() if new not in other}


def _item(difference: Difference, old: Robot, new: Robot, pair: Pair) -> ComparedItem:
    kind, name, in_old = _element(difference, old, new)
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
        old_place=_place(difference.old_place, pair.old),
        new_place=_place(difference.new_place, pair.new),
    )


def _element(difference: Difference, old: Robot, new: Robot) -> tuple[Literal["link", "joint"], str, bool]:
    """Return the link or joint to which a difference belongs.

    Returns:
        The kind of the element, its name (empty if there is none), and whether only the old robot has it.
    """
    name = difference.name
    if difference.subject == "extension":
        name = name.partition(" ")[2]  # such as the link of a <gazebo> element
    for robot in (new, old):
        elements: Mapping[str, Mapping[str, object]] = {"link": robot.links, "joint": robot.joints}
        if difference.subject != "joint" and name in elements["link"]:
            return "link", name, robot is old
        if difference.subject != "link" and name in elements["joint"]:
            return "joint", name, robot is old
    return "link", "", False


def _place(place: Place | None, model: Model) -> ComparedPlace | None:
    if place is None:
        return None
    span = place.span
    return ComparedPlace(f"{model.named(span.file)}:{span.line}:{span.column}", span.file, span.line)
