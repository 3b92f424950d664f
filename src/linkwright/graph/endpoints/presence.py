"""Endpoints that are announced in the graph and carry no data."""

from __future__ import annotations

from linkwright.graph.endpoints.base import Endpoint
from linkwright.graph.endpoints.info import EndpointInfo, EndpointKind
from linkwright.graph.loop.node_handle import NodeHandle


class Presence(Endpoint):
    """A subscription or a client that other processes see, and that receives and asks nothing.

    For who hears a topic, or calls a service, in another network, where a bridge brings it what there is to hear.

    Args:
        node: whose it is.
        info: what it is: a subscription or a client.

    Raises:
        ValueError: it is something else.
    """

    raw = True

    def __init__(self, node: NodeHandle, info: EndpointInfo) -> None:
        if info.kind not in (EndpointKind.SUBSCRIPTION, EndpointKind.CLIENT):
            raise ValueError(f"{info.kind} cannot be without a part in the graph")
        self.kind = info.kind
        self._describe(node, info.type_name, info.name, info.qos)
        self.type_hash = info.type_hash
