"""The parameters of all nodes for clients, by names such as ``/node.parameter``."""

from __future__ import annotations

import asyncio
import base64
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from linkwright.bridge.foxglove.names import NameFilter
from linkwright.graph import EndpointKind, Node, Parameter
from linkwright.graph.parameters.client import AsyncParameterClient
from linkwright.graph.parameters.files import plain_value

_RESPONSE_TIMEOUT_S = 2.0
_SERVICE = "/get_parameters"


class Parameters:
    """Access to the parameters of other nodes.

    Args:
        node: the node that sends the requests.
        name_filter: the filter of parameter names.
    """

    def __init__(self, node: Node, name_filter: NameFilter) -> None:
        self._node = node
        self._filter = name_filter
        self._clients: dict[str, AsyncParameterClient] = {}

    async def get(self, names: Sequence[str]) -> list[dict[str, Any]]:
        """Return the entries of parameters.

        If no name is given, the entries of all parameters are returned.
        """
        by_node: dict[str, list[str] | None] = {}
        if names:
            for name in names:
                node, _, parameter = name.partition(".")
                by_node[node] = [*(by_node.get(node) or ()), parameter]
        else:
            by_node = dict.fromkeys(self._find_nodes())
        self._remove_closed()
        results = await asyncio.gather(
            *(self._read_node(node, parameter_names) for node, parameter_names in by_node.items())
        )
        return [
            parameter for parameters in results for parameter in parameters if self._filter.accepts(parameter["name"])
        ]

    async def set(self, parameters: Sequence[Mapping[str, Any]]) -> None:
        """Set parameters.

        A parameter keeps its value if its node refuses the new one.
        """
        for entry in parameters:
            name = str(entry.get("name", ""))
            node, _, parameter = name.partition(".")
            if parameter and node in self._find_nodes() and self._filter.accepts(name):
                value = _parse_value(entry)
                await self._wait_for(self._get_client(node).set_parameters([Parameter(parameter, value=value)]))

    def close(self) -> None:
        """Close the clients of the parameter services."""
        for client in self._clients.values():
            client.destroy()
        self._clients.clear()

    def _find_nodes(self) -> list[str]:
        own_name = self._node.get_fully_qualified_name()
        services = {
            endpoint.name.removesuffix(_SERVICE)
            for endpoint in self._node.graph.endpoints()
            if endpoint.kind is EndpointKind.SERVICE and endpoint.name.endswith(_SERVICE)
        }
        return sorted(services - {own_name})

    def _remove_closed(self) -> None:
        for node in self._clients.keys() - set(self._find_nodes()):
            self._clients.pop(node).destroy()

    async def _read_node(self, node: str, names: Sequence[str] | None) -> list[dict[str, Any]]:
        if node not in self._find_nodes():
            return []
        client = self._get_client(node)
        if names is None:
            listing = await self._wait_for(client.list_parameters())
            names = list(listing.result.names) if listing is not None else []
        if not names:
            return []
        response = await self._wait_for(client.get_parameters(list(names)))
        if response is None:
            return []
        pairs = zip(names, map(plain_value, response.values), strict=False)
        return [make_parameter_entry(f"{node}.{name}", value) for name, value in pairs if value is not None]

    def _get_client(self, node: str) -> AsyncParameterClient:
        if node not in self._clients:
            self._clients[node] = AsyncParameterClient(self._node, node)
        return self._clients[node]

    async def _wait_for(self, future: Any) -> Any:
        """Return the result of a future of the graph, or None if it takes too long."""
        loop = asyncio.get_running_loop()
        done_event = asyncio.Event()
        future.add_done_callback(lambda _: loop.call_soon_threadsafe(done_event.set))
        try:
            await asyncio.wait_for(done_event.wait(), _RESPONSE_TIMEOUT_S)
            return future.result()
        except asyncio.TimeoutError:
            return None


class ParameterSubscription:
    """A client's subscription to changes of parameters.

    A request without names applies to all parameters. A later request with names applies to these alone.
    """

    def __init__(self) -> None:
        self._includes_others = False
        self._names: set[str] = set()

    def __bool__(self) -> bool:
        """Whether changes of any parameter are sent."""
        return self._includes_others or bool(self._names)

    def __contains__(self, name: str) -> bool:
        return (name in self._names) != self._includes_others

    def add(self, names: Iterable[str]) -> None:
        """Subscribe to parameters with these names, or to all parameters if there are no names."""
        self._change(set(names), subscribes=True)

    def remove(self, names: Iterable[str]) -> None:
        """Unsubscribe from parameters with these names, or from all if there are no names."""
        self._change(set(names), subscribes=False)

    def _change(self, names: set[str], *, subscribes: bool) -> None:
        if not names:
            self._includes_others, self._names = subscribes, set()
        elif subscribes == self._includes_others:
            self._names -= names
        else:
            self._names |= names


def make_parameter_entry(name: str, value: Any) -> dict[str, Any]:
    """Return a parameter as an entry of the protocol's parameter messages."""
    parameter: dict[str, Any] = {"name": name, "value": value}
    if isinstance(value, (bytes, bytearray)):
        parameter.update(value=base64.b64encode(value).decode(), type="byte_array")
    elif isinstance(value, float):
        parameter["type"] = "float64"
    elif isinstance(value, list) and value and all(isinstance(number, float) for number in value):
        parameter["type"] = "float64_array"
    return parameter


def _parse_value(parameter: Mapping[str, Any]) -> Any:
    value, type_name = parameter.get("value"), parameter.get("type")
    if type_name == "byte_array":
        return [bytes([byte]) for byte in base64.b64decode(str(value))]
    if type_name == "float64" and isinstance(value, (int, float)):
        return float(value)
    if type_name == "float64_array" and isinstance(value, list):
        return [float(number) for number in value]
    return value
