"""One of the two networks of a bridge: the graph of other nodes and the bridge's own nodes."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field

from linkwright.graph import Graph
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.graph.names.rules import NodeIdentity, Remappings
from linkwright.wire.background import BackgroundTransport

ENCLAVE = "/linkwright_bridge"
"""The prefix of the enclave of a bridge's nodes, ``/linkwright_bridge/<id of the bridge>``.

Other bridges use the enclave to distinguish these nodes from the network's own nodes. The enclave has no other use
without security.
"""

EndpointKey = tuple[str, EndpointKind, str, str]
"""The node, kind, name and type of a publisher or service."""


@dataclass
class Snapshot:
    """The nodes and endpoints of a network at one time, except nodes of bridges.

    Attributes:
        nodes: the nodes.
        endpoints: the endpoints whose node is known.
        subscriptions: the subscriptions, by topic.
        services_with_server: the names of services that have a server.
        mirrored_endpoints: the endpoints that bridges with precedence carry to this network, so that this bridge does
            not.
        mirrored_nodes: the full names of the nodes that those bridges mirror in this network.
        bridge_gids: the GIDs of publishers of other bridges.
    """

    nodes: list[NodeIdentity] = field(default_factory=list)
    endpoints: list[EndpointInfo] = field(default_factory=list)
    subscriptions: dict[str, list[EndpointInfo]] = field(default_factory=dict)
    services_with_server: set[str] = field(default_factory=set)
    mirrored_endpoints: set[EndpointKey] = field(default_factory=set)
    mirrored_nodes: set[str] = field(default_factory=set)
    bridge_gids: set[bytes] = field(default_factory=set)


class BridgedNetwork:
    """One of the two networks of a bridge.

    Args:
        label: the name of the network in messages.
        graph: the bridge's graph in this network.
        transport: the transport that connects the graph to the network.
        bridge_id: the ID of the bridge.
        needs_hashes: whether a publisher can be created only if its type, or the hash of its type, is known.
    """

    def __init__(
        self, label: str, graph: Graph, transport: BackgroundTransport, bridge_id: str, *, needs_hashes: bool
    ) -> None:
        self.label = label
        self.needs_hashes = needs_hashes
        self.graph = graph
        self._transport = transport
        self._bridge_id = bridge_id
        self._enclave = f"{ENCLAVE}/{bridge_id}"
        self.snapshot = Snapshot()
        self.bridge_node = self.open_node(NodeIdentity(f"linkwright_bridge_{bridge_id}", "/"))

    async def join(self, seconds: float) -> None:
        """Wait until the network is joined.

        Args:
            seconds: the longest wait; if the settings require waiting for a router, they determine the longest wait
                instead.

        Raises:
            LinkwrightError: DDS102, DDS111, DDS112, the network cannot be joined.
        """
        while (
            not await asyncio.to_thread(self._transport.wait_until_ready, seconds) and self._transport.waits_for_others
        ):
            pass  # the transport logs what it is waiting for
        if self._transport.problem is not None:
            raise self._transport.problem

    def open_node(self, node: NodeIdentity) -> NodeHandle:
        """Create a node of the bridge that has a name but no endpoints."""
        return self.graph.open_node(NodeIdentity(node.name, node.namespace, self._enclave), Remappings(()))

    def watch(self, callback: Callable[[], None]) -> None:
        """Register a callback for changes to the remote graph and for lost publishers.

        The callback may be called from any thread. This method also starts discovery.
        """
        self._transport.watch(callback)
        self._transport.watch_lost(lambda _publisher: callback())
        self._transport.start_discovery()

    def update(self) -> None:
        """Update `snapshot` to the nodes and endpoints that are known now."""
        snapshot = Snapshot()
        for node in self._transport.remote_nodes():
            other_bridge_id = _find_owning_bridge(node)
            if not other_bridge_id:
                snapshot.nodes.append(node)
            elif other_bridge_id < self._bridge_id:
                snapshot.mirrored_nodes.add(node.full_name)
        for endpoint in self._transport.remote_endpoints():
            if endpoint.node is None:
                continue
            other_bridge_id = _find_owning_bridge(endpoint.node)
            if other_bridge_id:
                snapshot.bridge_gids.add(endpoint.gid)
                if other_bridge_id < self._bridge_id:
                    snapshot.mirrored_endpoints.add(make_endpoint_key(endpoint))
                continue
            snapshot.endpoints.append(endpoint)
            if endpoint.kind is EndpointKind.SUBSCRIPTION:
                snapshot.subscriptions.setdefault(endpoint.name, []).append(endpoint)
            elif endpoint.kind is EndpointKind.SERVICE:
                snapshot.services_with_server.add(endpoint.name)
        self.snapshot = snapshot


def make_endpoint_key(endpoint: EndpointInfo) -> EndpointKey:
    """Return an identity of an endpoint that does not depend on its GID."""
    assert endpoint.node is not None
    return endpoint.node.full_name, endpoint.kind, endpoint.name, endpoint.type_name


def _find_owning_bridge(node: NodeIdentity) -> str:
    """Return the ID of the bridge that a node belongs to, or an empty string if it has none."""
    root, slash, bridge_id = node.enclave.rpartition("/")
    return bridge_id if slash and root == ENCLAVE else ""
