"""The exchange of controllers that are updated on the event loop, where nothing has to wait."""

from __future__ import annotations

from typing import Any

from linkwright.graph.stepped.exchange import Command, Exchange, Outlet


class DirectExchange(Exchange):
    """Publishes and calls at once."""

    def send(self, publisher: Outlet, message: Any) -> None:
        """Publish a message."""
        publisher.publish(message)

    def post(self, command: Command) -> None:
        """Call a function."""
        command()
