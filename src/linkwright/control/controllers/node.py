"""The node of a controller, for use in the update thread."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.graph import Node
from linkwright.graph.stepped.exchange import Exchange
from linkwright.graph.stepped.node import SteppedNode


class ControllerNode(SteppedNode):
    """A controller's publishers, subscriptions and services, for use in the update thread.

    Callbacks run in the update thread, between two updates; messages are sent after the update.

    Args:
        node: the node, which is destroyed with the controller.
        exchange: the exchange between the update thread and the graph.
    """

    def __init__(self, node: Node, exchange: Exchange) -> None:
        super().__init__(node, exchange, owned=True)

    def call_on_loop(self, function: Callable[[], object]) -> None:
        """Queue a function for the event loop, to be called after the messages published before it."""
        self._exchange.send(_Call(function), None)

    def clear(self) -> None:
        """Remove the node's topics and services from the graph, but keep the node."""
        for endpoint in self._endpoints:
            endpoint.destroy()
        self._endpoints.clear()


class _Call:
    """A function call that can be queued with messages, because it looks like a publisher."""

    __slots__ = ("_call",)

    def __init__(self, function: Callable[[], object]) -> None:
        self._call = function

    def publish(self, message: None) -> None:
        """Call the function, and ignore the message."""
        self._call()
