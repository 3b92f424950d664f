"""Follows an interactive marker server: all its markers first, then what changes; all anew when some was lost."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from linkwright.graph import Client, Node, Publisher, QoSProfile, Subscription
from linkwright.messages import get_message, get_service
from linkwright.viewer.protocol.parts import StatusLevel

_PERIOD = 0.25
"""Seconds between two looks whether the server is there."""

_UPDATE_DEPTH = 100
_UPDATE = 1


@dataclass(slots=True)
class ClientEvents:
    """What happens at a server.

    Attributes:
        everything: its markers, at the beginning and when updates were lost.
        update: a visualization_msgs/msg/InteractiveMarkerUpdate.
        gone: it has no markers now, or is there no more.
        status: how it stands, for the display's status.
    """

    everything: Callable[[list[Any]], None]
    update: Callable[[Any], None]
    gone: Callable[[], None]
    status: Callable[[StatusLevel, str], None]


class InteractiveMarkerClient:
    """Connects to one server, waiting until it is there, and again when it comes back.

    Args:
        node: to subscribe with.
        namespace: of the server.
        events: what is told.

    Raises:
        LinkwrightError: the namespace makes no name of a topic.
    """

    def __init__(self, node: Node, namespace: str, events: ClientEvents) -> None:
        self._node = node
        self._namespace = namespace.rstrip("/")
        self._events = events
        self._sequence: int | None = None
        self._early: list[Any] = []
        self._request: Any = None
        self._look: asyncio.TimerHandle | None = None
        self._subscription: Subscription[Any] = node.create_subscription(
            get_message("visualization_msgs/msg/InteractiveMarkerUpdate"),
            f"{self._namespace}/update",
            self._received,
            QoSProfile(_UPDATE_DEPTH),
        )
        self._feedback: Publisher[Any] = node.create_publisher(
            get_message("visualization_msgs/msg/InteractiveMarkerFeedback"),
            f"{self._namespace}/feedback",
            QoSProfile(_UPDATE_DEPTH),
        )
        self._service: Client[Any, Any] = node.create_client(
            get_service("visualization_msgs/srv/GetInteractiveMarkers"), f"{self._namespace}/get_interactive_markers"
        )
        self._watch()

    def publish(self, feedback: Any) -> None:
        """Tell the server what was done to a marker."""
        self._feedback.publish(feedback)

    def close(self) -> None:
        """Leave the server."""
        if self._look is not None:
            self._look.cancel()
            self._look = None
        self._request = None
        with suppress(ValueError):  # the node may have been destroyed before
            self._node.destroy_subscription(self._subscription)
            self._node.destroy_publisher(self._feedback)
            self._node.destroy_client(self._service)

    def _watch(self) -> None:
        self._look = asyncio.get_running_loop().call_later(_PERIOD, self._watch)
        there = self._service.service_is_ready()
        if not there and (self._sequence is not None or self._request is not None):
            self._begin_anew()
        if not there:
            self._events.status("warn", f"Service is not available: {self._namespace}/get_interactive_markers")
        elif self._sequence is None and self._request is None:
            self._ask()

    def _ask(self) -> None:
        self._events.status("ok", "Sending request for interactive markers")
        request = self._request = self._service.call_async(self._service.srv_type.Request())
        request.add_done_callback(lambda done: self._answered(request, done.result()))

    def _answered(self, request: Any, response: Any) -> None:
        if request is not self._request or response is None:
            return  # of a server that has gone since
        self._request = None
        self._sequence = response.sequence_number
        self._events.everything(list(response.markers))
        self._events.status("ok", "Initialized interactive marker client")
        early, self._early = self._early, []
        for update in early:
            self._received(update)

    def _received(self, update: Any) -> None:
        if self._sequence is None:
            self._early = [*self._early, update][-_UPDATE_DEPTH:]
            return
        if update.seq_num <= self._sequence and update.type == _UPDATE:
            return  # the first answer has it already
        expected = self._sequence + (1 if update.type == _UPDATE else 0)
        if update.seq_num != expected:
            self._begin_anew()
            self._events.status(
                "warn", f"Detected lost update or server restart. Resetting. Sequence {expected} expected"
            )
            return
        if update.type == _UPDATE:
            self._sequence = update.seq_num
            self._events.update(update)

    def _begin_anew(self) -> None:
        self._sequence = self._request = None
        self._early.clear()
        self._events.gone()
