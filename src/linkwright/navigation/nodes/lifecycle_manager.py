"""nav2's lifecycle_manager, which activates managed nodes, and resets them if one dies.

The node has nav2's services, parameters, order and log lines. Deliberate differences: the manager waits for a response
as long as the node exists, with a log line every ``service_timeout`` seconds, so that a slow machine does not cause a
failure. When a node dies, the others are brought down without waiting for it.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Sequence
from enum import Enum, auto
from typing import Any

from linkwright.graph import Graph, Node, Parameter, ParameterType
from linkwright.graph.lifecycle.states import ACTIVE, FINALIZED, INACTIVE, UNCONFIGURED, LifecycleState
from linkwright.graph.loop.node_handle import ReentrantCallbackGroup
from linkwright.messages import get_service
from linkwright.navigation.nodes.bond import TIMEOUT_S, Bond
from linkwright.nodes.diagnostic_updater import DiagnosticUpdater, Health, Level
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.service_waits import wait_for_future, wait_for_service
from linkwright.nodes.settings import invalid_value_error, log_unknown_parameters

_CHECK_PERIOD_S = 1.0


class _Transition(Enum):
    """A transition, with its ID, the log line that precedes it, and the resulting state."""

    CONFIGURE = (1, "Configuring", INACTIVE)
    CLEANUP = (2, "Cleaning up", UNCONFIGURED)
    ACTIVATE = (3, "Activating", ACTIVE)
    DEACTIVATE = (4, "Deactivating", INACTIVE)
    SHUTDOWN = (5, "Shutting down", FINALIZED)

    def __init__(self, transition_id: int, line: str, goal_state: LifecycleState) -> None:
        self.number, self.line, self.goal_state = transition_id, line, goal_state


class _State(Enum):
    """The common state of the managed nodes."""

    UNCONFIGURED = auto()
    INACTIVE = auto()
    ACTIVE = auto()
    FINALIZED = auto()
    UNKNOWN = auto()


_HEALTH_BY_STATE = {
    _State.UNCONFIGURED: Health(Level.OK, "Managed nodes are unconfigured"),
    _State.INACTIVE: Health(Level.OK, "Managed nodes are inactive"),
    _State.ACTIVE: Health(Level.OK, "Managed nodes are active"),
    _State.FINALIZED: Health(Level.WARN, "Managed nodes have been shut down"),
    _State.UNKNOWN: Health(Level.ERROR, "An error has occurred during a node state transition"),
}
"""The diagnostics of the states, with Jazzy's messages. Humble reports only active and inactive."""


class _ManagedNodeClient:
    """A client of one managed node.

    Args:
        node: the node that calls the services.
        name: the name of the managed node, relative to the namespace of `node`.
    """

    def __init__(self, node: Node, name: str) -> None:
        self.name = name
        self.bond: Bond | None = None
        self._node = node
        self._change_type, self._get = (
            get_service("lifecycle_msgs/srv/ChangeState"),
            get_service("lifecycle_msgs/srv/GetState"),
        )
        self._change_client = node.create_client(self._change_type, f"{name}/change_state")
        self._get_client = node.create_client(self._get, f"{name}/get_state")

    def is_available(self) -> bool:
        """Return whether the lifecycle services of the managed node are available."""
        return bool(self._change_client.service_is_ready() and self._get_client.service_is_ready())

    async def wait_until_available(self, log_period: float) -> None:
        """Wait until the lifecycle services of the managed node are available.

        A line is logged every `log_period` seconds.
        """
        for client in (self._change_client, self._get_client):
            while not await wait_for_service(self._node, client, log_period):
                self._node.get_logger().info(f"Waiting for service {client.service_name}...")

    async def run_transition(self, transition: _Transition, log_period: float) -> bool:
        """Run a transition, and return whether the node reached the resulting state.

        The transition fails if the node disappears before it responds. A line is logged every `log_period` seconds.
        """
        request = self._change_type.Request()
        request.transition.id = transition.number
        response = await self._call(self._change_client, request, log_period)
        return (
            bool(response is not None and response.success)
            and await self.get_state(log_period) == transition.goal_state.state_id
        )

    async def get_state(self, log_period: float) -> int | None:
        """Return the ID of the node's lifecycle state, or None if the node is not available.

        A line is logged every `log_period` seconds.
        """
        response = await self._call(self._get_client, self._get.Request(), log_period)
        return None if response is None else int(response.current_state.id)

    async def reports_unconfigured(self, seconds: float) -> bool:
        """Return whether the node reports within `seconds` that it is unconfigured."""
        if not self.is_available():
            return False
        future = self._get_client.call_async(self._get.Request())
        if await wait_for_future(self._node, future, seconds):
            response: Any = future.result()
            return bool(response.current_state.id == UNCONFIGURED.state_id)
        self._get_client.remove_pending_request(future)
        return False

    def end_bond(self) -> None:
        """End the bond with the managed node, if there is one."""
        if self.bond is not None:
            self.bond.end()
            self.bond = None

    async def _call(self, client: Any, request: Any, log_period: float) -> Any:
        if not client.service_is_ready():
            return None
        future = client.call_async(request)
        while not await wait_for_future(self._node, future, log_period):
            if not client.service_is_ready():
                client.remove_pending_request(future)
                return None
            self._node.get_logger().warning(f"{client.service_name} has not answered for another {log_period:g} s")
        return future.result()


