"""Simulated publishers of other processes.

A test sends their messages, and makes them disappear.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from linkwright.graph import EndpointInfo, EndpointKind, Graph, MessageInfo, NodeIdentity, QoSProfile
from linkwright.graph.endpoints.bus import Transport
from linkwright.messages import serialize


class RemoteTransport(Transport):
    """A transport that sends nothing, and delivers the messages of its `RemotePublisher`s."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.lose: Callable[[EndpointInfo], None] | None = None
        self.publishers: list[EndpointInfo] = []
        graph.attach(self)

    def start_discovery(self) -> None:
        pass

    def remote_nodes(self) -> Sequence[NodeIdentity]:
        return list(dict.fromkeys(publisher.node for publisher in self.publishers if publisher.node is not None))

    def remote_endpoints(self) -> Sequence[EndpointInfo]:
        return self.publishers

    def watch(self, changed: Callable[[], None]) -> None:
        pass

    def watch_lost(self, lost: Callable[[EndpointInfo], None]) -> None:
        self.lose = lost

    def close(self) -> None:
        pass

    def _ignore(self, _work: object) -> None:
        pass

    open_node = close_node = open_publisher = close_publisher = open_subscription = close_subscription = _ignore
    open_service = close_service = open_client = close_client = _ignore


class RemotePublisher:
    """A publisher of another process.

    Args:
        transport: the transport that announces the publisher.
        topic: the absolute name of its topic.
        node: the name of its node.
        msg_type: the message type.
    """

    def __init__(
        self, transport: RemoteTransport, topic: str, node: str = "driver", msg_type: str = "geometry_msgs/msg/Twist"
    ) -> None:
        self._transport = transport
        gid = f"{node}{topic}".encode().ljust(16, b".")[:16]
        self._info = EndpointInfo(EndpointKind.PUBLISHER, NodeIdentity(node, "/"), topic, msg_type, QoSProfile(10), gid)
        transport.publishers.append(self._info)

    def send(self, message: Any) -> None:
        """Send a message to all subscriptions of the topic."""
        for subscription in self._transport.graph.bus.subscriptions(self._info.name):
            subscription.receive(serialize(message), MessageInfo(0, 0, self._info.gid, is_remote=True))

    def disappear(self) -> None:
        """Disappear as if the process had been killed."""
        assert self._transport.lose is not None, "the graph does not watch for lost publishers"
        self._transport.publishers.remove(self._info)
        self._transport.lose(self._info)
