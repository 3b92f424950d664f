"""The methods of a node that ask about the graph, as ``rclpy.node.Node`` has them."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Concatenate, ParamSpec, TypeVar

from linkwright.graph.introspection.graph_queries import GraphQueries, TopicEndpointInfo
from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.graph.names.rules import InvalidNameError, join

P = ParamSpec("P")
R = TypeVar("R")


class NodeQueries:
    """A node's queries about the graph, a base of `Node`. Names are relative to the node, and remapped."""

    def __init__(self, graph: GraphQueries, handle: NodeHandle) -> None:
        # The names are mangled, for users' nodes to have attributes of these names.
        self.__graph = graph
        self.__handle = handle

    @staticmethod
    def _of_graph(question: Callable[Concatenate[GraphQueries, P], R]) -> Callable[Concatenate[NodeQueries, P], R]:
        """The method by which a node asks its graph the same question; for the lines below."""

        @wraps(question)
        def ask(node: NodeQueries, /, *args: P.args, **kwargs: P.kwargs) -> R:
            return question(node.__graph, *args, **kwargs)

        return ask

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """The absolute name of a topic as this node names it, expanded and, unless `only_expand`, remapped.

        Raises:
            InvalidTopicNameError: it is not valid.
        """
        return self.__handle.resolve_topic_name(topic, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """The absolute name of a service or action as this node names it; see `resolve_topic_name`.

        Raises:
            InvalidServiceNameError: it is not valid.
        """
        return self.__handle.resolve_service_name(service, only_expand=only_expand)

    def get_node_names(self) -> list[str]:
        """Names of the nodes of the graph, without namespaces."""
        return [name for name, _ in self.__graph.get_node_names_and_namespaces()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """Full names of the nodes of the graph."""
        return [join(namespace, name) for name, namespace in self.__graph.get_node_names_and_namespaces()]

    get_node_names_and_namespaces = _of_graph(GraphQueries.get_node_names_and_namespaces)
    get_node_names_and_namespaces_with_enclaves = _of_graph(GraphQueries.get_node_names_and_namespaces_with_enclaves)
    get_topic_names_and_types = _of_graph(GraphQueries.get_topic_names_and_types)
    get_service_names_and_types = _of_graph(GraphQueries.get_service_names_and_types)
    get_action_names_and_types = _of_graph(GraphQueries.get_action_names_and_types)
    get_publisher_names_and_types_by_node = _of_graph(GraphQueries.get_publisher_names_and_types_by_node)
    get_subscriber_names_and_types_by_node = _of_graph(GraphQueries.get_subscriber_names_and_types_by_node)
    get_service_names_and_types_by_node = _of_graph(GraphQueries.get_service_names_and_types_by_node)
    get_client_names_and_types_by_node = _of_graph(GraphQueries.get_client_names_and_types_by_node)
    wait_for_node = _of_graph(GraphQueries.wait_for_node)
    del _of_graph  # a user's node may have an attribute of the name

    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """The publishers of a topic, as this node names it unless `no_mangle` says that it is the name itself."""
        return self.__graph.get_publishers_info_by_topic(
            topic_name if no_mangle else _resolved(self.__handle.resolve_topic_name, topic_name)
        )

    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """The subscriptions to a topic; see `get_publishers_info_by_topic`."""
        name = topic_name if no_mangle else _resolved(self.__handle.resolve_topic_name, topic_name)
        return self.__graph.get_subscriptions_info_by_topic(name)

    def count_publishers(self, topic_name: str) -> int:
        """How many publishers a topic has, in this process and outside."""
        return self.__graph.count_publishers(_resolved(self.__handle.resolve_topic_name, topic_name))

    def count_subscribers(self, topic_name: str) -> int:
        """How many subscriptions a topic has, in this process and outside."""
        return self.__graph.count_subscribers(_resolved(self.__handle.resolve_topic_name, topic_name))

    def count_services(self, service_name: str) -> int:
        """How many servers a service has."""
        return self.__graph.count_services(_resolved(self.__handle.resolve_service_name, service_name))

    def count_clients(self, service_name: str) -> int:
        """How many clients a service has."""
        return self.__graph.count_clients(_resolved(self.__handle.resolve_service_name, service_name))


def _resolved(resolve: Callable[[str], str], name: str) -> str:
    """The absolute name of a query; a name that is not valid is refused in rclpy's words.

    Raises:
        TypeError: the name is not a text.
        ValueError: the name is not valid.
    """
    if not isinstance(name, str):
        raise TypeError(f"bad argument type for built-in operation: {name!r} is not a name")
    try:
        return resolve(name)
    except InvalidNameError as error:
        raise ValueError(f"{error.kind} is invalid: {error}") from error