class LifecycleManager(SingleNode):
    """The running lifecycle_manager node.

    Raises:
        LinkwrightError: NODE433, ``node_names`` is empty, or contains an empty name or the same name twice.
    """

    DEFAULT_NAME = "lifecycle_manager"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._logger = self._node.get_logger()
        self._logger.info("Creating")
        with handle_start_errors(self._node):
            self._declare_parameters()
            log_unknown_parameters(self._node)
        self._state = _State.UNCONFIGURED
        self._command_lock = asyncio.Lock()
        self._tasks: set[asyncio.Task[Any]] = set()
        self._logger.info("Creating and initializing lifecycle service clients")
        self._managed_nodes = [_ManagedNodeClient(self._node, name) for name in self._names]
        group = ReentrantCallbackGroup()  # ``is_active`` must respond while a long command runs.
        name = self._node.get_name()
        for service_type, service, callback in (
            ("nav2_msgs/srv/ManageLifecycleNodes", "manage_nodes", self._on_manage),
            ("std_srvs/srv/Trigger", "is_active", self._on_is_active),
        ):
            self._node.create_service(get_service(service_type), f"{name}/{service}", callback, callback_group=group)
        DiagnosticUpdater(self._node, "Nav2 Health", lambda: _HEALTH_BY_STATE[self._state], hardware_id="Nav2")
        if self._autostart:
            self._start_task(self._run_exclusively(self._startup))

    def close(self) -> None:
        """Close the manager, but keep the states of the managed nodes."""
        for task in self._tasks:
            task.cancel()
        for managed in self._managed_nodes:
            managed.end_bond()
        super().close()

    def _declare_parameters(self) -> None:
        node = self._node
        node.declare_parameter("node_names", ParameterType.STRING_ARRAY)
        names = node.get_parameter_or("node_names", Parameter("node_names")).value
        self._names: list[str] = list(names or [])
        duplicates = [name for name in self._names if self._names.count(name) > 1]
        if not self._names or duplicates or "" in self._names:
            raise invalid_value_error("node_names", self._names, node.get_name())
        declare = node.declare_parameter
        self._autostart: bool = declare("autostart", False).value
        self._bond_timeout: float = declare("bond_timeout", TIMEOUT_S).value
        self._log_period: float = declare("service_timeout", 5.0).value
        self._max_respawn_seconds: float = declare("bond_respawn_max_duration", 10.0).value
        self._reconnects: bool = declare("attempt_respawn_reconnection", True).value

    # --- commands ----------------------------------------------------------------------------------------------------

    async def _on_manage(self, request: Any, response: Any) -> Any:
        commands: Sequence[Callable[[], Coroutine[Any, Any, bool]]] = (
            self._startup,
            self._pause,
            self._resume,
            self._reset,
            self._shutdown,
            self._configure,
            self._cleanup,
        )
        if request.command < len(commands):
            response.success = await self._run_exclusively(commands[request.command])
        else:
            self._logger.error(f"{request.command} is not a command of ManageLifecycleNodes")
        return response

    def _on_is_active(self, _request: Any, response: Any) -> Any:
        response.success = self._state is _State.ACTIVE
        return response

    async def _run_exclusively(self, command: Callable[[], Coroutine[Any, Any, bool]]) -> bool:
        """Run a command after all earlier commands have finished, and return whether it succeeded."""
        async with self._command_lock:
            return await command()

    async def _startup(self) -> bool:
        self._logger.info("Starting managed nodes bringup...")
        if not await self._transition_all(_Transition.CONFIGURE) or not await self._transition_all(
            _Transition.ACTIVATE
        ):
            return self._fail("Failed to bring up all requested nodes. Aborting bringup.")
        return self._set_state(_State.ACTIVE, "Managed nodes are active")

    async def _configure(self) -> bool:
        self._logger.info("Configuring managed nodes...")
        if not await self._transition_all(_Transition.CONFIGURE):
            return self._fail("Failed to configure all requested nodes. Aborting bringup.")
        return self._set_state(_State.INACTIVE, "Managed nodes are now configured")

    async def _cleanup(self) -> bool:
        self._logger.info("Cleaning up managed nodes...")
        if not await self._transition_all(_Transition.CLEANUP):
            return self._fail("Failed to cleanup all requested nodes. Aborting cleanup.")
        return self._set_state(_State.UNCONFIGURED, "Managed nodes have been cleaned up")

    async def _pause(self) -> bool:
        self._logger.info("Pausing managed nodes...")
        if not await self._transition_all(_Transition.DEACTIVATE):
            return self._fail("Failed to pause nodes: aborting pause")
        return self._set_state(_State.INACTIVE, "Managed nodes have been paused")

    async def _resume(self) -> bool:
        self._logger.info("Resuming managed nodes...")
        if not await self._transition_all(_Transition.ACTIVATE):
            return self._fail("Failed to resume nodes: aborting resume")
        return self._set_state(_State.ACTIVE, "Managed nodes are active")

    async def _reset(self) -> bool:
        self._logger.info("Resetting managed nodes...")
        if not await self._transition_all(_Transition.DEACTIVATE) or not await self._transition_all(
            _Transition.CLEANUP
        ):
            return self._fail("Failed to reset nodes: aborting reset")
        return self._set_state(_State.UNCONFIGURED, "Managed nodes have been reset")

    async def _shutdown(self) -> bool:
        self._logger.info("Shutting down managed nodes...")
        self._logger.info("Deactivate, cleanup, and shutdown nodes")
        self._state = _State.FINALIZED
        for transition in (_Transition.DEACTIVATE, _Transition.CLEANUP, _Transition.SHUTDOWN):
            await self._transition_all(transition, ignore_failures=True)
        return self._set_state(_State.FINALIZED, "Managed nodes have been shut down")

    def _fail(self, line: str) -> bool:
        self._logger.error(line)
        self._state = _State.UNKNOWN
        return False

    def _set_state(self, state: _State, line: str) -> bool:
        self._logger.info(line)
        self._state = state
        return True

    async def _transition_all(
        self, transition: _Transition, *, ignore_failures: bool = False, skipped: _ManagedNodeClient | None = None
    ) -> bool:
        """Run a transition of all nodes, and return whether all succeeded.

        Nodes are configured and activated in order, and taken down in reverse order.

        Args:
            transition: the transition that each managed node runs.
            ignore_failures: whether to continue after a failure.
            skipped: a node that is left out; None for no node.
        """
        is_bringup = transition in (_Transition.CONFIGURE, _Transition.ACTIVATE)
        for managed in self._managed_nodes if is_bringup else reversed(self._managed_nodes):
            if (
                managed is not skipped
                and not await self._transition(managed, transition, wait=is_bringup)
                and not ignore_failures
            ):
                return False
        return True

    async def _transition(self, managed: _ManagedNodeClient, transition: _Transition, *, wait: bool) -> bool:
        self._logger.info(f"{transition.line} {managed.name}")
        if wait:
            await managed.wait_until_available(self._log_period)
        if transition is not _Transition.ACTIVATE:
            managed.end_bond()  # End the bond before the node leaves it; otherwise that would count as a failure.
        if not await managed.run_transition(transition, self._log_period):
            self._logger.error(f"Failed to change state for node: {managed.name}")
            return False
        return transition is not _Transition.ACTIVATE or await self._form_bond(managed)

    # --- bonds -------------------------------------------------------------------------------------------------------

    async def _form_bond(self, managed: _ManagedNodeClient) -> bool:
        if self._bond_timeout <= 0.0:
            return True
        formed: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        managed.end_bond()
        managed.bond = Bond(
            self._node,
            managed.name,
            timeout=self._bond_timeout,
            on_formed=lambda: _set_done(formed),
            on_broken=lambda: self._on_bond_broken(managed),
        )
        if not await wait_for_future(self._node, formed, self._bond_timeout):
            formed.cancel()
            managed.end_bond()
            self._logger.error(
                f"Server {managed.name} was unable to be reached after {self._bond_timeout:0.2f}s by bond. "
                "This server may be misconfigured."
            )
            return False
        self._logger.info(f"Server {managed.name} connected with bond.")
        return True

    def _on_bond_broken(self, managed: _ManagedNodeClient) -> None:
        self._start_task(self._run_exclusively(lambda: self._bring_down(managed)))

    async def _bring_down(self, dead: _ManagedNodeClient) -> bool:
        """Reset the other nodes after one died, and start reconnecting if that is enabled."""
        if dead.bond is None:
            return True  # The node was taken down with another node, or by a command.
        if self._state not in (_State.ACTIVE, _State.UNKNOWN):
            return True
        self._logger.info(f"Have not received a heartbeat from {dead.name}.")
        self._logger.error(
            f"CRITICAL FAILURE: SERVER {dead.name} IS DOWN after not receiving a heartbeat for "
            f"{self._bond_timeout * 1000.0:.0f} ms. Shutting down related nodes."
        )
        self._logger.info("Resetting managed nodes...")
        dead.end_bond()
        for transition in (_Transition.DEACTIVATE, _Transition.CLEANUP):
            await self._transition_all(transition, ignore_failures=True, skipped=dead)
        self._set_state(_State.UNCONFIGURED, "Managed nodes have been reset")
        if self._reconnects:
            self._start_task(self._reconnect())
        return True

    async def _reconnect(self) -> None:
        """Wait until all nodes are available again, and start them.

        The wait ends after ``bond_respawn_max_duration``, or when a command changes the nodes.
        """
        waited_seconds = 0.0
        while waited_seconds < self._max_respawn_seconds and self._is_still_down():
            await wait_for_future(self._node, asyncio.get_running_loop().create_future(), _CHECK_PERIOD_S)
            waited_seconds += _CHECK_PERIOD_S
            async with self._command_lock:
                if self._is_still_down() and all(
                    [await managed.reports_unconfigured(_CHECK_PERIOD_S) for managed in self._managed_nodes]
                ):
                    self._logger.info("Successfully re-established connections from server respawns, starting back up.")
                    await self._startup()
                    return
        if self._is_still_down():
            self._logger.info("Failed to re-establish connection from a server crash after maximum timeout.")

    def _is_still_down(self) -> bool:
        """Return whether no command has changed the nodes since they were taken down."""
        return self._state is _State.UNCONFIGURED

    def _start_task(self, work: Coroutine[Any, Any, Any]) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)


def _set_done(future: asyncio.Future[None]) -> None:
    if not future.done():
        future.set_result(None)
