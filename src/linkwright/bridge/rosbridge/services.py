"""Services that clients call, and services that clients offer."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from typing import Any

from linkwright.bridge.rosbridge.requests import Request, RequestError, full_type_name
from linkwright.bridge.rosbridge.topic_types import find_service_type
from linkwright.bridge.rosbridge.values import Now, from_json_arguments, from_json_values
from linkwright.graph import Client as ServiceClient
from linkwright.graph import Node
from linkwright.graph.loop.node_handle import ReentrantCallbackGroup
from linkwright.messages import get_service
from linkwright.nodes.service_waits import wait_for_future, wait_for_service

_SERVER_TIMEOUT_S = 1.0


class ServiceCalls:
    """Calls services for all clients, through a service client for each service.

    Args:
        node: the node that calls the services.
        timeout_s: the seconds to wait for a response, unless a call has another limit; 0 for no limit.
        now: returns the current time.
    """

    def __init__(self, node: Node, timeout_s: float, now: Now) -> None:
        self._node = node
        self._timeout_s = timeout_s
        self._now = now
        self._clients: dict[tuple[str, str], ServiceClient[Any, Any]] = {}

    async def call(self, service: str, arguments: Any, timeout_s: float | None) -> Any:
        """Call a service, and return the values of its response.

        Args:
            service: the name in the client's request.
            arguments: the values of the request, as a dictionary or a list.
            timeout_s: the seconds to wait for the response; None for the default.

        Raises:
            RequestError: there is no such service, a value is not valid, or there is no response.
            LinkwrightError: the service's name is not valid, or its type is unknown.
        """
        name = self._node.resolve_service_name(service)
        type_name = find_service_type(self._node, name)
        if type_name is None:
            raise RequestError(f"Service {name} does not exist")
        service_class = get_service(type_name)
        request = from_json_arguments(arguments, service_class.Request, self._now)
        client = self._clients.get((service, type_name))
        if client is None:
            client = self._clients[service, type_name] = self._node.create_client(
                service_class, service, callback_group=ReentrantCallbackGroup()
            )
        if not await wait_for_service(self._node, client, _SERVER_TIMEOUT_S):
            raise RequestError(f"Service {name} does not exist")
        limit_s = self._timeout_s if timeout_s is None else timeout_s
        future = client.call_async(request)
        try:
            if not await wait_for_future(self._node, future, limit_s or None):
                raise RequestError(f"Timeout exceeded while waiting for the response of {name} ({limit_s:g} s)")
        finally:
            client.remove_pending_request(future)
        try:
            return future.result()
        except Exception as error:
            raise RequestError(str(error) or type(error).__name__) from error  # an exception of the service's code

    def drop_gone(self) -> None:
        """Destroy the clients of services that no longer exist."""
        for service, type_name in list(self._clients):
            if find_service_type(self._node, self._node.resolve_service_name(service)) != type_name:
                self._node.destroy_client(self._clients.pop((service, type_name)))


class OfferedService:
    """A service that a client of rosbridge offers to the graph.

    Args:
        node: the node that offers the service.
        name: the name in the client's request.
        type_name: the type in the client's request.
        send: sends a message to the client.
        now: returns the current time.

    Raises:
        LinkwrightError: the name is not valid, or the type is unknown.
    """

    def __init__(
        self, node: Node, name: str, type_name: str, send: Callable[[dict[str, Any]], object], now: Now
    ) -> None:
        self._node = node
        self._name = name
        self._send = send
        self._now = now
        self._class: Any = get_service(full_type_name(type_name, "srv"))
        self._pending: dict[str, Callable[[Any], object]] = {}
        self._numbers = count(1)
        self._service = node.create_service(self._class, name, self._on_request, replying=True)

    def respond(self, request: Request) -> None:
        """Answer a request of the graph with the client's response.

        Raises:
            RequestError: there is no such request, or a value is not valid.
        """
        has_succeeded = request.read("result", bool)
        reply = self._pending.pop(str(request.identity), None)
        if reply is None:
            raise RequestError(f"Received service response for unrecognized id: {str(request.identity)[:200]}")
        values = request.get("values")
        if has_succeeded or isinstance(values, dict):
            reply(from_json_values(values or {}, self._class.Response, self._now))
            return
        reply(self._class.Response())
        raise RequestError(f"The caller of {self._name} receives an empty response, because ROS has none for a failure")

    def close(self) -> None:
        """End the service. Callers that wait get no response."""
        self._pending.clear()
        self._node.destroy_service(self._service)

    def _on_request(self, request: Any, reply: Callable[[Any], object]) -> None:
        identity = f"service_request:{self._name}:{next(self._numbers)}"
        self._pending[identity] = reply
        self._send({"op": "call_service", "id": identity, "service": self._name, "args": request})
