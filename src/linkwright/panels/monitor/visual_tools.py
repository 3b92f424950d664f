"""The panel of rviz_visual_tools, whose buttons let a program continue that waits between its steps.

The program receives sensor_msgs/msg/Joy, as from a gamepad.

Source: rviz_visual_tools (the topic, the number of buttons, and their indices).
"""

from __future__ import annotations

from typing import Any

from linkwright.graph import Publisher
from linkwright.page.audience import Page
from linkwright.page.protocol.monitor import CommandVisualTools
from linkwright.panels.page_feature import FeatureHost, PageFeature

_TOPIC = "/rviz_visual_tools_gui"
_BUTTON_COUNT = 9
_BUTTONS = {"next": 1, "continue": 2, "break": 3, "stop": 4}
"""The index of the button that each command presses."""


class VisualToolsFeature(PageFeature):
    """The feature that publishes the buttons. Its publisher exists while a page has the panel open."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._pages: set[Page] = set()
        self._publisher: Publisher[Any] | None = None

    def receive(self, page: Page, message: CommandVisualTools) -> None:
        """Publish a button."""
        self._pages.add(page)
        if self._publisher is None:
            self._publisher = self.context.node.create_publisher("sensor_msgs/msg/Joy", _TOPIC, 1)
        button = _BUTTONS.get(message.command)
        if button is not None:
            buttons = [int(index == button) for index in range(_BUTTON_COUNT)]
            self._publisher.publish(self._publisher.msg_type(buttons=buttons))

    def remove_page(self, page: Page) -> None:
        """Destroy the publisher with the last page that uses it."""
        self._pages.discard(page)
        if not self._pages:
            self.close()

    def close(self) -> None:
        """Destroy the publisher."""
        if self._publisher is not None:
            self.context.node.destroy_publisher(self._publisher)
            self._publisher = None
