"""The types of topics, as far as the graph knows them."""

from __future__ import annotations

from linkwright.bridge.rosbridge.requests import RequestError
from linkwright.graph import EndpointKind, Node

_TOPIC_KINDS = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)


def find_topic_type(node: Node, topic: str, expected: str | None) -> str:
    """Return the type of a topic.

    Args:
        node: the node whose graph has the topic.
        topic: the full name of the topic.
        expected: the full name of the type that a client expects; None if it expects none.

    Raises:
        RequestError: the topic has another type, or is unknown and no type is expected.
    """
    types = sorted(
        {
            endpoint.type_name
            for endpoint in node.graph.endpoints()
            if endpoint.name == topic and endpoint.kind in _TOPIC_KINDS
        }
    )
    if expected is None:
        if not types:
            raise RequestError(f"Cannot infer topic type for topic {topic} as it is not yet advertised")
        return types[0]
    if types and expected not in types:
        raise RequestError(
            f"Tried to register topic {topic} with type {expected[:200]} but it is already established with type "
            f"{types[0]}"
        )
    return expected


def find_service_type(node: Node, service: str) -> str | None:
    """Return the type of a service, or None if no node offers it."""
    return next(
        (
            endpoint.type_name
            for endpoint in node.graph.endpoints()
            if endpoint.name == service and endpoint.kind is EndpointKind.SERVICE
        ),
        None,
    )
