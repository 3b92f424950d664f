"""A test bench that steps controllers without a manager; the test provides the interfaces."""

from __future__ import annotations

from typing import Any

from linkwright.control.controllers.controller import Controller, ControllerContext
from linkwright.control.controllers.node import ControllerNode
from linkwright.control.hardware.interfaces import CommandInterface, Interface, Interfaces, StateInterface
from linkwright.graph import Graph, LogRecord
from linkwright.graph.stepped.exchange import Exchange


class TestBench:
    """A test bench with interfaces, a clock and a log."""

    def __init__(self, graph: Graph, log: list[LogRecord]) -> None:
        self.graph, self.log = graph, log
        self.node = graph.create_node("test_node")
        self.exchange = Exchange()
        self.states: dict[str, StateInterface] = {}
        self.commands: dict[str, CommandInterface] = {}
        self.time_ns = 0

    def joint(self, name: str, *, commands: tuple[str, ...] = (), **states: float) -> None:
        """Create a joint with command interfaces and states."""
        for interface in commands:
            self.commands[f"{name}/{interface}"] = CommandInterface(name, interface)
        for interface, value in states.items():
            self.states[f"{name}/{interface}"] = StateInterface(name, interface, value)

    def make(
        self, controller: type[Controller[Any]], name: str = "controller", *, description: str = "", **parameters: Any
    ) -> Any:
        """Create an unconfigured controller.

        Its name may have a namespace, its parameters nested mappings.
        """
        namespace, _, name = name.rpartition("/")
        node = self.graph.create_node(name, namespace=namespace or "/", parameters=parameters)
        context = ControllerContext(name, ControllerNode(node, self.exchange), 100.0, description)
        return controller(context)

    def activate(self, controller: Controller[Any], *, configure: bool = True) -> Any:
        """Configure and activate a controller with the interfaces that it requests."""
        if configure:
            controller.on_configure()
        controller.commands = _select_interfaces(self.commands, controller.command_interfaces())
        controller.states = _select_interfaces(self.states, controller.state_interfaces())
        controller.references = [
            CommandInterface(controller.name, reference_interface)
            for reference_interface in controller.reference_interfaces()
        ]
        controller.exported = [
            StateInterface(controller.name, exported_state) for exported_state in controller.exported_states()
        ]
        controller.on_activate()
        return controller

    def start(self, controller: type[Controller[Any]], name: str = "controller", **parameters: Any) -> Any:
        """Create, configure and activate a controller."""
        return self.activate(self.make(controller, name, **parameters))

    async def step(self, controller: Controller[Any], period_s: float = 0.01, count: int = 1) -> None:
        """Update the controller several times.

        Received messages are processed before, publications are sent after.
        """
        for _ in range(count):
            await self.graph.settle()
            self.exchange.run_commands()
            self.time_ns += round(period_s * 1e9)
            controller.step(self.time_ns, period_s)
            self.exchange.deliver()
            await self.graph.settle()

    def record(self, type_name: str, topic: str) -> list[Any]:
        """Return a list that receives a topic's messages."""
        messages: list[Any] = []
        self.node.create_subscription(type_name, topic, messages.append, 100)
        return messages

    def publish(self, type_name: str, topic: str, message: Any) -> None:
        """Publish a message; the next step processes it."""
        self.node.create_publisher(type_name, topic, 10).publish(message)


def _select_interfaces(interfaces: dict[str, Any], names: Any) -> list[Any]:
    return list(interfaces.values()) if names is Interfaces.ALL else [interfaces[name] for name in names]


def interface_values(interfaces: list[Interface]) -> list[float]:
    """Return the values of interfaces."""
    return [interface.value for interface in interfaces]
