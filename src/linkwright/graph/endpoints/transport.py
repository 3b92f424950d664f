"""The interface of transports, which carry the traffic of a graph to other processes.

In the process a message is handed over as an object. A transport mirrors the endpoints of the process on a network; it
is called only for topics and services that other processes use. Transports are in the room `linkwright.wire`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

from linkwright.graph.endpoints.base import Presence
from linkwright.graph.endpoints.client import Client
from linkwright.graph.endpoints.info import EndpointInfo
from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.endpoints.service import Service
from linkwright.graph.endpoints.subscription import Subscription
from linkwright.graph.names.rules import NodeIdentity


class Transport(Protocol):
    """Mirrors the endpoints of one graph outside of the process.

    ``open_*`` is called for each endpoint when it is made, ``close_*`` when it is destroyed; neither may block.
    Incoming traffic goes to ``Subscription.receive(message, info)`` and ``Service.receive(request, reply,
    request_id)``, from any thread. For outgoing traffic the transport calls ``Publisher.set_outside`` and
    ``Client.set_outside`` while an endpoint outside matches, and again when none does; for a transient local publisher
    from the start, so that late joiners are served. It reports the number of matches with ``set_outside_count``, and
    the number of live publishers among them with ``Subscription.set_outside_liveliness``.
    """

    def open_node(self, node: NodeIdentity) -> None:
        """Announce a node."""

    def close_node(self, node: NodeIdentity) -> None:
        """Withdraw a node."""

    def open_publisher(self, publisher: Publisher[Any]) -> None:
        """Mirror a publisher."""

    def close_publisher(self, publisher: Publisher[Any]) -> None:
        """Stop mirroring a publisher once its reliable messages are acknowledged, or no reader is left to do so."""

    def open_subscription(self, subscription: Subscription[Any]) -> None:
        """Mirror a subscription."""

    def close_subscription(self, subscription: Subscription[Any]) -> None:
        """Stop mirroring a subscription."""

    def open_service(self, service: Service[Any, Any]) -> None:
        """Mirror a service."""

    def close_service(self, service: Service[Any, Any]) -> None:
        """Stop mirroring a service."""

    def open_client(self, client: Client[Any, Any]) -> None:
        """Mirror a client."""

    def close_client(self, client: Client[Any, Any]) -> None:
        """Stop mirroring a client."""

    def open_presence(self, presence: Presence) -> None:
        """Show an endpoint that takes no part."""

    def close_presence(self, presence: Presence) -> None:
        """Show it no longer."""

    def look_around(self) -> None:
        """Discover the nodes and endpoints outside; called before each query of them.

        A transport need not discover earlier. It may block the first time, for a few seconds at most; from then on it
        discovers everything.
        """

    def remote_nodes(self) -> Sequence[NodeIdentity]:
        """The nodes of other processes, as far as discovery has come.

        Nodes that share a name with a node of this process are among them, whoever asked before.
        """

    def remote_endpoints(self) -> Sequence[EndpointInfo]:
        """The endpoints of other processes, as far as discovery has come.

        Actions are the services and topics they are made of.
        """

    def watch(self, changed: Callable[[], None]) -> None:
        """Register a callback for changes of nodes and endpoints outside, called from any thread."""

    def watch_lost(self, lost: Callable[[EndpointInfo], None]) -> None:
        """Register a callback for publishers outside that are lost, called with each from any thread.

        Its process was killed or has crashed, or it has not been heard of for longer than it promised. It is called for
        the first time when a subscription wants to know (`Subscription.watch_lost`).
        """

    def close(self) -> None:
        """Leave the network; nothing of the transport (no thread, no socket) outlives this."""
