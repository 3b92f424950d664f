"""The services of the graph, for clients."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from typing import Any

from linkwright.bridge.foxglove.names import NameFilter
from linkwright.bridge.foxglove.protocol import ENCODING, SCHEMA_ENCODING, ServiceRequest
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import Client as ServiceClient
from linkwright.graph import EndpointKind, Node
from linkwright.messages import deserialize, get_service, serialize
from linkwright.messages.schema_text import schema_of

_CALL_TIMEOUT_S = 10.0
"""The timeout of a service call, in seconds."""


class CallFailedError(Exception):
    """Raised when a service call fails.

    The message gives the reason.
    """


@dataclass(frozen=True, slots=True)
class OfferedService:
    """A service of the graph, with its type and the ID that clients use."""

    service_id: int
    name: str
    type_name: str

    def advertisement(self) -> dict[str, Any]:
        """Return the service as an entry of the protocol's ``advertiseServices`` message.

        The entry also has the keys of older protocol versions.
        """
        schemas = {
            message_kind: schema_of(f"{self.type_name}_{message_kind}") for message_kind in ("Request", "Response")
        }
        advertisement: dict[str, Any] = {"id": self.service_id, "name": self.name, "type": self.type_name}
        for part, schema in schemas.items():
            advertisement[part.lower()] = {
                "encoding": ENCODING,
                "schemaName": f"{self.type_name}_{part}",
                "schemaEncoding": SCHEMA_ENCODING,
                "schema": schema,
            }
            advertisement[f"{part.lower()}Schema"] = schema
        return advertisement


class Services:
    """The services that clients can call.

    Args:
        node: the node that calls the services.
        name_filter: the filter that service names must pass.
    """

    def __init__(self, node: Node, name_filter: NameFilter) -> None:
        self._node = node
        self._filter = name_filter
        self._services: dict[tuple[str, str], OfferedService] = {}
        self._clients: dict[int, ServiceClient[Any, Any]] = {}
        self._last_id = 0

    def all(self) -> list[OfferedService]:
        """Return the currently available services."""
        return list(self._services.values())

    def poll_changes(self) -> tuple[list[OfferedService], list[int]]:
        """Return the services that were added since the last call, and the IDs of removed services."""
        current = {
            (endpoint.name, endpoint.type_name)
            for endpoint in self._node.graph.endpoints()
            if endpoint.kind is EndpointKind.SERVICE and self._filter.accepts(endpoint.name)
        }
        removed = [self._services.pop(key).service_id for key in list(self._services) if key not in current]
        for service_id in removed:
            if service_id in self._clients:
                self._node.destroy_client(self._clients.pop(service_id))
        added = []
        for name, type_name in sorted(current - self._services.keys()):
            try:
                get_service(type_name)
            except LinkwrightError:
                continue  # the definition of the service's type is not available
            self._last_id += 1
            self._services[name, type_name] = OfferedService(self._last_id, name, type_name)
            added.append(self._services[name, type_name])
        return added, removed

    async def call(self, request: ServiceRequest) -> bytes:
        """Call a service, and return its response as CDR.

        Raises:
            CallFailedError: there is no response.
        """
        service = next(
            (
                offered_service
                for offered_service in self._services.values()
                if offered_service.service_id == request.service
            ),
            None,
        )
        if service is None:
            raise CallFailedError("the service no longer exists")
        if request.encoding != ENCODING:
            raise CallFailedError(f"the encoding '{request.encoding[:40]}' is not supported: use {ENCODING}")
        service_class: Any = get_service(service.type_name)
        client = self._clients.get(service.service_id)
        if client is None:
            client = self._clients[service.service_id] = self._node.create_client(service_class, service.name)
        try:
            service_request = deserialize(request.data, service_class.Request)
        except LinkwrightError as error:
            raise CallFailedError(error.diagnostics[0].message) from None
        future = client.call_async(service_request)
        loop = asyncio.get_running_loop()
        response_event = asyncio.Event()
        future.add_done_callback(lambda _: loop.call_soon_threadsafe(response_event.set))
        try:
            await asyncio.wait_for(response_event.wait(), _CALL_TIMEOUT_S)
        except asyncio.TimeoutError:
            client.remove_pending_request(future)
            raise CallFailedError(f"'{service.name}' did not respond within {_CALL_TIMEOUT_S:g} s") from None
        try:
            response: Any = future.result()
            return bytes(serialize(response))
        except Exception as error:  # noqa: BLE001 - an exception of the service's code
            raise CallFailedError(str(error)) from None
