"""Functions that wait for the responses of another node to requests about its parameters."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable
from typing import Any

from linkwright.graph.parameters.client import AsyncParameterClient

_RESPONSE_TIMEOUT_S = 5.0
"""Seconds to wait for the services to appear, and for each response."""

_POLL_INTERVAL_S = 0.05


class NoParameterResponseError(Exception):
    """Raised when a node does not respond in time.

    The message names the node.
    """


async def wait_for_services(client: AsyncParameterClient) -> None:
    """Wait until a node's parameter services are available.

    Raises:
        NoParameterResponseError: the services are not available in time.
    """
    loop = asyncio.get_running_loop()
    deadline = loop.time() + _RESPONSE_TIMEOUT_S
    while not client.services_are_ready():
        if loop.time() > deadline:
            raise NoParameterResponseError(f"node '{client.remote_node_name}' does not offer its parameters")
        await asyncio.sleep(_POLL_INTERVAL_S)


async def wait_for_response(client: AsyncParameterClient, future: Awaitable[Any]) -> Any:
    """Return the response to a request, given the future that a method of the client returned.

    Raises:
        NoParameterResponseError: there was no response in time.
    """

    async def wait() -> Any:
        return await future

    try:
        return await asyncio.wait_for(wait(), _RESPONSE_TIMEOUT_S)
    except asyncio.TimeoutError:
        raise NoParameterResponseError(
            f"node '{client.remote_node_name}' did not answer in {_RESPONSE_TIMEOUT_S:g} s"
        ) from None
