"""The methods of a node that ask about the graph, as ``rclpy.node.Node`` has them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkwright.graph.introspection import NamesAndTypes, TopicEndpointInfo

if TYPE_CHECKING:
    from linkwright.graph.graph import Graph


class NodeQueries:
    """What a node can ask about the graph; `Node` derives from it. Names are the node's own, which are remapped."""

    graph: Graph

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """The absolute name of a topic as this node names it."""
        raise NotImplementedError

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """The absolute name of a service as this node names it."""
        raise NotImplementedError

    def get_node_names(self) -> list[str]:
        """Names of the nodes of the graph, without namespaces."""
        return [name for name, _ in self.graph.get_node_names_and_namespaces()]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Name and namespace of each node of the graph."""
        return self.graph.get_node_names_and_namespaces()

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """Name, namespace and enclave of each node of the graph."""
        return self.graph.get_node_names_and_namespaces_with_enclaves()

    def get_topic_names_and_types(self, no_demangle: bool = False) -> NamesAndTypes:
        """The topics of the graph; see `Graph.get_topic_names_and_types`."""
        return self.graph.get_topic_names_and_types(no_demangle=no_demangle)

    def get_service_names_and_types(self) -> NamesAndTypes:
        """The services of the graph."""
        return self.graph.get_service_names_and_types()

    def get_action_names_and_types(self) -> NamesAndTypes:
        """The actions of the graph."""
        return self.graph.get_action_names_and_types()

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """The topics that a node publishes; see `Graph.get_publisher_names_and_types_by_node`."""
        return self.graph.get_publisher_names_and_types_by_node(node_name, node_namespace, no_demangle=no_demangle)

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """The topics that a node subscribes to; see `get_publisher_names_and_types_by_node`."""
        return self.graph.get_subscriber_names_and_types_by_node(node_name, node_namespace, no_demangle=no_demangle)

    def get_service_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """The services of a node; see `get_publisher_names_and_types_by_node`."""
        return self.graph.get_service_names_and_types_by_node(node_name, node_namespace)

    def get_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """The services that a node has clients of; see `get_publisher_names_and_types_by_node`."""
        return self.graph.get_client_names_and_types_by_node(node_name, node_namespace)

    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """The publishers of a topic, as this node names it unless `no_mangle` says that it is the name itself."""
        return self.graph.get_publishers_info_by_topic(topic_name if no_mangle else self.resolve_topic_name(topic_name))

    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """The subscriptions to a topic; see `get_publishers_info_by_topic`."""
        name = topic_name if no_mangle else self.resolve_topic_name(topic_name)
        return self.graph.get_subscriptions_info_by_topic(name)

    def count_publishers(self, topic_name: str) -> int:
        """How many publishers a topic has, in this process and outside."""
        return self.graph.count_publishers(self.resolve_topic_name(topic_name))

    def count_subscribers(self, topic_name: str) -> int:
        """How many subscriptions a topic has, in this process and outside."""
        return self.graph.count_subscribers(self.resolve_topic_name(topic_name))

    def count_services(self, service_name: str) -> int:
        """How many servers a service has."""
        return self.graph.count_services(self.resolve_service_name(service_name))

    def count_clients(self, service_name: str) -> int:
        """How many clients a service has."""
        return self.graph.count_clients(self.resolve_service_name(service_name))

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Block the calling thread until a node is there; whether it is. `timeout` is in seconds."""
        return self.graph.wait_for_node(fully_qualified_node_name, timeout)
