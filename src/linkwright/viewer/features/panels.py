"""The panels of a configuration, for the pages that see it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.viewer.features.page_feature import PageFeature
from linkwright.viewer.protocol.message import ServerMessage
from linkwright.viewer.protocol.panels import Panels, ShowPanels
from linkwright.viewer.web.audience import Page

if TYPE_CHECKING:
    from linkwright.viewer.visualization.manager import VisualizationManager


class PanelsFeature(PageFeature):
    """Each page has panels of its own and begins with the file's; the file gets those of whoever changed theirs last.

    Other open pages are not notified: a page's panels are its own. Where there is no file there
    is nothing to save either: the browser remembers the panels.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (ShowPanels,)

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """The panels that the file shows."""
        config = manager.config
        return [Panels(manager.opened, config.document.source.name, config.panels.shown)]

    def receive(self, page: Page, message: Any) -> None:
        """Have the file show what the page shows."""
        manager = self.managers.of(page)
        config = manager.config
        if config.panels.show(message.shown) and config.path is not None:
            manager.edited()
