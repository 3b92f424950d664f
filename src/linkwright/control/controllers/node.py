"""The node of a controller, as the controller uses it, in the thread of its updates."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.graph import Node
from linkwright.simulation.exchange import Exchange
from linkwright.simulation.plugins.node import PluginNode


class ControllerNode(PluginNode):
    """What a controller has of ROS: `publisher`, `subscribe` and `service` of `PluginNode`, and more.

    Callbacks come in the thread of the updates, between two of them; what is published goes out after the update.

    Args:
        node: the node; it ends with the controller.
        exchange: between the thread of the updates and the graph.
    """

    def __init__(self, node: Node, exchange: Exchange) -> None:
        super().__init__(node, exchange, owned=True, qos={}, usual=None)

    def post(self, command: Callable[[], object]) -> None:
        """Have something done in the thread of the updates, before the next one; from any thread."""
        self._exchange.post(command)

    def call_on_loop(self, call: Callable[[], object]) -> None:
        """Have something done on the event loop, after what was published before it."""
        self._exchange.send(_Call(call), None)

    def clear(self) -> None:
        """Take its topics and services out of the graph; the node stays."""
        for endpoint in self._endpoints:
            endpoint.destroy()
        self._endpoints.clear()


class _Call:
    """What is done where messages are published."""

    __slots__ = ("_call",)

    def __init__(self, call: Callable[[], object]) -> None:
        self._call = call

    def publish(self, message: None) -> None:
        """Call what is to be done; there is nothing to publish."""
        self._call()
