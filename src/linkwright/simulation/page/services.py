"""Calls of simulation services on behalf of pages, with a notice if a call fails."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Any

from linkwright.diagnostics import Phrase, phrase
from linkwright.graph import Client
from linkwright.messages import get_service
from linkwright.page.audience import Page
from linkwright.page.protocol.simulation import SimulationNotice
from linkwright.rviz.context import ViewerContext


class SimulationServices:
    """Clients of simulation services, each created on first use.

    Args:
        context: the context of the viewer, whose node calls the services.
    """

    def __init__(self, context: ViewerContext) -> None:
        self._node = context.node
        self._clients: dict[str, Client[Any, Any]] = {}

    def call_service(
        self,
        page: Page,
        service_type: str,
        name: str,
        fields: dict[str, Any],
        on_response: Callable[[Any], None] = lambda _: None,
        failure_text: Phrase | None = None,
    ) -> None:
        """Call a service, and report to the page if the service does not exist or the call fails.

        Args:
            page: the page that requests the call.
            service_type: the type of the service, such as ``std_srvs/srv/Empty``.
            name: the name of the service, such as ``/pause_physics``.
            fields: the values of the request's fields, by name.
            on_response: called with the response, or with None if the service does not exist.
            failure_text: the text for the page if the response reports a failure without a reason.
        """
        client = self._clients.get(name)
        if client is None:
            client = self._clients[name] = self._node.create_client(get_service(service_type), name)
        if not client.service_is_ready():
            on_response(None)
            refuse(page, phrase("there is no service '{name}'", name=name))
            return
        future = client.call_async(client.srv_type.Request(**fields))

        def on_done(_: Any) -> None:
            response = future.result()
            result = getattr(response, "result", None)
            if getattr(response, "success", True) is False:
                fallback = failure_text or phrase("'{name}' failed", name=name)
                refuse(page, getattr(response, "status_message", "") or fallback)
            elif result is not None and result.error_message:
                refuse(page, result.error_message)
            on_response(response)

        future.add_done_callback(on_done)

    def close(self) -> None:
        """Destroy the clients.

        Later calls create new clients.
        """
        with suppress(ValueError):  # the node may have been destroyed before
            for client in self._clients.values():
                self._node.destroy_client(client)
        self._clients.clear()


def refuse(page: Page, text: str | Phrase) -> None:
    """Report to a page why a request was refused."""
    page.send(SimulationNotice(text))
