"""Tracks the publisher of the last command, so that a drive, for example, can stop when that publisher is lost."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import phrase
from linkwright.graph.endpoints.base import EndpointInfo, MessageInfo

if TYPE_CHECKING:
    from linkwright.graph.endpoints.drivers import DriverWatch
    from linkwright.graph.endpoints.subscription import Subscription


class Commander:
    """Tracks the publisher of the command in force, and revokes the command when that publisher is lost.

    A publisher that leaves has ended, and its last command stays in force. A publisher that is lost was killed, has
    crashed or is out of reach, so it cannot replace its command. Its loss does not affect commands of other publishers.

    Args:
        revoke: called with the publisher that is lost, after the last of its commands, as callbacks of its
            subscription are.
        drivers: receives each command of `accepting`, to warn of several publishers that command at once; None for no
            warning.
    """

    def __init__(self, revoke: Callable[[EndpointInfo], object], drivers: DriverWatch | None = None) -> None:
        self._revoke = revoke
        self._drivers = drivers
        self._gid: bytes | None = None

    def accepting(self, callback: Callable[[Any], object]) -> Callable[[Any, MessageInfo], object]:
        """A callback for a subscription to commands: it notes the publisher and passes the message on."""
        return partial(self._accept, callback)

    def note_publisher(self, info: MessageInfo) -> None:
        """Note the publisher of a command that arrived by another callback than those of `accepting`."""
        self._gid = info.publisher_gid

    def watch(self, subscription: Subscription[Any]) -> None:
        """Watch for lost publishers of a subscription; its callback is of `accepting` or calls `note_publisher`."""
        subscription.watch_lost(self._lost)

    def _accept(self, callback: Callable[[Any], object], message: Any, info: MessageInfo) -> None:
        self.note_publisher(info)
        if self._drivers is not None:
            self._drivers.hear(message, info)
        callback(message)

    def _lost(self, publisher: EndpointInfo) -> None:
        if publisher.gid == self._gid:
            self._gid = None
            self._revoke(publisher)


def describe_lost_publisher(publisher: EndpointInfo) -> Any:
    """A publisher that was lost, for the log: its node, and its topic."""
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
