"""The connection graph for clients: publishers and subscribers by topic, and services."""

from __future__ import annotations

from typing import Any

from linkwright.graph import EndpointKind, Node
from linkwright.graph.names.rules import join

Names = dict[str, list[str]]
Connections = tuple[Names, Names, Names]
"""Publishers and subscribers by topic, and providers by service: full names of nodes."""


def connections(node: Node) -> Connections:
    """Return the current connection graph of a node's graph."""
    kinds = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION, EndpointKind.SERVICE)
    found: dict[EndpointKind, dict[str, set[str]]] = {kind: {} for kind in kinds}
    for endpoint in node.graph.endpoints():
        if endpoint.kind in found and endpoint.node is not None:
            found[endpoint.kind].setdefault(endpoint.name, set()).add(join(endpoint.node.namespace, endpoint.node.name))
    published, subscribed, served = ({name: sorted(ids) for name, ids in found[kind].items()} for kind in kinds)
    return published, subscribed, served


def update(before: Connections | None, now: Connections) -> dict[str, Any]:
    """Return the message with the changes of the connection graph.

    `before` is None for a client that has no connection graph yet; the message then contains all of it.
    """
    old = before or ({}, {}, {})
    published, subscribed, served = (
        {name: ids for name, ids in new.items() if known.get(name) != ids} for known, new in zip(old, now, strict=True)
    )
    topics_before, topics_now = old[0].keys() | old[1].keys(), now[0].keys() | now[1].keys()
    for changed, known, new in ((published, old[0], now[0]), (subscribed, old[1], now[1])):
        changed.update({name: [] for name in known.keys() & topics_now if name not in new})
    return {
        "op": "connectionGraphUpdate",
        "publishedTopics": [{"name": name, "publisherIds": ids} for name, ids in published.items()],
        "subscribedTopics": [{"name": name, "subscriberIds": ids} for name, ids in subscribed.items()],
        "advertisedServices": [{"name": name, "providerIds": ids} for name, ids in served.items()],
        "removedTopics": sorted(topics_before - topics_now),
        "removedServices": sorted(old[2].keys() - now[2].keys()),
    }
