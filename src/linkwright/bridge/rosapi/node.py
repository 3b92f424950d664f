"""The node rosapi_node: services for questions about the graph, with the names and types of rosapi."""

from __future__ import annotations

import os
from collections.abc import Awaitable, Callable, Iterable
from typing import Any

from linkwright.bridge.rosapi.graph_lists import GraphLists
from linkwright.bridge.rosapi.parameters import ParameterFailedError, Parameters
from linkwright.bridge.rosapi.type_definitions import list_type_definitions
from linkwright.bridge.rosbridge.globs import Globs
from linkwright.bridge.rosbridge.requests import full_type_name
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import Graph, ParameterDescriptor
from linkwright.graph.loop.node_handle import ReentrantCallbackGroup
from linkwright.messages import get_message, get_service, interface_names
from linkwright.messages.definitions.interfaces import KINDS
from linkwright.messages.schema_text import schema_of
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import log_unknown_parameters

_ROS_VERSION = 2
_DEFAULT_DISTRIBUTION = "jazzy"
_ANY_TYPE = ParameterDescriptor(dynamic_typing=True)
Callback = Callable[[Any, Any], Awaitable[Any]] | Callable[[Any, Any], Any]


class RosapiNode(SingleNode):
    """The node rosapi_node, with the services that roslibjs and roslibpy call.

    Unlike in rosapi, constants of types are those of the definition alone, names are sorted, and an integer can be
    the value of a parameter with a floating-point number.
    """

    DEFAULT_NAME = "rosapi"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            topics, services, parameters = (
                Globs(self._node.declare_parameter(name, "[*]", _ANY_TYPE).value)
                for name in ("topics_glob", "services_glob", "params_glob")
            )
            timeout_s = float(self._node.declare_parameter("params_timeout", 5.0, _ANY_TYPE).value)
            log_unknown_parameters(self._node)
        self._lists = GraphLists(self._node, topics, services)
        self._parameters = Parameters(self._node, parameters, timeout_s)
        graph.publishers()  # starts the discovery of other processes
        self._group = ReentrantCallbackGroup()
        for name, type_name, callback in self._list_services():
            self._node.create_service(
                f"rosapi_msgs/srv/{type_name}", f"rosapi/{name}", callback, callback_group=self._group
            )

    def close(self) -> None:
        """Close the node."""
        self._parameters.close()
        super().close()

    def _list_services(self) -> Iterable[tuple[str, str, Callback]]:
        """Return the name, type and callback of each service."""
        return (
            ("topics", "Topics", self._get_topics),
            ("topics_for_type", "TopicsForType", self._get_topics_for_type),
            ("topics_and_raw_types", "TopicsAndRawTypes", self._get_topics_and_raw_types),
            ("topic_type", "TopicType", self._get_topic_type),
            ("publishers", "Publishers", self._get_publishers),
            ("subscribers", "Subscribers", self._get_subscribers),
            ("services", "Services", self._get_services),
            ("services_for_type", "ServicesForType", self._get_services_for_type),
            ("service_type", "ServiceType", self._get_service_type),
            ("service_node", "ServiceNode", self._get_service_node),
            ("service_providers", "ServiceProviders", self._get_service_providers),
            ("action_servers", "GetActionServers", self._get_action_servers),
            ("action_type", "ActionType", self._get_action_type),
            ("nodes", "Nodes", self._get_nodes),
            ("node_details", "NodeDetails", self._get_node_details),
            ("interfaces", "Interfaces", self._get_interfaces),
            ("message_details", "MessageDetails", self._get_message_details),
            ("service_request_details", "ServiceRequestDetails", self._get_request_details),
            ("service_response_details", "ServiceResponseDetails", self._get_response_details),
            ("get_param", "GetParam", self._get_param),
            ("set_param", "SetParam", self._set_param),
            ("has_param", "HasParam", self._has_param),
            ("delete_param", "DeleteParam", self._delete_param),
            ("get_param_names", "GetParamNames", self._get_param_names),
            ("get_time", "GetTime", self._get_time),
            ("get_ros_version", "GetROSVersion", self._get_ros_version),
        )

    # --- topics, services, actions and nodes ---------------------------------------------------------------------

    def _get_topics(self, _: Any, response: Any) -> Any:
        topics = self._lists.topics()
        response.topics, response.types = list(topics), list(topics.values())
        return response

    def _get_topics_for_type(self, request: Any, response: Any) -> Any:
        type_name = full_type_name(request.type, "msg")
        response.topics = [topic for topic, kind in self._lists.topics().items() if kind == type_name]
        return response

    def _get_topics_and_raw_types(self, request: Any, response: Any) -> Any:
        self._get_topics(request, response)
        response.typedefs_full_text = [_read_definition(type_name) for type_name in response.types]
        return response

    def _get_topic_type(self, request: Any, response: Any) -> Any:
        response.type = self._lists.topics().get(request.topic, "")
        return response

    def _get_publishers(self, request: Any, response: Any) -> Any:
        response.publishers = self._lists.publishers(request.topic)
        return response

    def _get_subscribers(self, request: Any, response: Any) -> Any:
        response.subscribers = self._lists.subscribers(request.topic)
        return response

    def _get_services(self, _: Any, response: Any) -> Any:
        response.services = list(self._lists.services())
        return response

    def _get_services_for_type(self, request: Any, response: Any) -> Any:
        type_name = full_type_name(request.type, "srv")
        response.services = [service for service, kind in self._lists.services().items() if kind == type_name]
        return response

    def _get_service_type(self, request: Any, response: Any) -> Any:
        response.type = self._lists.services().get(request.service, "")
        return response

    def _get_service_node(self, request: Any, response: Any) -> Any:
        response.node = next(iter(self._lists.service_nodes(request.service)), "")
        return response

    def _get_service_providers(self, request: Any, response: Any) -> Any:
        response.providers = self._lists.service_providers(full_type_name(request.service, "srv"))
        return response

    def _get_action_servers(self, _: Any, response: Any) -> Any:
        response.action_servers = list(self._lists.actions())
        return response

    def _get_action_type(self, request: Any, response: Any) -> Any:
        response.type = self._lists.actions().get(request.action, "")
        return response

    def _get_nodes(self, _: Any, response: Any) -> Any:
        response.nodes = self._lists.nodes()
        return response

    def _get_node_details(self, request: Any, response: Any) -> Any:
        response.subscribing, response.publishing, response.services = self._lists.node_details(request.node)
        return response

    # --- types -------------------------------------------------------------------------------------------------

    def _get_interfaces(self, _: Any, response: Any) -> Any:
        response.interfaces = [name for kind in KINDS for name in interface_names(kind)]
        return response

    def _get_message_details(self, request: Any, response: Any) -> Any:
        return self._define(response, lambda: get_message(full_type_name(request.type, "msg")))

    def _get_request_details(self, request: Any, response: Any) -> Any:
        return self._define(response, lambda: get_service(full_type_name(request.type, "srv")).Request)

    def _get_response_details(self, request: Any, response: Any) -> Any:
        return self._define(response, lambda: get_service(full_type_name(request.type, "srv")).Response)

    def _define(self, response: Any, find_class: Callable[[], Any]) -> Any:
        try:
            response.typedefs = list_type_definitions(find_class())
        except LinkwrightError as error:
            self._node.get_logger().error(error.diagnostics[0].message)
        return response

    # --- parameters ----------------------------------------------------------------------------------------------

    async def _get_param(self, request: Any, response: Any) -> Any:
        async def run() -> None:
            response.value = await self._parameters.get(request.name)

        response.value = "null"
        return await self._report(run(), response)

    async def _set_param(self, request: Any, response: Any) -> Any:
        return await self._report(self._parameters.set(request.name, request.value), response)

    async def _delete_param(self, request: Any, response: Any) -> Any:
        return await self._report(self._parameters.delete(request.name), response)

    async def _report(self, access: Awaitable[None], response: Any) -> Any:
        """Return the response, with whether the access to a parameter has succeeded."""
        try:
            await access
            response.successful = True
        except ParameterFailedError as error:
            response.reason = str(error)
            self._node.get_logger().warning(response.reason)
        return response

    async def _has_param(self, request: Any, response: Any) -> Any:
        try:
            await self._parameters.get(request.name)
            response.exists = True
        except ParameterFailedError:
            response.exists = False
        return response

    async def _get_param_names(self, _: Any, response: Any) -> Any:
        response.names = await self._parameters.list_names()
        return response

    # --- ROS -----------------------------------------------------------------------------------------------------

    def _get_time(self, _: Any, response: Any) -> Any:
        response.time = self._node.get_clock().now().to_msg()
        return response

    def _get_ros_version(self, _: Any, response: Any) -> Any:
        response.version = _ROS_VERSION
        response.distro = os.environ.get("ROS_DISTRO") or _DEFAULT_DISTRIBUTION
        return response


def _read_definition(type_name: str) -> str:
    try:
        return schema_of(type_name)
    except LinkwrightError as error:
        return f"# {error.diagnostics[0].message}"
