"""The parameters of all nodes, whose names are ``NODE:PARAMETER`` and whose values are JSON."""

from __future__ import annotations

import json
from typing import Any

from linkwright.bridge.rosbridge.globs import Globs
from linkwright.graph import EndpointKind, Node, Parameter, ParameterType
from linkwright.graph.loop.node_handle import ReentrantCallbackGroup
from linkwright.graph.parameters.client import AsyncParameterClient
from linkwright.graph.parameters.files import plain_value
from linkwright.nodes.service_waits import wait_for_future

_SERVICE = "/get_parameters"


class ParameterFailedError(Exception):
    """Raised when a parameter cannot be read or set. The message gives the reason."""


class Parameters:
    """Access to the parameters of other nodes.

    Args:
        node: the node that sends the requests.
        globs: the patterns of the parameters that may be used.
        timeout_s: the seconds to wait for a node.
    """

    def __init__(self, node: Node, globs: Globs, timeout_s: float) -> None:
        self._node = node
        self._globs = globs
        self._timeout_s = timeout_s
        self._clients: dict[str, AsyncParameterClient] = {}

    async def list_names(self) -> list[str]:
        """Return the names of all parameters. Nodes that do not respond are left out."""
        names = []
        for node in self._find_nodes():
            try:
                response = await self._wait_for(node, self._get_client(node).list_parameters())
            except ParameterFailedError:
                continue
            names += [f"{node}:{name}" for name in response.result.names if self._globs.match(name)]
        return names

    async def get(self, name: str) -> str:
        """Return the value of a parameter as JSON.

        Raises:
            ParameterFailedError: there is no such parameter.
        """
        value = await self._read(*self._split(name))
        if value is None:
            raise ParameterFailedError(f"parameter {name} is not set")
        return json.dumps(value, default=_encode_byte)

    async def set(self, name: str, text: str) -> None:
        """Set a parameter to a value in JSON.

        JavaScript writes 5.0 as 5, so an integer is accepted for a parameter with a floating-point number.

        Raises:
            ParameterFailedError: there is no such node, the value is not JSON, or the node refuses it.
        """
        node, parameter = self._split(name)
        try:
            value = json.loads(text)
        except ValueError:
            raise ParameterFailedError("the value must be JSON") from None
        if _has_integers(value):
            current = await self._read(node, parameter)
            if isinstance(current, float):
                value = float(value)
            elif isinstance(current, list) and isinstance(value, list) and _has_floats(current):
                value = [float(number) for number in value]
        try:
            new_parameter = Parameter(parameter, value=value)
        except (TypeError, ValueError) as error:
            raise ParameterFailedError(f"a parameter cannot have this value: {str(error)[:200]}") from None
        await self._apply(node, new_parameter)

    async def delete(self, name: str) -> None:
        """Undeclare a parameter.

        Raises:
            ParameterFailedError: there is no such parameter, or the node refuses.
        """
        node, parameter = self._split(name)
        await self._apply(node, Parameter(parameter, ParameterType.NOT_SET))

    def close(self) -> None:
        """Close the clients of the parameter services."""
        for client in self._clients.values():
            client.destroy()
        self._clients.clear()

    async def _apply(self, node: str, parameter: Parameter) -> None:
        response = await self._wait_for(node, self._get_client(node).set_parameters([parameter]))
        result = response.results[0]
        if not result.successful:
            raise ParameterFailedError(result.reason or f"{node} refuses the value")

    async def _read(self, node: str, parameter: str) -> Any:
        response = await self._wait_for(node, self._get_client(node).get_parameters([parameter]))
        return plain_value(response.values[0]) if response.values else None

    def _split(self, name: str) -> tuple[str, str]:
        """Return the full name of the node and the name of the parameter."""
        node, colon, parameter = name.partition(":")
        if not colon or not parameter:
            raise ParameterFailedError(f"Malformed parameter name: {name[:200]}; expecting <node_name>:<param_name>")
        if not self._globs.match(parameter):
            raise ParameterFailedError(f"parameter {parameter[:200]} is not allowed by params_glob")
        full_name = node if node.startswith("/") else f"/{node}"
        if full_name not in self._find_nodes():
            raise ParameterFailedError(f"there is no node {full_name[:200]} with parameters")
        return full_name, parameter

    def _find_nodes(self) -> list[str]:
        """Return the nodes that have parameters, and drop the clients of other nodes."""
        nodes = {
            endpoint.name.removesuffix(_SERVICE)
            for endpoint in self._node.graph.endpoints()
            if endpoint.kind is EndpointKind.SERVICE and endpoint.name.endswith(_SERVICE)
        }
        for node in self._clients.keys() - nodes:
            self._clients.pop(node).destroy()
        return sorted(nodes)

    def _get_client(self, node: str) -> AsyncParameterClient:
        if node not in self._clients:
            self._clients[node] = AsyncParameterClient(self._node, node, callback_group=ReentrantCallbackGroup())
        return self._clients[node]

    async def _wait_for(self, node: str, future: Any) -> Any:
        if not await wait_for_future(self._node, future, self._timeout_s):
            future.cancel()
            raise ParameterFailedError(f"{node} does not respond within {self._timeout_s:g} s")
        return future.result()


def _has_integers(value: Any) -> bool:
    values = value if isinstance(value, list) else [value]
    return any(isinstance(item, int) and not isinstance(item, bool) for item in values)


def _has_floats(values: list[Any]) -> bool:
    return any(isinstance(value, float) for value in values)


def _encode_byte(value: Any) -> int:
    return int(value[0])
