"""A second topic of a display: the CameraInfo of an image, the updates of a map."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import QoSProfile, Subscription
from linkwright.viewer.displays.base.host import DisplayHost


class SideTopic:
    """Listens to a topic that goes along with the display's own. While time is paused its messages wait.

    Args:
        host: of the display.
        message_type: of its messages.
        on_message: called with each of them.
    """

    def __init__(self, host: DisplayHost, message_type: str, on_message: Callable[[Any], None]) -> None:
        self._host = host
        self._type = message_type
        self._on_message = on_message
        self._subscription: Subscription[Any] | None = None
        self._held: deque[Any] = deque()

    def listen(self, topic: str, qos: QoSProfile) -> str | None:
        """Subscribe to a topic instead of the one before; returns RViz's words for why that failed, or None."""
        self.close()
        self._held = deque(maxlen=max(1, qos.depth))
        try:
            self._subscription = self._host.context.node.create_subscription(self._type, topic, self._received, qos)
        except LinkwrightError as error:
            return f"Error subscribing: {error.diagnostics[0].message}"
        return None

    def close(self) -> None:
        """Stop listening."""
        if self._subscription is not None:
            with suppress(ValueError):  # the node may have been destroyed before
                self._host.context.node.destroy_subscription(self._subscription)
            self._subscription = None
        self._held.clear()

    def go_on(self) -> None:
        """Handle the messages that were held while time was paused."""
        while self._held and not self._host.time.paused:
            self._on_message(self._held.popleft())

    def _received(self, message: Any) -> None:
        if self._host.time.paused:
            self._held.append(message)
        else:
            self._on_message(message)


def camera_info_topic(image: str) -> str:
    """Where the CameraInfo of an image topic is by ROS's convention: beside the image, whatever its transport."""
    for transport in ("/compressed", "/compressedDepth", "/theora"):
        image = image.removesuffix(transport)
    return image.rpartition("/")[0] + "/camera_info"
