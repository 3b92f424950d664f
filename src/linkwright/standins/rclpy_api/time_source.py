"""Set clocks from ``/clock`` (rclpy ``time_source``).

The clock of a node does not need this module.
"""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from linkwright.graph.parameters.parameter import Parameter
from linkwright.graph.qos.profile import CLOCK_QOS
from linkwright.graph.time.clock import Clock, ROSClock
from linkwright.graph.time.values import ClockType, Time
from linkwright.messages import get_message

if TYPE_CHECKING:
    from linkwright.graph.endpoints.subscription import Subscription
    from linkwright.standins.rclpy_api.node import Node

CLOCK_TOPIC = "/clock"
USE_SIM_TIME_NAME = "use_sim_time"


class TimeSource:
    """A source that sets clocks from ``/clock`` while a node's ``use_sim_time`` is true.

    Args:
        node: the node that has the parameter and the subscription; None to attach a node later.
    """

    def __init__(self, *, node: Node | None = None) -> None:
        self._clock_sub: Subscription[Any] | None = None
        self._node: weakref.ref[Node] | None = None
        self._clocks: weakref.WeakSet[ROSClock] = weakref.WeakSet()
        self._last_time = Time(clock_type=ClockType.ROS_TIME)
        self._active = False
        if node is not None:
            self.attach_node(node)

    @property
    def ros_time_is_active(self) -> bool:
        """Whether the clocks use the simulated time of ``/clock``."""
        return self._active

    @ros_time_is_active.setter
    def ros_time_is_active(self, enabled: bool) -> None:
        self._active = enabled
        for clock in self._clocks:
            clock.set_ros_time_is_active(enabled)
        node = self._get_node()
        if enabled and self._clock_sub is None and node is not None:
            clock_type = get_message("rosgraph_msgs/msg/Clock")
            self._clock_sub = node.create_subscription(clock_type, CLOCK_TOPIC, self.clock_callback, CLOCK_QOS)
        elif not enabled:
            self._unsubscribe()

    def attach_node(self, node: Node) -> None:
        """Follow ``use_sim_time`` of a node, and detach the node that was attached before."""
        self.detach_node()
        self._node = weakref.ref(node)
        if not node.has_parameter(USE_SIM_TIME_NAME):
            node.declare_parameter(USE_SIM_TIME_NAME, False)
        self.ros_time_is_active = node.get_parameter(USE_SIM_TIME_NAME).value is True
        node.add_post_set_parameters_callback(self._on_set_parameters)

    def detach_node(self) -> None:
        """Stop following the node's parameter and ``/clock``.

        The clocks keep their time.
        """
        node = self._get_node()
        if node is not None:
            self._unsubscribe()
            node.remove_post_set_parameters_callback(self._on_set_parameters)
        self._node = None

    def attach_clock(self, clock: Clock) -> None:
        """Add a clock to set from ``/clock``.

        Raises:
            ValueError: the clock is not a ROS time clock.
        """
        if not isinstance(clock, ROSClock):
            raise ValueError("Only clocks with type ROS_TIME can be attached.")  # noqa: TRY004 - as in rclpy
        clock.set_ros_time_override(self._last_time)
        clock.set_ros_time_is_active(self._active)
        self._clocks.add(clock)

    def clock_callback(self, msg: Any) -> None:
        """Set the clocks from a message of ``/clock``."""
        self._last_time = Time.from_msg(msg.clock)
        for clock in self._clocks:
            clock.set_ros_time_override(self._last_time)

    def _on_set_parameters(self, parameters: Sequence[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == USE_SIM_TIME_NAME:
                self.ros_time_is_active = parameter.value is True

    def _unsubscribe(self) -> None:
        subscription, self._clock_sub = self._clock_sub, None
        node = self._get_node()
        if subscription is not None and node is not None:
            node.destroy_subscription(subscription)

    def _get_node(self) -> Node | None:
        return None if self._node is None else self._node()
