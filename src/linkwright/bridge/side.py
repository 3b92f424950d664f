"""One of the two networks that a bridge connects: the graph of other nodes there, and the bridge's own nodes."""

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
"""Nodes that a bridge has in a network are in the enclave ``/linkwright_bridge/<id of the bridge>``, by which other
bridges distinguish them from the network's own. Only security uses a node's enclave."""

Provision = tuple[str, EndpointKind, str, str]
"""Node, kind, name and type of a publisher or service."""


@dataclass
class Snapshot:
    """The nodes and endpoints of a network at one time, without those of bridges.

    Attributes:
        nodes: the nodes.
        endpoints: the endpoints whose node is known.
        demanded: the subscriptions, by topic.
        served: the names of services that have a server.
        carried: the endpoints that bridges with precedence carry to this network, so that this bridge does not.
        carried_nodes: the full names of the nodes that those bridges mirror in this network.
        by_bridges: the GIDs of publishers of other bridges.
    """

    nodes: list[NodeIdentity] = field(default_factory=list)
    endpoints: list[EndpointInfo] = field(default_factory=list)
    demanded: dict[str, list[EndpointInfo]] = field(default_factory=dict)
    served: set[str] = field(default_factory=set)
    carried: set[Provision] = field(default_factory=set)
    carried_nodes: set[str] = field(default_factory=set)
    by_bridges: set[bytes] = field(default_factory=set)


class Side:
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
        self.seen = Snapshot()
        self.own = self.open_node(NodeIdentity(f"linkwright_bridge_{bridge_id}", "/"))

    async def join(self, seconds: float) -> None:
        """Wait until the network is joined.

        Args:
            seconds: the longest wait; if the settings require waiting for a router, they determine the longest wait
                instead.

        Raises:
            LinkwrightError: DDS102, DDS111, DDS112, the network cannot be joined.
        """
        while not await asyncio.to_thread(self._transport.wait_until_ready, seconds) and self._transport.waits:
            pass  # the transport logs what it is waiting for
        if self._transport.problem is not None:
            raise self._transport.problem

    def open_node(self, node: NodeIdentity) -> NodeHandle:
        """Create a node of the bridge that has a name but no endpoints."""
        return self.graph.open_node(NodeIdentity(node.name, node.namespace, self._enclave), Remappings(()))

    def watch(self, changed: Callable[[], None]) -> None:
        """Register a callback for every change of the graph, including processes that were killed.

        The callback is called from any thread.
        """
        self._transport.watch(changed)
        self._transport.watch_lost(lambda _publisher: changed())
        self._transport.look_around()

    def update(self) -> None:
        """Update the snapshot `seen`."""
        seen = Snapshot()
        for node in self._transport.remote_nodes():
            other = _bridge_of(node)
            if not other:
                seen.nodes.append(node)
            elif other < self._bridge_id:
                seen.carried_nodes.add(node.full_name)
        for endpoint in self._transport.remote_endpoints():
            if endpoint.node is None:
                continue
            other = _bridge_of(endpoint.node)
            if other:
                seen.by_bridges.add(endpoint.gid)
                if other < self._bridge_id:
                    seen.carried.add(provision_of(endpoint))
                continue
            seen.endpoints.append(endpoint)
            if endpoint.kind is EndpointKind.SUBSCRIPTION:
                seen.demanded.setdefault(endpoint.name, []).append(endpoint)
            elif endpoint.kind is EndpointKind.SERVICE:
                seen.served.add(endpoint.name)
        self.seen = seen


def provision_of(endpoint: EndpointInfo) -> Provision:
    """Return an identity of an endpoint that does not depend on its GID."""
    assert endpoint.node is not None
    return endpoint.node.full_name, endpoint.kind, endpoint.name, endpoint.type_name


def _bridge_of(node: NodeIdentity) -> str:
    """Return the ID of the bridge that a node belongs to, or an empty string for any other node."""
    root, slash, bridge_id = node.enclave.rpartition("/")
    return bridge_id if slash and root == ENCLAVE else ""
