"""Names and types of the graph, as rosapi returns them: sorted, and without hidden names."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from linkwright.bridge.rosbridge.globs import Globs
from linkwright.graph import EndpointInfo, EndpointKind, Node
from linkwright.graph.introspection.graph_queries import NamesAndTypes
from linkwright.graph.names.rules import is_hidden


@dataclass(frozen=True, slots=True)
class GraphLists:
    """Lists of the names in the graph.

    Attributes:
        node: the node whose graph is read.
        topic_globs: the patterns of the topics to list.
        service_globs: the patterns of the services to list.
    """

    node: Node
    topic_globs: Globs
    service_globs: Globs

    def topics(self) -> dict[str, str]:
        """Return the topics, each with its type."""
        return _keep(self.node.graph.get_topic_names_and_types(), self.topic_globs)

    def services(self) -> dict[str, str]:
        """Return the services that nodes offer, each with its type."""
        offered = {endpoint.name: endpoint.type_name for endpoint in self._find(EndpointKind.SERVICE)}
        return _keep([(name, [offered[name]]) for name in sorted(offered)], self.service_globs)

    def actions(self) -> dict[str, str]:
        """Return the actions that nodes offer, each with its type."""
        types: dict[str, str] = {}
        for name, namespace in self.node.graph.get_node_names_and_namespaces():
            for action, type_names in self.node.graph.get_action_server_names_and_types_by_node(name, namespace):
                types[action] = type_names[0]
        return _keep([(name, [types[name]]) for name in sorted(types)], self.topic_globs)

    def nodes(self) -> list[str]:
        """Return the full names of the nodes."""
        names = {node.full_name for node in self.node.graph.identities()}
        return sorted(name for name in names if not is_hidden(name))

    def node_details(self, node: str) -> tuple[list[str], list[str], list[str]]:
        """Return the topics that a node subscribes to and publishes, and the services that it offers."""

        def find_names(kind: EndpointKind) -> list[str]:
            names = {endpoint.name for endpoint in self._find(kind) if _get_node(endpoint) == node}
            return sorted(name for name in names if not is_hidden(name))

        return (
            find_names(EndpointKind.SUBSCRIPTION),
            find_names(EndpointKind.PUBLISHER),
            find_names(EndpointKind.SERVICE),
        )

    def publishers(self, topic: str) -> list[str]:
        """Return the nodes that publish a topic."""
        return self._find_nodes(
            EndpointKind.PUBLISHER, lambda endpoint: endpoint.name == topic, topic, self.topic_globs
        )

    def subscribers(self, topic: str) -> list[str]:
        """Return the nodes that subscribe to a topic."""
        return self._find_nodes(
            EndpointKind.SUBSCRIPTION, lambda endpoint: endpoint.name == topic, topic, self.topic_globs
        )

    def service_nodes(self, service: str) -> list[str]:
        """Return the nodes that offer a service."""
        return self._find_nodes(
            EndpointKind.SERVICE, lambda endpoint: endpoint.name == service, service, self.service_globs
        )

    def service_providers(self, type_name: str) -> list[str]:
        """Return the nodes that offer services of a type."""
        return self._find_nodes(
            EndpointKind.SERVICE, lambda endpoint: endpoint.type_name == type_name, type_name, Globs("")
        )

    def _find(self, *kinds: EndpointKind) -> Iterable[EndpointInfo]:
        return (endpoint for endpoint in self.node.graph.endpoints() if endpoint.kind in kinds)

    def _find_nodes(
        self, kind: EndpointKind, is_match: Callable[[EndpointInfo], bool], name: str, globs: Globs
    ) -> list[str]:
        if not globs.match(name):
            return []
        return sorted({_get_node(endpoint) for endpoint in self._find(kind) if is_match(endpoint)} - {""})


def _keep(names_and_types: NamesAndTypes, globs: Globs) -> dict[str, str]:
    return {name: types[0] for name, types in names_and_types if not is_hidden(name) and globs.match(name)}


def _get_node(endpoint: EndpointInfo) -> str:
    return "" if endpoint.node is None else endpoint.node.full_name
