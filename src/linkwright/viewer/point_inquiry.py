"""Tells pages the fields of points that their users select."""

from __future__ import annotations

from linkwright.viewer.audience import Page
from linkwright.viewer.features import Desk, PageFeature
from linkwright.viewer.protocol import AskPoint, PointFields


class PointInquiry(PageFeature):
    """Answers questions about points: pages have only places and colours.

    Args:
        desk: says what a page sees.
    """

    RECEIVES = (AskPoint,)

    def __init__(self, desk: Desk) -> None:
        self._desk = desk

    def receive(self, page: Page, message: AskPoint) -> None:
        """Answer, if the point is still shown."""
        from linkwright.viewer.displays.cloud_display import CloudDisplay

        display = self._desk.manager_of(page).display(message.display)
        if not isinstance(display, CloudDisplay):
            return
        fields = display.fields_of(message.key, message.index)
        if fields is not None:
            page.send(PointFields(message.display, message.key, message.index, fields))
