"""Opens the panels that programs such as ``rqt_plot`` request, in all pages of a viewer."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, cast

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import get_message
from linkwright.page.protocol.message import ServerMessage
from linkwright.page.protocol.requested_panels import (
    RequestedPanel,
    RequestedPanelName,
    RequestedPanels,
    RequestedSeries,
    RequestedVelocities,
)
from linkwright.panels.displays import show_topic
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.panels.panel_request import PanelRequest
from linkwright.panels.plotted_fields import find_numeric_fields, split_fields, split_topic

if TYPE_CHECKING:
    from linkwright.rviz.displays.base.display import ViewerDisplay
    from linkwright.rviz.visualization.manager import VisualizationManager

_RELIABILITY = "Reliability Policy"


class RequestedPanelsFeature(PageFeature):
    """The feature that opens requested panels, in open pages and in pages that open later."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._panels: list[RequestedPanel] = []
        self._pending_fields: dict[int, list[str]] = {}

    def add(self, request: PanelRequest) -> None:
        """Open a panel.

        A display that the panel needs is added to the configuration that pages share. Fields of topics that do not
        exist yet are plotted as soon as the topics exist.
        """
        number = len(self._panels) + 1
        panel = RequestedPanel(
            number,
            cast("RequestedPanelName", request.panel),
            self._find_or_add_display(request).id if request.display_class else None,
            [],
            request.node or None,
            RequestedVelocities(request.topic, request.stamped, request.linear, request.angular)
            if request.panel == "teleop"
            else None,
        )
        self._panels.append(panel)
        fields = [field for argument in request.fields for field in split_fields(argument)]
        if fields:
            if not self._pending_fields:
                self.context.graph_changes.watch(self._resolve_fields)
            self._pending_fields[number] = fields
            self._resolve_fields()
        self.context.pages.publish(self._make_message())

    def configuration_messages(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the requested panels.

        They are sent after the panels of the file, so that they open in front of them.
        """
        return [self._make_message()]

    def close(self) -> None:
        """Stop waiting for topics."""
        self._pending_fields.clear()
        self.context.graph_changes.unwatch(self._resolve_fields)

    def _make_message(self) -> RequestedPanels:
        return RequestedPanels(list(self._panels))

    # --- displays ----------------------------------------------------------------------------------------------

    def _find_or_add_display(self, request: PanelRequest) -> ViewerDisplay:
        """Return the enabled display of the requested class and topic.

        If there is none, a display is added.

        The configuration does not count as changed by the user.
        """
        manager = self.managers.shared
        was_saved = not manager.history.has_unsaved_edits
        display = next(
            (
                display
                for display in manager.displays
                if display.config.cls == request.display_class and _get_topic(display) == request.topic
            ),
            None,
        )
        if display is None:
            name = request.display_class.rpartition("/")[2]
            entry = manager.config.make_display(request.display_class, name)
            display = manager.tree.add(entry, prepare=partial(_set_topic, topic=request.topic))
        elif not display.config.checked:
            manager.tree.check(display, True)
        if was_saved:
            manager.history.mark_saved()
        return display

    # --- plots -------------------------------------------------------------------------------------------------

    def _resolve_fields(self) -> None:
        """Find the topics of fields that are not plotted yet, and send pages the new series."""
        topics = self.context.node.graph.topics()
        has_new = False
        for number, fields in list(self._pending_fields.items()):
            remaining_fields = [field for field in fields if not self._resolve_field(number, field, topics)]
            has_new = has_new or len(remaining_fields) < len(fields)
            self._pending_fields[number] = remaining_fields
            if not remaining_fields:
                del self._pending_fields[number]
        if not self._pending_fields:
            self.context.graph_changes.unwatch(self._resolve_fields)
        if has_new:
            self.context.pages.publish(self._make_message())

    def _resolve_field(self, number: int, field: str, topics: dict[str, list[str]]) -> bool:
        """Add the series of a field to a panel, and return whether the topic of the field exists."""
        split = split_topic(field, topics)
        if split is None:
            return False
        topic, path = split
        try:
            paths = list(find_numeric_fields(path, get_message(topics[topic][0])))
        except LinkwrightError:
            paths = [path] if path else []  # the plot shows why the type of the topic is not known
        self._panels[number - 1].series.extend(RequestedSeries(topic, series_path) for series_path in paths)
        return True


def _get_topic(display: ViewerDisplay) -> str:
    """Return the topic of a display; empty if it has none."""
    has_topic = any((spec.name,) == display.TOPIC[:1] for spec in display.schema())
    return display.properties.text(*display.TOPIC) if has_topic else ""


def _set_topic(display: ViewerDisplay, topic: str) -> None:
    """Set the topic of a new display, and subscribe as ``rqt_image_view`` does.

    The reliability is Best Effort.

    This matches all publishers, also those that do not exist yet.
    """
    if topic:
        show_topic(display, topic)
        display.properties.set((*display.TOPIC, _RELIABILITY), "Best Effort")
