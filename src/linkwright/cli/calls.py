"""Service calls from a command to running nodes."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from linkwright.cli.lookup import add_leading_slash, unknown_name_error
from linkwright.diagnostics import Diagnostic, LinkwrightError, joined, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session

SERVICE_TIMEOUT_S = 5.0
"""Seconds to wait for a service that a node should have, as in ros2cli."""


class NoResponseError(LinkwrightError):
    """Raised when a service does not appear or does not respond in time."""


async def call(
    session: Session,
    service_type: str,
    service_name: str,
    request: Any,
    *,
    timeout: float | None = None,
    extra_wait: float = 0.0,
) -> Any:
    """Call a service and return its response.

    Args:
        session: the session of the command.
        service_type: the type, such as ``rcl_interfaces/srv/GetParameters``.
        service_name: the absolute name.
        request: the request message.
        timeout: the time to wait for the response, in seconds; None for no limit.
        extra_wait: the time to wait for the service in addition to `SERVICE_TIMEOUT_S`, in seconds; a line on standard
            error announces this wait.

    Raises:
        NoResponseError: CLI421, the service does not exist; CLI422, it does not respond in time.
    """
    from linkwright.messages import get_service

    client = session.node.create_client(get_service(service_type), service_name)
    try:
        is_ready = await session.wait_until(client.service_is_ready, SERVICE_TIMEOUT_S)
        if not is_ready and extra_wait > 0:
            print(f"waiting for service '{service_name}' to become available...", file=sys.stderr, flush=True)
            is_ready = await session.wait_until(client.service_is_ready, extra_wait)
        if not is_ready:
            raise NoResponseError(
                Diagnostic(
                    "CLI421",
                    phrase(
                        "there is no service '{service_name}' of type {service_type}",
                        service_name=service_name,
                        service_type=service_type,
                    ),
                    hint=phrase("check whether the node has exited or does not offer this service"),
                )
            )
        future = client.call_async(request)
        response = await session.wait_for_result(future, timeout)
        if response is None:
            raise NoResponseError(
                Diagnostic(
                    "CLI422",
                    phrase(
                        "service '{service_name}' did not respond within {timeout:g} s",
                        service_name=service_name,
                        timeout=timeout,
                    ),
                )
            )
        return response
    finally:
        session.node.destroy_client(client)


def list_node_names(session: Session, *, hidden: bool = False) -> list[str]:
    """Return the sorted full names of the nodes; a shared name occurs several times."""
    from linkwright.graph.names.rules import is_hidden, join

    full_names = (join(namespace, name) for name, namespace in session.node.get_node_names_and_namespaces())
    return sorted(name for name in full_names if hidden or not is_hidden(name))


async def find_node(session: Session, name: str, *, hidden: bool = False, timeout: float = 1.0) -> str:
    """Return the full name of a running node.

    Args:
        session: the session of the command.
        name: the node's name, with or without the leading slash.
        hidden: whether to include hidden nodes.
        timeout: the time to wait for the node, in seconds.

    Raises:
        LinkwrightError: CLI423, there is no such node.
    """
    full_name = add_leading_slash(name)
    if not await session.wait_until(lambda: full_name in list_node_names(session, hidden=hidden), timeout):
        existing_names = list_node_names(session, hidden=hidden)
        hint = (
            phrase("running nodes: {nodes}", nodes=joined(dict.fromkeys(existing_names)))
            if existing_names
            else phrase("no nodes are running")
        )
        raise unknown_name_error(
            "CLI423", phrase("Node not found: '{full}'", full=full_name), full_name, existing_names, hint
        )
    return full_name
