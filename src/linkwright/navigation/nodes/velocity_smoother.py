"""nav2's velocity_smoother, which limits ``cmd_vel`` and publishes ``cmd_vel_smoothed``.

The node is managed; parameters, defaults and rules are those of nav2. Deliberate differences: unless
``enable_stamped_cmd_vel`` is set, the node accepts Twist and TwistStamped, and publishes the type that subscribers
expect; and it stops the robot when it is deactivated or the publisher of commands disappears.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Any

from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.graph import Parameter, ParameterType, SetParametersResult, Subscription
from linkwright.graph.endpoints.base import EndpointInfo
from linkwright.graph.endpoints.command_disputes import DisputeMonitor
from linkwright.graph.endpoints.command_guard import CommandGuard, describe_lost_publisher
from linkwright.graph.lifecycle.states import LifecycleState, TransitionCallbackReturn
from linkwright.messages import get_message
from linkwright.navigation.nodes.managed import ManagedNode, ManagedServer
from linkwright.navigation.nodes.velocity_smoothing import AxisLimits, smooth_velocities
from linkwright.nodes.velocity_topic import VelocityTopic, choose_velocity_types
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_QUEUE_DEPTH = 10
_AXES = tuple((part, axis) for part in ("linear", "angular") for axis in "xyz")
_PLANAR = (0, 1, 5)
"""The axes of limits with three entries: x, y and yaw."""
_DEFAULT_LIMITS = {
    "max_velocity": [0.5, 0.0, 2.5],
    "min_velocity": [-0.5, 0.0, -2.5],
    "max_accel": [2.5, 0.0, 3.2],
    "max_decel": [-2.5, 0.0, -3.2],
    "deadband_velocity": [0.0, 0.0, 0.0],
}


class _ManagedSmoother(ManagedNode):
    """The managed node of velocity_smoother."""

    def declare(self) -> None:
        """Declare nav2's parameters."""
        self._output: VelocityTopic | None = None
        self._command: list[float] | None = None
        self._last_command_ns = 0
        self._last_velocities = [0.0] * len(_AXES)
        self._is_stopped = False
        self._measured_velocities: deque[tuple[int, list[float]]] = deque()
        self.declare_parameter("smoothing_frequency", 20.0)
        self.declare_parameter("feedback", "OPEN_LOOP")
        self.declare_parameter("scale_velocities", False)
        for name, value in _DEFAULT_LIMITS.items():
            self.declare_parameter(name, value)
        self.declare_parameter("odom_topic", "odom")
        self.declare_parameter("odom_duration", 0.1)
        self.declare_parameter("velocity_timeout", 1.0)
        self.declare_parameter("use_realtime_priority", False)
        self._is_stamped: bool | None = self.declare_parameter("enable_stamped_cmd_vel", ParameterType.BOOL).value
        self.add_on_set_parameters_callback(self._check_parameters)
        self.add_post_set_parameters_callback(lambda _: self._apply_parameters())

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Configure the node, unless a parameter has an invalid value."""
        problem = self._find_parameter_error({})
        if problem is not None:
            self.get_logger().error(str(problem))
            return TransitionCallbackReturn.FAILURE
        return super().on_configure(state)

    def configure(self) -> None:
        """Read the parameters and create the topics."""
        self._read_parameters()
        is_stamped = self._is_stamped
        self._output = VelocityTopic(self, "cmd_vel_smoothed", is_stamped)
        command_guard = CommandGuard(self._on_publisher_lost, DisputeMonitor.of(self))
        for message_type in choose_velocity_types(self, "cmd_vel", is_stamped):
            subscription: Subscription[Any] = self.create_subscription(
                message_type, "cmd_vel", command_guard.tracking_callback(self._receive), _QUEUE_DEPTH
            )
            command_guard.watch(self.register(subscription))
        if self._get_parameter_value("feedback") == "CLOSED_LOOP":
            odometry = get_message("nav_msgs/msg/Odometry")
            self.register(
                self.create_subscription(
                    odometry, self._get_parameter_value("odom_topic"), self._on_odometry, _QUEUE_DEPTH
                )
            )

    def activate(self) -> None:
        """Start publishing."""
        self.begin_cycles(1.0 / self._frequency, self._smooth)

    def deactivate(self) -> None:
        """Stop the robot, and stop publishing."""
        self.end_cycles()
        if self._output is not None and any(self._last_velocities):
            self._output.stop()
        self._last_velocities, self._command = [0.0] * len(_AXES), None

    def cleanup(self) -> None:
        """Stop publishing, and close the output topic."""
        self.end_cycles()
        if self._output is not None:
            self._output.close()
            self._output = None

    def _get_parameter_value(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _read_parameters(self) -> None:
        self._frequency: float = self._get_parameter_value("smoothing_frequency")
        self._keeps_direction: bool = self._get_parameter_value("scale_velocities")
        self._uses_feedback: bool = self._get_parameter_value("feedback") == "CLOSED_LOOP"
        self._timeout: float = self._get_parameter_value("velocity_timeout")
        self._odometry_window: float = self._get_parameter_value("odom_duration")
        columns = [list(self._get_parameter_value(name)) for name in _DEFAULT_LIMITS]
        if len(columns[0]) == len(_PLANAR):  # Three entries are limits for x, y and yaw.
            columns = [_expand_to_axes(column) for column in columns]
        self._limits = [
            AxisLimits(min_velocity, max_velocity, *other_limits)
            for max_velocity, min_velocity, *other_limits in zip(*columns, strict=True)
        ]

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        problem = self._find_parameter_error({parameter.name: parameter.value for parameter in parameters})
        return SetParametersResult(successful=problem is None, reason="" if problem is None else str(problem))

    def _apply_parameters(self) -> None:
        """Apply changed parameters to the configured node.

        The topics stay the same.
        """
        if self._output is not None:
            old_frequency = self._frequency
            self._read_parameters()
            if self.is_cycling and old_frequency != self._frequency:
                self.begin_cycles(1.0 / self._frequency, self._smooth)

    def _find_parameter_error(self, changed: Mapping[str, Any]) -> Phrase | None:
        """Return an error message if a change would make a parameter invalid, and None otherwise."""

        def value(name: str) -> Any:
            return changed.get(name, self._get_parameter_value(name))

        if not value("smoothing_frequency") > 0.0:
            return phrase("smoothing_frequency must be more than 0")
        if value("feedback") not in ("OPEN_LOOP", "CLOSED_LOOP"):
            return phrase(
                "feedback must be OPEN_LOOP or CLOSED_LOOP, but it is '{feedback}'", feedback=value("feedback")
            )
        lengths = {len(value(name)) for name in _DEFAULT_LIMITS}
        if lengths not in ({len(_PLANAR)}, {len(_AXES)}):
            return phrase(
                "{names} must all have 3 entries (x, y, yaw), or must all have 6 entries",
                names=joined(list(_DEFAULT_LIMITS)),
            )
        for name, sign in (("max_velocity", 1), ("min_velocity", -1), ("max_accel", 1), ("max_decel", -1)):
            if any(item * sign < 0.0 for item in value(name)):
                return (
                    phrase("{name} must not be negative", name=name)
                    if sign > 0
                    else phrase("{name} must not be positive", name=name)
                )
        return None

    def _receive(self, message: Any) -> None:
        is_stamped = hasattr(message, "twist")
        twist = message.twist if is_stamped else message
        values = _list_velocities(twist)
        if not all(map(isfinite, values)):
            self.get_logger().error("Velocity message contains NaNs or Infs! Ignoring as invalid!")
            return
        assert self._output is not None, "it is configured"
        if not any(self._last_velocities):
            self._output.update_type()
        self._output.frame_id = message.header.frame_id if is_stamped else ""
        self._command = values
        self._last_command_ns = self.get_clock().now().nanoseconds

    def _on_timeout(self) -> None:
        """Start to decelerate to zero because commands have timed out."""
        if self._command is not None and any(self._command):
            self._command = [0.0] * len(_AXES)
            self.get_logger().info(
                phrase(
                    "no command was received for {seconds:g} s (velocity_timeout), and the last one was not a stop, so "
                    "the robot is stopped",
                    seconds=self._timeout,
                )
            )

    def _on_publisher_lost(self, publisher: EndpointInfo) -> None:
        """Start to decelerate to zero because the publisher of commands disappeared."""
        if self._command is not None and any(self._command):
            self._command = [0.0] * len(_AXES)
            self.get_logger().warning(
                phrase("{problem}; the robot is stopped", problem=describe_lost_publisher(publisher))
            )

    def _on_odometry(self, message: Any) -> None:
        now_ns = self.get_clock().now().nanoseconds
        self._measured_velocities.append((now_ns, _list_velocities(message.twist.twist)))
        while now_ns - self._measured_velocities[0][0] > self._odometry_window * NANOSECONDS_PER_SECOND:
            self._measured_velocities.popleft()

    def _smooth(self) -> None:
        if self._command is None:
            return
        if (self.get_clock().now().nanoseconds - self._last_command_ns) / NANOSECONDS_PER_SECOND > self._timeout:
            if self._is_stopped or not any(self._last_velocities):
                self._is_stopped = True
                return
            self._on_timeout()
        self._is_stopped = False
        current = self._last_velocities
        if self._uses_feedback:
            measured = [values for _, values in self._measured_velocities] or [[0.0] * len(_AXES)]
            current = [sum(column) / len(measured) for column in zip(*measured, strict=True)]
        self._last_velocities = smooth_velocities(
            self._limits, current, self._command, 1.0 / self._frequency, keep_direction=self._keeps_direction
        )
        output = [axis.apply_deadband(speed) for axis, speed in zip(self._limits, self._last_velocities, strict=True)]
        assert self._output is not None, "it is configured"
        self._output.publish(output[:3], output[3:])


class VelocitySmoother(ManagedServer):
    """The running velocity_smoother node.

    The node becomes active at the start if ``autostart_node`` is set.
    """

    NODE = _ManagedSmoother
    DEFAULT_NAME = "velocity_smoother"


def _list_velocities(twist: Any) -> list[float]:
    return [float(getattr(getattr(twist, vector), axis)) for vector, axis in _AXES]


def _expand_to_axes(column: Sequence[float]) -> list[float]:
    """Expand limits of x, y and yaw to all six axes, with 0 for the other three."""
    expanded = [0.0] * len(_AXES)
    for axis, value in zip(_PLANAR, column, strict=True):
        expanded[axis] = value
    return expanded
