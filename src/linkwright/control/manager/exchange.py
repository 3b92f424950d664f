"""The exchange of controllers that are updated on the event loop: nothing has to wait there."""

from __future__ import annotations

from typing import Any

from linkwright.simulation.exchange import Command, Exchange, Outlet


class DirectExchange(Exchange):
    """Publishes at once, and does at once what is posted."""

    def send(self, publisher: Outlet, message: Any) -> None:
        """Publish a message."""
        publisher.publish(message)

    def post(self, command: Command) -> None:
        """Do something."""
        command()
