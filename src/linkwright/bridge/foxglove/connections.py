"""The connection graph for clients: publishers and subscribers by topic, and services."""

from __future__ import annotations

from typing import Any

from linkwright.graph import EndpointKind, Node
from linkwright.graph.names.rules import join

Names = dict[str, list[str]]
Connections = tuple[Names, Names, Names]
"""Publishers and subscribers by topic, and providers by service: full names of nodes."""


def find_connections(node: Node) -> Connections:
    """Return the current connection graph of a node's graph."""
    kinds = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION, EndpointKind.SERVICE)
    nodes_by_kind: dict[EndpointKind, dict[str, set[str]]] = {kind: {} for kind in kinds}
    for endpoint in node.graph.endpoints():
        if endpoint.kind in nodes_by_kind and endpoint.node is not None:
            nodes_by_kind[endpoint.kind].setdefault(endpoint.name, set()).add(
                join(endpoint.node.namespace, endpoint.node.name)
            )
    published, subscribed, served = ({name: sorted(ids) for name, ids in nodes_by_kind[kind].items()} for kind in kinds)
    return published, subscribed, served


def make_connection_update(previous: Connections | None, current: Connections) -> dict[str, Any]:
    """Return the message with the changes to the connection graph.

    `previous` is None for a client that has no connection graph yet; the message then contains the entire graph.
    """
    base = previous or ({}, {}, {})
    published, subscribed, served = (
        {name: ids for name, ids in new_names.items() if old_names.get(name) != ids}
        for old_names, new_names in zip(base, current, strict=True)
    )
    previous_topics, current_topics = base[0].keys() | base[1].keys(), current[0].keys() | current[1].keys()
    for changes, old, new in ((published, base[0], current[0]), (subscribed, base[1], current[1])):
        changes.update({name: [] for name in old.keys() & current_topics if name not in new})
    return {
        "op": "connectionGraphUpdate",
        "publishedTopics": [{"name": name, "publisherIds": ids} for name, ids in published.items()],
        "subscribedTopics": [{"name": name, "subscriberIds": ids} for name, ids in subscribed.items()],
        "advertisedServices": [{"name": name, "providerIds": ids} for name, ids in served.items()],
        "removedTopics": sorted(previous_topics - current_topics),
        "removedServices": sorted(base[2].keys() - current[2].keys()),
    }
