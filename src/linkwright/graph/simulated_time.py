"""Simulated time: the time on ``/clock``, for nodes whose ``use_sim_time`` is true."""

from __future__ import annotations

from typing import Any

from linkwright.graph.endpoints.subscription import QueuedMessage, Subscription
from linkwright.graph.loop.node_handle import Dispatcher, NodeHandle
from linkwright.graph.parameters.node_parameters import NodeParameters
from linkwright.graph.parameters.parameter import SetParametersResult
from linkwright.graph.qos.profile import CLOCK_QOS
from linkwright.graph.time.clock import ROSClock
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

PARAMETER = "use_sim_time"

CLOCK_TOPIC = "/clock"


class SimulatedTime:
    """A time source that sets a node's clock from ``/clock`` while ``use_sim_time`` is true.

    It corresponds to rclpy's ``TimeSource``.

    The clock is set in the thread in which a message of ``/clock`` arrives, not in a callback of the node, so time
    advances while the node's own thread sleeps.

    Args:
        handle: the handle of the node, which subscribes to ``/clock``.
        parameters: the parameters of the node.
        clock: the clock of the node.
    """

    def __init__(self, handle: NodeHandle, parameters: NodeParameters, clock: ROSClock) -> None:
        self._handle = handle
        self._clock = clock
        self._subscription: _ClockSubscription | None = None
        if not parameters.has_parameter(PARAMETER):
            parameters.declare_parameter(PARAMETER, False)
        value = parameters.get_parameter(PARAMETER).value
        if isinstance(value, bool):
            self._switch_clock(value)
        else:
            handle.logger.error(f"Invalid type for parameter '{PARAMETER}' {value!r} should be bool")
        parameters.add_on_set_parameters_callback(self._check)
        parameters.add_post_set_parameters_callback(self._on_change)

    def _check(self, parameters: list[Any]) -> Any:
        for parameter in parameters:
            if parameter.name == PARAMETER and not isinstance(parameter.value, bool):
                return SetParametersResult(
                    successful=False, reason="use_sim_time parameter set to something besides a bool"
                )
        return SetParametersResult(successful=True)

    def _on_change(self, parameters: list[Any]) -> None:
        for parameter in parameters:
            if parameter.name == PARAMETER:
                self._switch_clock(parameter.value)

    def _switch_clock(self, use_simulated_time: bool) -> None:
        if use_simulated_time == (self._subscription is not None):
            return
        if use_simulated_time:
            self._subscription = _ClockSubscription(self._handle, self._clock)
            self._clock.set_ros_time_is_active(True)
            self._handle.add(self._subscription)
        elif self._subscription is not None:
            self._subscription.destroy()
            self._subscription = None
            self._clock.set_ros_time_is_active(False)


class _ClockSubscription(Subscription[Any]):
    """A subscription that sets a clock in the thread that receives the messages of ``/clock``."""

    def __init__(self, node: NodeHandle, clock: ROSClock) -> None:
        super().__init__(node, "rosgraph_msgs/msg/Clock", node.resolve_topic_name(CLOCK_TOPIC), CLOCK_QOS, self._move)
        self._ros_clock = clock

    def enqueue(self, message: Any, info: Any = None) -> None:
        """Set the clock to the time in the message, instead of queuing the message for a callback."""
        if type(message) is self._plain_type:
            self._move(message)
            return
        call = self._prepare_call(message)
        if call is not None:
            call()

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """Do nothing, because this subscription needs no dispatcher."""

    def _move(self, message: Any) -> None:
        if isinstance(message, QueuedMessage):
            message = message.message
        stamp = message.clock
        self._ros_clock.set_simulated_time(stamp.sec * NANOSECONDS_PER_SECOND + stamp.nanosec)
