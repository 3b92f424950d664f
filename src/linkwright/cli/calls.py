"""Calling services of running nodes from a verb."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from linkwright.cli.lookup import absolute_or_given, unknown
from linkwright.diagnostics import Diagnostic, LinkwrightError, joined, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session

APPEARS_WITHIN = 5.0
"""Seconds within which a service that a node should have must appear, as in ros2cli."""


class NoAnswerError(LinkwrightError):
    """A service was not there in time, or did not answer in time."""


async def call(
    session: Session,
    service_type: str,
    service_name: str,
    request: Any,
    *,
    timeout: float | None = None,
    longer: float = 0.0,
) -> Any:
    """The response of a service.

    Args:
        session: of the verb.
        service_type: such as ``rcl_interfaces/srv/GetParameters``.
        service_name: absolute.
        request: what to ask.
        timeout: how long to wait for the response, in seconds; as long as it takes when left out.
        longer: how much longer than `APPEARS_WITHIN` to wait for the service, in seconds; the user is told.

    Raises:
        NoAnswerError: CLI421, the service is not there; CLI422, it does not answer in time.
    """
    from linkwright.messages import get_service

    client = session.node.create_client(get_service(service_type), service_name)
    try:
        is_ready = await session.until(client.service_is_ready, APPEARS_WITHIN)
        if not is_ready and longer > 0:
            print(f"waiting for service '{service_name}' to become available...", file=sys.stderr, flush=True)
            is_ready = await session.until(client.service_is_ready, longer)
        if not is_ready:
            raise NoAnswerError(
                Diagnostic(
                    "CLI421",
                    phrase(
                        "there is no service '{service_name}' of type {service_type}",
                        service_name=service_name,
                        service_type=service_type,
                    ),
                    hint=phrase("the node may have ended, or was made without this service"),
                )
            )
        future = client.call_async(request)
        response = await session.answer(future, timeout)
        if response is None:
            raise NoAnswerError(
                Diagnostic(
                    "CLI422",
                    phrase(
                        "service '{service_name}' did not answer in {timeout:g} s",
                        service_name=service_name,
                        timeout=timeout,
                    ),
                )
            )
        return response
    finally:
        session.node.destroy_client(client)


def node_names(session: Session, *, hidden: bool = False) -> list[str]:
    """Full names of the nodes, sorted, each as often as there are nodes of it."""
    from linkwright.graph.names.rules import is_hidden, join

    found = (join(namespace, name) for name, namespace in session.node.get_node_names_and_namespaces())
    return sorted(name for name in found if hidden or not is_hidden(name))


async def find_node(session: Session, name: str, *, hidden: bool = False, timeout: float = 1.0) -> str:
    """The full name of a running node.

    Args:
        session: of the verb.
        name: with or without the leading slash.
        hidden: whether it may be a hidden one.
        timeout: how long to wait for it, in seconds.

    Raises:
        LinkwrightError: CLI423, there is none.
    """
    full = absolute_or_given(name)
    if not await session.until(lambda: full in node_names(session, hidden=hidden), timeout):
        known = node_names(session, hidden=hidden)
        nothing = (
            phrase("there are: {known}", known=joined(dict.fromkeys(known)))
            if known
            else phrase("no nodes are running")
        )
        raise unknown("CLI423", phrase("Node not found: '{full}'", full=full), full, known, nothing)
    return full
