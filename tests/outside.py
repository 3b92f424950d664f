"""What other processes are to a graph, without processes: publishers that send, leave and are lost when a test says."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from linkwright.graph import EndpointInfo, EndpointKind, Graph, MessageInfo, NodeIdentity, QoSProfile
from linkwright.graph.endpoints.bus import Transport
from linkwright.messages import serialize


class Outside(Transport):
    """A transport to nowhere: what comes in is what its `Stranger`s send."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.lose: Callable[[EndpointInfo], None] | None = None
        self.publishers: list[EndpointInfo] = []
        graph.attach(self)

    def look_around(self) -> None:
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

    def _mirror(self, what: object) -> None:
        pass

    open_node = close_node = open_publisher = close_publisher = open_subscription = close_subscription = _mirror
    open_service = close_service = open_client = close_client = _mirror


class Stranger:
    """A publisher of another process.

    Args:
        outside: the transport.
        topic: its absolute name.
        node: whose it is.
        msg_type: its type.
    """

    def __init__(
        self, outside: Outside, topic: str, node: str = "driver", msg_type: str = "geometry_msgs/msg/Twist"
    ) -> None:
        self._outside = outside
        gid = f"{node}{topic}".encode().ljust(16, b".")[:16]
        self._info = EndpointInfo(EndpointKind.PUBLISHER, NodeIdentity(node, "/"), topic, msg_type, QoSProfile(10), gid)
        outside.publishers.append(self._info)

    def send(self, message: Any) -> None:
        """Have all subscriptions of the topic receive a message."""
        for subscription in self._outside.graph.bus.subscriptions(self._info.name):
            subscription.receive(serialize(message), MessageInfo(0, 0, self._info.gid, from_outside=True))

    def be_lost(self) -> None:
        """End without a word."""
        assert self._outside.lose is not None, "nobody wants to know who is lost"
        self._outside.publishers.remove(self._info)
        self._outside.lose(self._info)
