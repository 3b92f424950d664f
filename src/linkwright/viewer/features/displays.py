"""Messages of pages about single displays: property values, how meshes loaded, feedback of interactive markers."""

from __future__ import annotations

from typing import ClassVar

from linkwright.viewer.features.page_feature import PageFeature
from linkwright.viewer.protocol.displays import SetProperty
from linkwright.viewer.protocol.interactive_markers import MarkerFeedback
from linkwright.viewer.protocol.robot import MeshStatus
from linkwright.viewer.web.audience import Page


class DisplaysFeature(PageFeature):
    """Passes messages of pages on to displays."""

    RECEIVES: ClassVar[tuple[type, ...]] = (SetProperty, MeshStatus, MarkerFeedback)

    def receive(self, page: Page, message: SetProperty | MeshStatus | MarkerFeedback) -> None:
        """Set a property, or hand the message to its display, unless that was removed meanwhile."""
        manager = self.managers.of(page)
        if isinstance(message, SetProperty):
            manager.set_property(page, message.id, message.value)
        elif display := manager.display(message.display):
            display.receive(message)
