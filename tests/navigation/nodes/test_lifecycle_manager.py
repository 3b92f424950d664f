"""lifecycle_manager: order, commands, and the death of a managed node."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from typing import Any

import pytest

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import Graph, JumpClock, LogLevel, LogRecord
from linkwright.messages import get_service
from linkwright.navigation.nodes.lifecycle_manager import LifecycleManager
from linkwright.navigation.nodes.managed import ManagedNode, ManagedServer
from linkwright.nodes import NodeOptions
from tests.waiting import eventually

STARTUP, PAUSE, RESUME, RESET, SHUTDOWN, CONFIGURE, CLEANUP = range(7)


class _Node(ManagedNode):
    DID: list[str]

    def configure(self) -> None:
        self._do("configure")
        if self.get_name() == "broken":
            raise LinkwrightError(Diagnostic("NODE433", phrase("it cannot be")))

    def activate(self) -> None:
        self._do("activate")

    def deactivate(self) -> None:
        self._do("deactivate")

    def _do(self, transition: str) -> None:
        self.DID.append(f"{transition} {self.get_name()}")


class _Server(ManagedServer):
    NODE = _Node
    DEFAULT_NAME = "server"


class Stack:
    """Managed nodes and their manager."""

    def __init__(self, graph: Graph, clock: JumpClock, log: list[LogRecord]) -> None:
        self.graph, self.clock, self.log = graph, clock, log
        self.did: list[str] = []
        _Node.DID = self.did
        self.servers: dict[str, _Server] = {}
        self.manager: LifecycleManager | None = None

    def add(self, *names: str) -> None:
        for name in names:
            self.servers[name] = _Server(self.graph, NodeOptions(name=name))

    async def manage(self, *names: str, condition: str, **parameters: object) -> None:
        """Start the manager, and wait for a line in its log."""
        facts = {"node_names": list(names), "autostart": True, **parameters}
        self.manager = LifecycleManager(self.graph, NodeOptions(parameters=facts))
        await self.until(condition)

    async def until(self, line: str) -> None:
        def is_logged() -> bool:
            return any(line in record.text for record in self.log)

        for _ in range(200):
            await self.graph.settle()
            if is_logged():
                return
            await self.clock.advance(0.1)
        raise AssertionError([record.text for record in self.log])

    async def command(self, number: int) -> bool:
        service_type = get_service("nav2_msgs/srv/ManageLifecycleNodes")
        client = self.graph.create_node("asks").create_client(service_type, "/lifecycle_manager/manage_nodes")
        future: Any = client.call_async(service_type.Request(command=number))
        while not future.done():
            await self.clock.advance(0.1)
        return bool(future.result().success)

    async def is_active(self) -> bool:
        service_type = get_service("std_srvs/srv/Trigger")
        client = self.graph.create_node("asks").create_client(service_type, "/lifecycle_manager/is_active")
        future: Any = client.call_async(service_type.Request())
        await eventually(future.done)
        return bool(future.result().success)

    def kill(self, name: str) -> None:
        """Kill a node as kill -9 does, without any message."""
        server = self.servers.pop(name)
        node: Any = server.node
        node.destroy_node()

    def states(self) -> dict[str, str]:
        nodes: dict[str, Any] = {name: server.node for name, server in self.servers.items()}
        return {name: node.lifecycle_state.label for name, node in nodes.items()}

    async def health(self) -> tuple[str, int, str]:
        """Return the next status on ``/diagnostics``."""
        messages: list[Any] = []
        node = self.graph.create_node("hears")
        node.create_subscription("diagnostic_msgs/msg/DiagnosticArray", "/diagnostics", messages.append, 10)
        while not messages:
            await self.clock.advance(0.5)
            await self.graph.settle()
        node.destroy_node()
        (status,) = messages[-1].status
        assert status.hardware_id == "Nav2"
        return status.name, status.level[0], status.message

    def errors(self) -> list[str]:
        return [record.text for record in self.log if record.level >= LogLevel.ERROR]

    def close(self) -> None:
        if self.manager is not None:
            self.manager.close()
        for server in self.servers.values():
            server.close()


@pytest.fixture
async def stack(graph: Graph, clock: JumpClock, log: list[LogRecord]) -> AsyncIterator[Stack]:
    stack = Stack(graph, clock, log)
    yield stack
    stack.close()


async def test_nodes_are_configured_and_activated_in_order(stack: Stack) -> None:
    stack.add("b", "a")
    await stack.manage("a", "b", condition="Managed nodes are active")
    assert stack.did == ["configure a", "configure b", "activate a", "activate b"]
    assert await stack.is_active()
    assert stack.errors() == []
    lines = [record.text for record in stack.log if record.node.endswith("lifecycle_manager")]
    assert lines == [
        "Creating",
        "Creating and initializing lifecycle service clients",
        "Starting managed nodes bringup...",
        "Configuring a",
        "Configuring b",
        "Activating a",
        "Server a connected with bond.",
        "Activating b",
        "Server b connected with bond.",
        "Managed nodes are active",
    ]


async def test_diagnostics_report_state_of_managed_nodes(stack: Stack) -> None:
    name = "lifecycle_manager: Nav2 Health"
    stack.add("a")
    await stack.manage("a", condition="Creating and initializing", autostart=False)
    assert await stack.health() == (name, 0, "Managed nodes are unconfigured")
    assert await stack.command(STARTUP)
    assert await stack.health() == (name, 0, "Managed nodes are active")
    assert await stack.command(PAUSE)
    assert await stack.health() == (name, 0, "Managed nodes are inactive")
    assert await stack.command(SHUTDOWN)
    assert await stack.health() == (name, 1, "Managed nodes have been shut down")


async def test_diagnostics_report_transition_error(stack: Stack) -> None:
    stack.add("broken")
    await stack.manage("broken", condition="Aborting bringup")
    assert (await stack.health())[1:] == (2, "An error has occurred during a node state transition")


async def test_manager_waits_for_late_nodes(stack: Stack) -> None:
    await stack.manage("a", condition="Waiting for service /a/change_state...")
    assert not await stack.is_active()
    stack.add("a")
    await stack.until("Managed nodes are active")


async def test_commands_transition_up_in_order_and_down_in_reverse(stack: Stack) -> None:
    stack.add("a", "b")
    await stack.manage("a", "b", condition="initializing", autostart=False)
    for number, state in (
        (CONFIGURE, "inactive"),
        (CLEANUP, "unconfigured"),
        (STARTUP, "active"),
        (PAUSE, "inactive"),
        (RESUME, "active"),
        (RESET, "unconfigured"),
        (STARTUP, "active"),
        (SHUTDOWN, "finalized"),
    ):
        assert await stack.command(number)
        assert stack.states() == {"a": state, "b": state}
        assert await stack.is_active() is (state == "active")
    assert [transition for transition in stack.did if transition.startswith("deactivate")][:2] == [
        "deactivate b",
        "deactivate a",
    ]
    assert stack.errors() == []


async def test_failed_configuration_aborts_bringup(stack: Stack) -> None:
    stack.add("a", "broken")
    await stack.manage("a", "broken", condition="Aborting bringup")
    assert stack.states() == {"a": "inactive", "broken": "unconfigured"}
    assert stack.errors() == [
        "error[NODE433]: it cannot be",
        "Failed to change state for node: broken",
        "Failed to bring up all requested nodes. Aborting bringup.",
    ]
    assert not await stack.command(PAUSE)


async def test_crash_resets_other_nodes_and_respawn_restores_all(stack: Stack) -> None:
    stack.add("a", "b", "c")
    await stack.manage("a", "b", "c", condition="Managed nodes are active")
    stack.kill("b")
    await stack.clock.advance(3.0)
    assert stack.states() == {"a": "active", "c": "active"}
    await stack.until("Managed nodes have been reset")
    assert stack.errors() == [
        "CRITICAL FAILURE: SERVER b IS DOWN after not receiving a heartbeat for 4000 ms. Shutting down related nodes."
    ]
    assert stack.states() == {"a": "unconfigured", "c": "unconfigured"}
    assert stack.did[-2:] == ["deactivate c", "deactivate a"]
    stack.add("b")
    await stack.until("Successfully re-established connections from server respawns, starting back up.")
    await stack.until("Managed nodes are active")
    await eventually(lambda: stack.states() == {"a": "active", "b": "active", "c": "active"})


async def test_clean_exit_of_node_is_noticed_at_once(stack: Stack) -> None:
    stack.add("a", "b")
    await stack.manage("a", "b", condition="Managed nodes are active", attempt_respawn_reconnection=False)
    stack.servers.pop("a").close()
    await stack.graph.settle()
    await stack.until("Managed nodes have been reset")
    assert stack.states() == {"b": "unconfigured"}


async def test_manager_gives_up_on_crashed_node_after_timeout(stack: Stack) -> None:
    stack.add("a", "b")
    await stack.manage("a", "b", condition="Managed nodes are active")
    stack.kill("a")
    await stack.until("Failed to re-establish connection from a server crash after maximum timeout.")
    assert stack.states() == {"b": "unconfigured"}


async def test_crash_is_not_noticed_without_bonds(stack: Stack) -> None:
    stack.add("a")
    await stack.manage("a", condition="Managed nodes are active", bond_timeout=0.0)
    stack.kill("a")
    await stack.clock.advance(20.0)
    assert await stack.is_active()
    assert stack.errors() == []


async def test_node_without_bond_aborts_bringup(stack: Stack) -> None:
    stack.servers["a"] = _Server(stack.graph, NodeOptions(name="a", parameters={"bond_heartbeat_period": 0.0}))
    await stack.manage("a", condition="Aborting bringup")
    assert "Server a was unable to be reached after 4.00s by bond" in stack.errors()[0]


@pytest.mark.parametrize("names", [None, [], ["a", "a"]])
def test_node_names_parameter_is_required(
    start: Callable[[dict[str, object]], object], names: list[str] | None
) -> None:
    with pytest.raises(LinkwrightError, match="node_names"):
        start({} if names is None else {"node_names": names})


@pytest.fixture
def start(graph: Graph) -> Callable[[dict[str, object]], object]:
    return lambda parameters: LifecycleManager(graph, NodeOptions(parameters=parameters))
