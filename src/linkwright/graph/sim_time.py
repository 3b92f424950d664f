"""Simulated time: a node whose parameter ``use_sim_time`` is true follows the topic ``/clock``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.graph.clock import ROSClock
from linkwright.graph.dispatch import Dispatcher
from linkwright.graph.qos import CLOCK_QOS
from linkwright.graph.subscription import Detailed, Subscription
from linkwright.graph.time import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from linkwright.graph.node import Node

PARAMETER = "use_sim_time"


class SimulatedTime:
    """Keeps a node's clock by ``/clock`` while its parameter ``use_sim_time`` is true (rclpy ``TimeSource``).

    The clock is moved in the thread in which a message of ``/clock`` arrives, not in a callback of the node: so time
    goes on while the node's own thread sleeps.
    """

    def __init__(self, node: Node, clock: ROSClock) -> None:
        self._node = node
        self._clock = clock
        self._subscription: _ClockSubscription | None = None
        if not node.has_parameter(PARAMETER):
            node.declare_parameter(PARAMETER, False)
        value = node.get_parameter(PARAMETER).value
        if isinstance(value, bool):
            self._follow(value)
        else:
            node.get_logger().error(f"Invalid type for parameter '{PARAMETER}' {value!r} should be bool")
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._changed)

    def _check(self, parameters: list[Any]) -> Any:
        from linkwright.graph.parameters.parameter import SetParametersResult

        for parameter in parameters:
            if parameter.name == PARAMETER and not isinstance(parameter.value, bool):
                return SetParametersResult(
                    successful=False, reason="use_sim_time parameter set to something besides a bool"
                )
        return SetParametersResult(successful=True)

    def _changed(self, parameters: list[Any]) -> None:
        for parameter in parameters:
            if parameter.name == PARAMETER:
                self._follow(parameter.value)

    def _follow(self, simulated: bool) -> None:
        if simulated == (self._subscription is not None):
            return
        if simulated:
            self._subscription = _ClockSubscription(self._node, self._clock)
            self._clock.set_ros_time_is_active(True)
            self._node.add_subscription(self._subscription)
        elif self._subscription is not None:
            self._node.destroy_subscription(self._subscription)
            self._subscription = None
            self._clock.set_ros_time_is_active(False)


class _ClockSubscription(Subscription[Any]):
    """Moves a clock by the messages of ``/clock``, in whatever thread they come."""

    def __init__(self, node: Node, clock: ROSClock) -> None:
        super().__init__(node, "rosgraph_msgs/msg/Clock", node.resolve_topic_name("/clock"), CLOCK_QOS, self._move)
        self._ros_clock = clock

    def receive(self, message: Any, info: Any = None) -> None:  # noqa: ARG002  # a subscription's signature
        """Set the clock."""
        call = self._prepared(message)
        if call is not None:
            call()

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """It needs none."""

    def _move(self, message: Any) -> None:
        if isinstance(message, Detailed):
            message = message.message
        stamp = message.clock
        self._ros_clock.override(stamp.sec * NANOSECONDS_PER_SECOND + stamp.nanosec)
