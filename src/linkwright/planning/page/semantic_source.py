"""The SRDF of the robot: from a topic, or from the parameters of move_group."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Any

from linkwright.graph import DESCRIPTION_QOS, Client
from linkwright.messages import get_service
from linkwright.rviz.displays.base.display import DisplayHost
from linkwright.rviz.displays.base.topic_display import SideTopic

NAME = "robot_description_semantic"
"""The name of the topic, and of the parameter."""


class SemanticSource:
    """Reads the SRDF from the topic ``robot_description_semantic``, or from the parameter of that name of move_group.

    Args:
        host: the host of the display.
        on_text: called with each SRDF.
    """

    def __init__(self, host: DisplayHost, on_text: Callable[[str], None]) -> None:
        self._host = host
        self._on_text = on_text
        self._topic = SideTopic(host, "std_msgs/msg/String", lambda message: self._set_text(message.data))
        self._client: Client[Any, Any] | None = None
        self._text = ""

    def start(self, namespace: str) -> None:
        """Read from a namespace, which is empty or ends with a slash."""
        self.stop()
        self._topic.listen(f"/{namespace}{NAME}", DESCRIPTION_QOS)
        service = get_service("rcl_interfaces/srv/GetParameters")
        self._client = self._host.context.node.create_client(service, f"/{namespace}move_group/get_parameters")
        self._host.context.graph_changes.watch(self._request_if_ready)
        self._request_if_ready()

    def stop(self) -> None:
        """Stop reading."""
        self._topic.close()
        self._text = ""
        self._host.context.graph_changes.unwatch(self._request_if_ready)
        if self._client is not None:
            with suppress(ValueError):  # the node may already have been destroyed
                self._host.context.node.destroy_client(self._client)
            self._client = None

    def resume(self) -> None:
        """Handle the message that was queued while time was paused."""
        self._topic.resume()

    def _request_if_ready(self) -> None:
        client = self._client
        if client is None or self._text or not client.service_is_ready():
            return
        self._host.context.graph_changes.unwatch(self._request_if_ready)
        future = client.call_async(client.srv_type.Request(names=[NAME]))

        def on_response(_: Any) -> None:
            response = future.result()
            if self._client is client and not self._text and response is not None and response.values:
                self._set_text(response.values[0].string_value)

        future.add_done_callback(on_response)

    def _set_text(self, text: str) -> None:
        if text and text != self._text:
            self._text = text
            self._on_text(text)
