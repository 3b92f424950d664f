"""The panels of a configuration, for the pages that see it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.viewer.audience import Page
from linkwright.viewer.features import Desk, PageFeature
from linkwright.viewer.protocol import Panels, ServerMessage, ShowPanels

if TYPE_CHECKING:
    from linkwright.viewer.manager import VisualizationManager


class PanelsFeature(PageFeature):
    """Each page has panels of its own and begins with the file's; the file gets those of whoever changed theirs last.

    Other pages that are open are not told: nobody's panels come or go by another's hand. Where there is no file there
    is nothing to save either: the browser remembers the panels.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (ShowPanels,)

    def __init__(self, desk: Desk) -> None:
        self._desk = desk

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """The panels that the file shows."""
        config = manager.config
        return [Panels(manager.opened, config.document.source.name, config.panels.shown)]

    def receive(self, page: Page, message: Any) -> None:
        """Have the file show what the page shows."""
        manager = self._desk.manager_of(page)
        config = manager.config
        if config.panels.show(message.shown) and config.path is not None:
            manager.edited()
