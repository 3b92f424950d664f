"""Tells pages the fields of points that their users select."""

from __future__ import annotations

from linkwright.viewer.features.page_feature import PageFeature
from linkwright.viewer.protocol.points import AskPoint, PointFields
from linkwright.viewer.web.audience import Page


class PointsFeature(PageFeature):
    """Answers questions about points: pages have only places and colours."""

    RECEIVES = (AskPoint,)

    def receive(self, page: Page, message: AskPoint) -> None:
        """Answer, if the point is still shown."""
        from linkwright.viewer.displays.point_clouds import CloudDisplay

        display = self.managers.of(page).display(message.display)
        if not isinstance(display, CloudDisplay):
            return
        fields = display.fields_of(message.key, message.index)
        if fields is not None:
            page.send(PointFields(message.display, message.key, message.index, fields))
