"""Endpoints that are announced in the graph and carry no data."""

from __future__ import annotations

from linkwright.graph.endpoints.base import Endpoint
from linkwright.graph.endpoints.info import EndpointInfo, EndpointKind
from linkwright.graph.loop.node_handle import NodeHandle


class Presence(Endpoint):
    """A subscription or a client that other processes see, and that receives no messages and sends no requests.

    A bridge uses it for a subscription or client in another network, and forwards messages and responses to that one.

    Args:
        node: its node.
        info: a subscription or a client.

    Raises:
        ValueError: `info` is of another kind.
    """

    raw = True

    def __init__(self, node: NodeHandle, info: EndpointInfo) -> None:
        if info.kind not in (EndpointKind.SUBSCRIPTION, EndpointKind.CLIENT):
            raise ValueError(f"{info.kind} cannot be without a part in the graph")
        self.kind = info.kind
        self._describe(node, info.type_name, info.name, info.qos)
        self.type_hash = info.type_hash
