"""Revoke the last command when its publisher is lost, for example to stop a drive."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import phrase
from linkwright.graph.endpoints.base import EndpointInfo, MessageInfo

if TYPE_CHECKING:
    from linkwright.graph.endpoints.command_disputes import DisputeMonitor
    from linkwright.graph.endpoints.subscription import Subscription


class CommandGuard:
    """A guard that revokes the current command when the publisher of that command is lost.

    A publisher that leaves the graph has ended in an orderly way, and its last command stays in force. A lost publisher
    was killed, has crashed or is out of reach, so it cannot replace its command. The loss of one publisher does not
    affect the commands of the others.

    Args:
        revoke: called with the lost publisher, after its last command, in the same way as the subscription's callback.
        dispute_monitor: receives each command that arrives through `tracking_callback`, and warns if several publishers
            send commands at the same time; None for no warning.
    """

    def __init__(self, revoke: Callable[[EndpointInfo], object], dispute_monitor: DisputeMonitor | None = None) -> None:
        self._revoke = revoke
        self._dispute_monitor = dispute_monitor
        self._gid: bytes | None = None

    def tracking_callback(self, callback: Callable[[Any], object]) -> Callable[[Any, MessageInfo], object]:
        """Wrap a subscription callback so that the publisher of each command is recorded first."""
        return partial(self._accept, callback)

    def note_publisher(self, info: MessageInfo) -> None:
        """Record the publisher of a command that did not arrive through `tracking_callback`."""
        self._gid = info.publisher_gid

    def watch(self, subscription: Subscription[Any]) -> None:
        """Revoke the current command if its publisher is lost on this subscription.

        The callback of `subscription` must come from `tracking_callback` or call `note_publisher`.
        """
        subscription.watch_lost(self._on_lost)

    def _accept(self, callback: Callable[[Any], object], message: Any, info: MessageInfo) -> None:
        self.note_publisher(info)
        if self._dispute_monitor is not None:
            self._dispute_monitor.record_command(message, info)
        callback(message)

    def _on_lost(self, publisher: EndpointInfo) -> None:
        if publisher.gid == self._gid:
            self._gid = None
            self._revoke(publisher)


def describe_lost_publisher(publisher: EndpointInfo) -> Any:
    """Return a log message about a lost publisher, with its node and topic."""
    node = publisher.node.full_name if publisher.node is not None else ""
    if not node:
        return phrase(
            "the publisher of the commands on '{topic}' was lost (killed, crashed or out of reach)",
            topic=publisher.name,
        )
    return phrase(
        "'{node}', which sent the commands on '{topic}', was lost (killed, crashed or out of reach)",
        node=node,
        topic=publisher.name,
    )
