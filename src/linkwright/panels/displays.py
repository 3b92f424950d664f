"""Displays for pages: setting properties, selections, and the content of the Add dialog."""

from __future__ import annotations

from weakref import WeakKeyDictionary

from linkwright.graph import DurabilityPolicy, Node, ReliabilityPolicy
from linkwright.page.audience import Page
from linkwright.page.protocol.configuration import DisplayChoices, DisplayClass, SetProperty, TopicChoice
from linkwright.page.protocol.images import ImageSize
from linkwright.page.protocol.markers import MarkerFeedback
from linkwright.page.protocol.points import PointFields, RequestPoint
from linkwright.page.protocol.robot import MeshStatus
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.rviz.config.former_names import GROUP
from linkwright.rviz.config.schema import PropertySpec
from linkwright.rviz.displays.base.display import ViewerDisplay
from linkwright.rviz.displays.catalog import display_classes


class DisplaysFeature(PageFeature):
    """The feature that forwards messages of pages to displays."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._sizes_by_display: WeakKeyDictionary[ViewerDisplay, dict[Page, ImageSize]] = WeakKeyDictionary()

    def receive(self, page: Page, message: SetProperty | MeshStatus | MarkerFeedback | ImageSize) -> None:
        """Set a property, or forward the message to its display.

        A message for a removed display is ignored.
        """
        manager = self.managers.of(page)
        if isinstance(message, SetProperty):
            manager.set_property(page, message.id, message.value)
        elif display := manager.display(message.display):
            if isinstance(message, ImageSize):
                self._sizes_by_display.setdefault(display, {})[page] = message
                self._send_size(display)
            else:
                display.receive(message)

    def remove_page(self, page: Page) -> None:
        """Remove the panel sizes of a page.

        Images are then sized for the other pages.
        """
        for display, sizes in list(self._sizes_by_display.items()):
            if sizes.pop(page, None) is not None:
                self._send_size(display)

    def _send_size(self, display: ViewerDisplay) -> None:
        """Send a display the maximum size of its panels in all pages, or 0 without panels."""
        sizes = self._sizes_by_display[display].values()
        width = max((size.width for size in sizes), default=0)
        height = max((size.height for size in sizes), default=0)
        display.receive(ImageSize(display.id, width, height))


class PointsFeature(PageFeature):
    """The feature that sends the fields of selected points to pages.

    Pages have only the positions and colors of points.
    """

    def receive(self, page: Page, message: RequestPoint) -> None:
        """Send the fields of a point, if it is still shown."""
        from linkwright.rviz.displays.point_clouds import CloudDisplay

        display = self.managers.of(page).display(message.display)
        if not isinstance(display, CloudDisplay):
            return
        fields = display.get_fields(message.key, message.index)
        if fields is not None:
            page.send(PointFields(message.display, message.key, message.index, fields))


def find_display_choices(node: Node) -> DisplayChoices:
    """Return the display classes and topics for the Add dialog, with groups last.

    This imports all displays. Pages therefore request it only when the user opens the dialog.
    """
    displays = sorted(display_classes(), key=lambda display: (display.CLASS == GROUP, display.CLASS))
    classes_by_message: dict[str, list[str]] = {}
    for display in displays:
        for message in display.shown_message_types():
            classes_by_message.setdefault(message, []).append(display.CLASS)
    return DisplayChoices(
        classes=[DisplayClass(display.CLASS, list(display.shown_message_types())) for display in displays],
        topics=[
            TopicChoice(topic, message, sorted(classes_by_message.get(message, [])))
            for topic, messages in sorted(node.get_topic_names_and_types())
            for message in messages
            if any(info.node_name != node.get_name() for info in node.get_publishers_info_by_topic(topic))
        ],
    )


def show_topic(display: ViewerDisplay, topic: str) -> None:
    """Set the topic of a new display, with a QoS that its publishers offer.

    RViz uses its default QoS, which does not match the Best Effort publishers of sensors.
    """
    path = display.TOPIC
    spec = next((spec for spec in display.schema() if (spec.name,) == path[:1]), None)
    if spec is None:
        return
    display.properties.set(path, display.topic_value(topic))
    child_names = {child.name for child in _find_spec(spec, path).children}
    qos_profiles = [info.qos_profile for info in display.context.node.get_publishers_info_by_topic(topic)]
    if not qos_profiles:
        return
    if "Reliability Policy" in child_names and any(
        profile.reliability is ReliabilityPolicy.BEST_EFFORT for profile in qos_profiles
    ):
        display.properties.set((*path, "Reliability Policy"), "Best Effort")
    if "Durability Policy" in child_names and all(
        qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL for qos_profile in qos_profiles
    ):
        display.properties.set((*path, "Durability Policy"), "Transient Local")


def _find_spec(spec: PropertySpec, path: tuple[str, ...]) -> PropertySpec:
    for name in path[1:]:
        spec = next(child for child in spec.children if child.name == name)
    return spec
