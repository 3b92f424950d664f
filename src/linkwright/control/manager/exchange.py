"""An exchange without queues, for controllers that are updated on the event loop."""

from __future__ import annotations

from typing import Any

from linkwright.graph.stepped.exchange import Command, Exchange, Outlet


class DirectExchange(Exchange):
    """An exchange that publishes messages and calls functions immediately."""

    def send(self, publisher: Outlet, message: Any) -> None:
        """Publish a message immediately."""
        publisher.publish(message)

    def post(self, command: Command) -> None:
        """Call a function immediately."""
        command()
