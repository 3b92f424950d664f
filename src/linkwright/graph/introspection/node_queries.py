"""A node's graph queries, as in ``rclpy.node.Node``, and its type description service."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping
from functools import wraps
from typing import Any, Concatenate, ParamSpec, TypeVar

from linkwright.graph.endpoints.base import Endpoint
from linkwright.graph.introspection.graph_queries import GraphQueries, TopicEndpointInfo
from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.graph.names.rules import InvalidNameError, join
from linkwright.messages import InterfaceNotFoundError, get_message, is_before_iron

TYPE_DESCRIPTION_PARAMETER = "start_type_description_service"
"""The parameter that decides whether a node has the type description service."""

_SERVICE_TYPE = "type_description_interfaces/srv/GetTypeDescription"
_TYPE_HASH_PATTERN = re.compile(r"RIHS01_[0-9a-f]{64}")


def has_type_descriptions_by_default(variables: Mapping[str, str] = os.environ) -> bool:
    """Return whether nodes offer the type description service by default.

    They do if ``ROS_DISTRO`` is Iron or a later distribution. If ``ROS_DISTRO`` is not set, Humble is assumed.
    """
    return not is_before_iron(variables)


class TypeDescriptions:
    """A node's ``get_type_description`` service.

    The service describes the types of the node's publishers, subscriptions, services and clients.

    Args:
        handle: the node's handle.
        create_service: the node's `Node.create_service`.
    """

    def __init__(self, handle: NodeHandle, create_service: Callable[..., object]) -> None:
        self._handle = handle
        create_service(_SERVICE_TYPE, f"{handle.identity.name}/get_type_description", self._describe_type)

    def _describe_type(self, request: Any, response: Any) -> Any:
        response.successful = False
        if not _TYPE_HASH_PATTERN.fullmatch(request.type_hash):
            response.failure_reason = "Failed to parse type hash"
            return response
        type_name = next((name for name in self._types_in_use() if _is_requested(name, request)), None)
        if type_name is None:
            response.failure_reason = "Type not currently in use by this node"
            return response
        from linkwright.messages.definitions.hashing import make_type_description
        from linkwright.messages.definitions.library import LIBRARY

        description = make_type_description(LIBRARY.definition(type_name))
        referenced_types = description["referenced_type_descriptions"]
        response.type_description = _get_message_class("TypeDescription")(
            type_description=_to_type_message(description["type_description"]),
            referenced_type_descriptions=[_to_type_message(nested_type) for nested_type in referenced_types],
        )
        if request.include_type_sources:
            response.type_sources = [
                _to_source_message(name)
                for name in (type_name, *(nested_type["type_name"] for nested_type in referenced_types))
            ]
        response.successful = True
        return response

    def _types_in_use(self) -> Iterator[str]:
        """Iterate over the type names in use, without duplicates."""
        return iter(dict.fromkeys(endpoint.type_name for endpoint in self._handle.parts(Endpoint)))


def _is_requested(name: str, request: Any) -> bool:
    if request.type_name not in ("", name):
        return False
    from linkwright.messages import type_hash

    try:
        return type_hash(name) == str(request.type_hash)
    except InterfaceNotFoundError:  # A raw endpoint may have a type without a local definition.
        return False


def _get_message_class(name: str) -> Any:
    return get_message(f"type_description_interfaces/msg/{name}")


def _to_type_message(description: Mapping[str, Any]) -> Any:
    """Convert a type description to an IndividualTypeDescription message.

    Default values are left out, because they are not part of the hash.
    """
    field, field_type = _get_message_class("Field"), _get_message_class("FieldType")
    fields = [field(name=member["name"], type=field_type(**member["type"])) for member in description["fields"]]
    return _get_message_class("IndividualTypeDescription")(type_name=description["type_name"], fields=fields)


def _to_source_message(name: str) -> Any:
    """Return the source text of an interface as a TypeSource message.

    A type without a file of its own, such as a request, has the encoding ``implicit``.
    """
    _, encoding, own_name = name.split("/")
    if "_" in own_name:
        return _get_message_class("TypeSource")(type_name=name, encoding="implicit")
    from linkwright.messages import definition_text

    return _get_message_class("TypeSource")(type_name=name, encoding=encoding, raw_file_contents=definition_text(name))


P = ParamSpec("P")
R = TypeVar("R")


class NodeQueries:
    """A node's queries to the graph.

    This is the base class of `Node`. Names in queries are expanded relative to the node, and remapped.
    """

    def __init__(self, graph: GraphQueries, handle: NodeHandle) -> None:
        # The attributes have mangled names, so that a user's node class may use the plain names.
        self.__graph = graph
        self.__handle = handle

    @staticmethod
    def _graph_query(query: Callable[Concatenate[GraphQueries, P], R]) -> Callable[Concatenate[NodeQueries, P], R]:
        """Wrap a graph query as a method of the node.

        Used only in the class body.
        """

        @wraps(query)
        def run_query(node: NodeQueries, /, *args: P.args, **kwargs: P.kwargs) -> R:
            return query(node.__graph, *args, **kwargs)

        return run_query

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the absolute name of a topic.

        The name is expanded and, unless `only_expand` is true, remapped.

        Raises:
            InvalidTopicNameError: the topic name is not valid.
        """
        return self.__handle.resolve_topic_name(topic, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the absolute name of a service or action. See `resolve_topic_name`.

        Raises:
            InvalidServiceNameError: the service name is not valid.
        """
        return self.__handle.resolve_service_name(service, only_expand=only_expand)

    def get_node_names(self) -> list[str]:
        """Return the names of the graph's nodes, without namespaces."""
        return [name for name, _ in self.__graph.get_node_names_and_namespaces()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """Return the full names of the graph's nodes."""
        return [join(namespace, name) for name, namespace in self.__graph.get_node_names_and_namespaces()]

    get_node_names_and_namespaces = _graph_query(GraphQueries.get_node_names_and_namespaces)
    get_node_names_and_namespaces_with_enclaves = _graph_query(GraphQueries.get_node_names_and_namespaces_with_enclaves)
    get_topic_names_and_types = _graph_query(GraphQueries.get_topic_names_and_types)
    get_service_names_and_types = _graph_query(GraphQueries.get_service_names_and_types)
    get_action_names_and_types = _graph_query(GraphQueries.get_action_names_and_types)
    get_publisher_names_and_types_by_node = _graph_query(GraphQueries.get_publisher_names_and_types_by_node)
    get_subscriber_names_and_types_by_node = _graph_query(GraphQueries.get_subscriber_names_and_types_by_node)
    get_service_names_and_types_by_node = _graph_query(GraphQueries.get_service_names_and_types_by_node)
    get_client_names_and_types_by_node = _graph_query(GraphQueries.get_client_names_and_types_by_node)
    wait_for_node = _graph_query(GraphQueries.wait_for_node)
    del _graph_query  # a user's node may have an attribute of this name

    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """Return the publishers of a topic.

        The name is expanded and remapped unless `no_mangle` is true.
        """
        return self.__graph.get_publishers_info_by_topic(
            topic_name if no_mangle else _resolve_for_query(self.__handle.resolve_topic_name, topic_name)
        )

    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """Return the subscriptions to a topic. See `get_publishers_info_by_topic`."""
        name = topic_name if no_mangle else _resolve_for_query(self.__handle.resolve_topic_name, topic_name)
        return self.__graph.get_subscriptions_info_by_topic(name)

    def count_publishers(self, topic_name: str) -> int:
        """Return the number of publishers of a topic, in this process and others."""
        return self.__graph.count_publishers(_resolve_for_query(self.__handle.resolve_topic_name, topic_name))

    def count_subscribers(self, topic_name: str) -> int:
        """Return the number of subscriptions to a topic, in this process and others."""
        return self.__graph.count_subscribers(_resolve_for_query(self.__handle.resolve_topic_name, topic_name))

    def count_services(self, service_name: str) -> int:
        """Return the number of servers of a service."""
        return self.__graph.count_services(_resolve_for_query(self.__handle.resolve_service_name, service_name))

    def count_clients(self, service_name: str) -> int:
        """Return the number of clients of a service."""
        return self.__graph.count_clients(_resolve_for_query(self.__handle.resolve_service_name, service_name))


def _resolve_for_query(resolve: Callable[[str], str], name: str) -> str:
    """Return the absolute name for a query.

    Errors have rclpy's wording.

    Raises:
        TypeError: the name is not a string.
        ValueError: the name is not valid.
    """
    if not isinstance(name, str):
        raise TypeError(f"bad argument type for built-in operation: {name!r} is not a name")
    try:
        return resolve(name)
    except InvalidNameError as error:
        raise ValueError(f"{error.kind} is invalid: {error}") from error
