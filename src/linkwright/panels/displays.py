"""Displays for pages: setting properties, selections, and the content of the Add dialog."""

from __future__ import annotations

from weakref import WeakKeyDictionary

from linkwright.graph import DurabilityPolicy, Node, ReliabilityPolicy
from linkwright.page.audience import Page
from linkwright.page.protocol.configuration import DisplayChoices, DisplayClass, SetProperty, TopicChoice
from linkwright.page.protocol.images import ImageSize
from linkwright.page.protocol.markers import MarkerFeedback
from linkwright.page.protocol.points import AskPoint, PointFields
from linkwright.page.protocol.robot import MeshStatus
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.rviz.config.former_names import GROUP
from linkwright.rviz.config.schema import PropertySpec
from linkwright.rviz.displays.base.display import ViewerDisplay
from linkwright.rviz.displays.catalogue import display_classes


class DisplaysFeature(PageFeature):
    """Passes messages of pages on to the displays that they concern."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._sizes: WeakKeyDictionary[ViewerDisplay, dict[Page, ImageSize]] = WeakKeyDictionary()

    def receive(self, page: Page, message: SetProperty | MeshStatus | MarkerFeedback | ImageSize) -> None:
        """Set a property, or pass the message on; a message for a removed display is ignored."""
        manager = self.managers.of(page)
        if isinstance(message, SetProperty):
            manager.set_property(page, message.id, message.value)
        elif display := manager.display(message.display):
            if isinstance(message, ImageSize):
                self._sizes.setdefault(display, {})[page] = message
                self._send_size(display)
            else:
                display.receive(message)

    def page_closed(self, page: Page) -> None:
        """Remove the panel sizes of a page, so that images fit the panels of the other pages."""
        for display, sizes in list(self._sizes.items()):
            if sizes.pop(page, None) is not None:
                self._send_size(display)

    def _send_size(self, display: ViewerDisplay) -> None:
        """Send a display the largest width and height of its panels in all pages, or 0 if there are none."""
        sizes = self._sizes[display].values()
        width = max((size.width for size in sizes), default=0)
        height = max((size.height for size in sizes), default=0)
        display.receive(ImageSize(display.id, width, height))


class PointsFeature(PageFeature):
    """Sends pages the fields of selected points; without it, pages know only positions and colours."""

    def receive(self, page: Page, message: AskPoint) -> None:
        """Send the fields of a point, if it is still shown."""
        from linkwright.rviz.displays.point_clouds import CloudDisplay

        display = self.managers.of(page).display(message.display)
        if not isinstance(display, CloudDisplay):
            return
        fields = display.fields_of(message.key, message.index)
        if fields is not None:
            page.send(PointFields(message.display, message.key, message.index, fields))


def choices(node: Node) -> DisplayChoices:
    """Return the display classes for the Add dialog, groups last, and the topics of other nodes.

    All displays are imported for this, so pages request it only when the user opens the dialog.
    """
    displays = sorted(display_classes(), key=lambda display: (display.CLASS == GROUP, display.CLASS))
    by_message: dict[str, list[str]] = {}
    for display in displays:
        for message in display.messages_shown():
            by_message.setdefault(message, []).append(display.CLASS)
    return DisplayChoices(
        classes=[DisplayClass(display.CLASS, list(display.messages_shown())) for display in displays],
        topics=[
            TopicChoice(topic, message, sorted(by_message.get(message, [])))
            for topic, messages in sorted(node.get_topic_names_and_types())
            for message in messages
            if any(info.node_name != node.get_name() for info in node.get_publishers_info_by_topic(topic))
        ],
    )


def show_topic(display: ViewerDisplay, topic: str) -> None:
    """Set the topic of a new display, with a QoS that its publishers offer.

    RViz uses its default QoS, with which the Best Effort messages of a sensor are not received.
    """
    path = display.TOPIC
    spec = next((spec for spec in display.schema() if (spec.name,) == path[:1]), None)
    if spec is None:
        return
    display.properties.set(path, display.topic_value(topic))
    parts = {part.name for part in _at(spec, path).children}
    offers = [info.qos_profile for info in display.context.node.get_publishers_info_by_topic(topic)]
    if not offers:
        return
    if "Reliability Policy" in parts and any(offer.reliability is ReliabilityPolicy.BEST_EFFORT for offer in offers):
        display.properties.set((*path, "Reliability Policy"), "Best Effort")
    if "Durability Policy" in parts and all(offer.durability is DurabilityPolicy.TRANSIENT_LOCAL for offer in offers):
        display.properties.set((*path, "Durability Policy"), "Transient Local")


def _at(spec: PropertySpec, path: tuple[str, ...]) -> PropertySpec:
    for name in path[1:]:
        spec = next(child for child in spec.children if child.name == name)
    return spec
