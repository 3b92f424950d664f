"""teleop_twist_joy's teleop_node, which drives a robot by joystick while a button is held.

Parameters and defaults are those of the ROS node. Deliberate differences: unless ``publish_stamped_twist`` is set, the
node publishes the type that the subscriptions of the topic expect; and it stops the robot when the last publisher of
``joy`` disappears.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.graph import Clock, ClockType, EndpointKind, Graph, Node, ParameterType
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.velocity_topic import VelocityTopic

_QUEUE_DEPTH = 10
_TYPE_CHECK_PERIOD_S = 0.5
_LINEAR_COMPONENTS, _ANGULAR_COMPONENTS = ("x", "y", "z"), ("roll", "pitch", "yaw")
_DEFAULT_AXES = {"linear.x": 5, "angular.yaw": 2}
_DEFAULT_SCALES = {"linear.x": 0.5, "angular.yaw": 0.5}
_DEFAULT_TURBO_SCALES = {"linear.x": 1.0, "angular.yaw": 1.0}


@dataclass(frozen=True, slots=True)
class _Axis:
    """The mapping from a joystick axis to one component of the velocity.

    Attributes:
        number: the number of the joystick's axis; negative for none.
        scale: the velocity at the axis's end position, in m/s or rad/s.
        turbo_scale: the velocity at the end position while the turbo button is held.
    """

    number: int
    scale: float
    turbo_scale: float

    def velocity(self, axes: Sequence[float], *, turbo: bool) -> float:
        """Return the velocity for axis values, or 0 if the joystick does not have the axis."""
        if not 0 <= self.number < len(axes):
            return 0.0
        return axes[self.number] * (self.turbo_scale if turbo else self.scale)


class TeleopTwistJoy(SingleNode):
    """The running teleop_node."""

    DEFAULT_NAME = "teleop_twist_joy_node"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._is_driving = False
        with handle_start_errors(self._node):
            self._start()

    def _start(self) -> None:
        node = self._node
        is_stamped: bool | None = node.declare_parameter("publish_stamped_twist", ParameterType.BOOL).value
        frame: str = node.declare_parameter("frame", "teleop_twist_joy").value
        for name, default in (
            ("require_enable_button", True),
            ("enable_button", 5),
            ("enable_turbo_button", -1),
            ("inverted_reverse", False),
        ):
            node.declare_parameter(name, default)
        for kind, names in (("linear", _LINEAR_COMPONENTS), ("angular", _ANGULAR_COMPONENTS)):
            for name in names:
                key = f"{kind}.{name}"
                node.declare_parameter(f"axis_{key}", _DEFAULT_AXES.get(key, -1))
                node.declare_parameter(f"scale_{key}", _DEFAULT_SCALES.get(key, 0.0))
                node.declare_parameter(f"scale_{kind}_turbo.{name}", _DEFAULT_TURBO_SCALES.get(key, 0.0))
        self._apply_parameters()
        node.add_post_set_parameters_callback(lambda _: self._apply_parameters())
        self._topic = VelocityTopic(node, "cmd_vel", is_stamped, frame)
        self._joy_topic = node.resolve_topic_name("joy")
        node.create_subscription(get_message("sensor_msgs/msg/Joy"), "joy", self._on_joy, _QUEUE_DEPTH)
        clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        node.create_timer(_TYPE_CHECK_PERIOD_S, self._check_topics, clock=clock)
        logger = node.get_logger()
        if self._needs_button:
            logger.info(f"Teleop enable button {self._enable_button}.")
        if self._turbo_button >= 0:
            logger.info(f"Turbo on button {self._turbo_button}.")

    def close(self) -> None:
        """Stop the robot if this node was driving it, and close the node."""
        if self._is_driving:
            self._topic.stop()
        self._topic.close()
        super().close()

    def _apply_parameters(self) -> None:
        node = self._node
        self._needs_button: bool = node.get_parameter("require_enable_button").value
        self._enable_button: int = node.get_parameter("enable_button").value
        self._turbo_button: int = node.get_parameter("enable_turbo_button").value
        self._inverts_reverse: bool = node.get_parameter("inverted_reverse").value
        self._linear_axes = [_read_axis(node, "linear", name) for name in _LINEAR_COMPONENTS]
        self._angular_axes = [_read_axis(node, "angular", name) for name in _ANGULAR_COMPONENTS]

    def _on_joy(self, message: Any) -> None:
        buttons, axes = message.buttons, message.axes
        is_turbo = _is_pressed(buttons, self._turbo_button)
        if is_turbo or not self._needs_button or _is_pressed(buttons, self._enable_button):
            linear = [axis.velocity(axes, turbo=is_turbo) for axis in self._linear_axes]
            angular = [axis.velocity(axes, turbo=is_turbo) for axis in self._angular_axes]
            if self._inverts_reverse and linear[0] < 0.0:
                angular[2] = -angular[2]
            self._is_driving = True
            self._topic.publish(linear, angular)
        else:
            self._stop()

    def _stop(self) -> None:
        """Publish a zero velocity once, if this node was driving the robot."""
        if self._is_driving:
            self._is_driving = False
            self._topic.stop()

    def _check_topics(self) -> None:
        self._topic.update_type(may_change=not self._is_driving)
        if self._is_driving and not any(
            endpoint.name == self._joy_topic and endpoint.kind is EndpointKind.PUBLISHER
            for endpoint in self._node.graph.endpoints()
        ):
            self._stop()
            self._node.get_logger().warning(
                phrase("'{topic}' no longer has a publisher, so the robot is stopped", topic=self._joy_topic)
            )


def _read_axis(node: Node, kind: str, name: str) -> _Axis:
    return _Axis(
        node.get_parameter(f"axis_{kind}.{name}").value,
        node.get_parameter(f"scale_{kind}.{name}").value,
        node.get_parameter(f"scale_{kind}_turbo.{name}").value,
    )


def _is_pressed(buttons: Sequence[int], number: int) -> bool:
    return 0 <= number < len(buttons) and buttons[number] != 0
