"""Base classes of nav2's servers: managed nodes with nav2's log lines and a bond."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar, Protocol, TypeVar

from linkwright.diagnostics import LinkwrightError, render
from linkwright.graph import Graph, Node, Timer
from linkwright.graph.lifecycle.managed_node import LifecycleNodeMixin
from linkwright.graph.lifecycle.states import ACTIVE, LifecycleState, TransitionCallbackReturn
from linkwright.navigation.nodes.bond import PERIOD_S, Bond
from linkwright.nodes.options import NodeOptions, SingleNode, create_node_with_class, handle_start_errors
from linkwright.nodes.settings import log_unknown_parameters

_SUCCESS = TransitionCallbackReturn.SUCCESS


class _Destroyable(Protocol):
    def destroy(self) -> Any: ...


P = TypeVar("P", bound=_Destroyable)


class ManagedNode(LifecycleNodeMixin, Node):
    """A server of nav2 as a managed node.

    Derived classes declare their parameters in `declare` and do their work in `configure`, `activate`, `deactivate`
    and `cleanup`. A `LinkwrightError` raised in `configure` or `activate` is logged, and the transition fails. Objects
    passed to `register` are destroyed when the node is cleaned up.
    """

    def __init__(self, *arguments: Any, **keywords: Any) -> None:
        Node.__init__(self, *arguments, **keywords)
        LifecycleNodeMixin.__init__(self)
        self._registered: list[_Destroyable] = []
        self._bond: Bond | None = None
        self._timer: Timer | None = None
        self._has_logged_unknown = False
        self.get_logger().info("Creating")
        self._heartbeat_period: float = self.declare_parameter("bond_heartbeat_period", PERIOD_S).value
        self._is_autostarted: bool = self.declare_parameter("autostart_node", False).value
        self.declare()

    def declare(self) -> None:
        """Declare the parameters.

        `configure` may declare more.
        """

    def configure(self) -> None:
        """Read the parameters, and create the topics."""

    def activate(self) -> None:
        """Start the node's work."""

    def deactivate(self) -> None:
        """Stop the node's work."""

    def cleanup(self) -> None:
        """Drop the objects that are not registered.

        This method is also called after `configure` has failed halfway.
        """

    def register(self, resource: P) -> P:
        """Register an object that is destroyed when the node is cleaned up, and return the object."""
        self._registered.append(resource)
        return resource

    @property
    def is_active(self) -> bool:
        """Whether the node is active."""
        return self.lifecycle_state == ACTIVE

    def now_ns(self) -> int:
        """Return the time of the node's clock, in nanoseconds."""
        return self.get_clock().now().nanoseconds

    @property
    def is_cycling(self) -> bool:
        """Whether cycles are running: `end_cycles` was not called since `begin_cycles`."""
        return self._timer is not None

    def begin_cycles(self, period: float, cycle: Callable[[], object]) -> None:
        """Call a function every `period` seconds of the node's clock.

        The function replaces an earlier one.
        """
        self.end_cycles()
        self._timer = self.create_timer(period, cycle)

    def end_cycles(self) -> None:
        """Stop the calls started by `begin_cycles`, if there are any."""
        if self._timer is not None:
            self._timer.destroy()
            self._timer = None

    def autostart(self) -> None:
        """Configure and activate the node if ``autostart_node`` is set."""
        if self._is_autostarted and self.trigger_configure() == _SUCCESS:
            self.trigger_activate()

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Run `configure`, and log unknown parameters after its first success."""
        self.get_logger().info("Configuring")
        try:
            self.configure()
        except LinkwrightError as error:
            self.log_error(error)
            self._release()
            return TransitionCallbackReturn.FAILURE
        if not self._has_logged_unknown:
            self._has_logged_unknown = True
            log_unknown_parameters(self)
        return super().on_configure(state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Run `activate` and form the bond."""
        self.get_logger().info("Activating")
        result = super().on_activate(state)
        try:
            self.activate()
        except LinkwrightError as error:
            self.log_error(error)
            super().on_deactivate(state)
            return TransitionCallbackReturn.FAILURE
        if self._heartbeat_period > 0.0:
            self.get_logger().info(f"Creating bond ({self.get_name()}) to lifecycle manager.")
            self._bond = Bond(self, self.get_name(), period=self._heartbeat_period)
        return result

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Run `deactivate` and break the bond."""
        self.get_logger().info("Deactivating")
        self.deactivate()
        self._end_bond()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Run `cleanup` and destroy the registered objects."""
        self.get_logger().info("Cleaning up")
        self._release()
        return super().on_cleanup(state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Deactivate the node if it is active, and clean up."""
        self.get_logger().info("Shutting down")
        if state == ACTIVE:
            self.deactivate()
        self._end_bond()
        self._release()
        return super().on_shutdown(state)

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Clean up after an error in a transition, so that the node can be configured again."""
        self._end_bond()
        self._release()
        return super().on_error(state)

    def shut_down(self) -> None:
        """Stop working, break the bond and clean up, before the node is destroyed."""
        if self.is_active:
            self.deactivate()
        self._end_bond()
        self._release()

    def _release(self) -> None:
        self.cleanup()
        for resource in self._registered:
            resource.destroy()
        self._registered.clear()

    def _end_bond(self) -> None:
        if self._bond is not None:
            self.get_logger().info(f"Destroying bond ({self.get_name()}) to lifecycle manager.")
            self._bond.end()
            self._bond = None

    def log_error(self, error: LinkwrightError) -> None:
        """Log a finding with its location and hint."""
        self.get_logger().error("\n".join(render(diagnostic) for diagnostic in error.diagnostics))


class ManagedServer(SingleNode):
    """The base class of running nodes of nav2's servers.

    Attributes:
        NODE: the class of the node.
    """

    NODE: ClassVar[type[ManagedNode]]

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        node, _ = create_node_with_class(self.NODE, graph, options, self.DEFAULT_NAME)
        self._node: ManagedNode = node
        with handle_start_errors(node):
            self.prepare(graph, options)
            node.autostart()

    def prepare(self, graph: Graph, options: NodeOptions) -> None:
        """Prepare the node before it starts.

        By default, do nothing.
        """

    def close(self) -> None:
        """Close the node and notify its manager."""
        self._node.shut_down()
        super().close()
