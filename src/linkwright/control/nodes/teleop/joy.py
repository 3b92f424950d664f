"""joy_node and joy_linux_node, which publish the state of a joystick on ``joy``.

Parameters, the order of axes and buttons, and their signs (forwards and left are positive) are those of the ROS nodes
of the packages joy and joy_linux. A directional pad is represented by two axes after the others. Deliberate
differences: when a joystick is unplugged, the node publishes a last message in which nothing is pressed, so that
subscribers stop the robot; rumble is not supported.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any

from linkwright.control.nodes.teleop.joystick_device import MAX_VALUE, JoystickDevice, JoystickEvent, find_device
from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.diagnostics.translation import localized
from linkwright.graph import Clock, ClockType, Graph, Node, ParameterType
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors

_QUEUE_DEPTH = 10
_RETRY_SECONDS = 1.0
_MAX_RATE_HZ = 1000.0


@dataclass(frozen=True, slots=True)
class _Settings:
    """The settings common to both nodes.

    Attributes:
        number: the number of the device.
        name: a part of the device's name; empty to use the number or path.
        path: the path of the device; None to use the number or name.
        deadzone: the fraction of an axis around its center that counts as 0.
        repeat_rate_hz: the rate of messages while nothing changes, in Hz; 0 for none.
        coalesce_interval_s: the time for which changes of axis positions are collected, in seconds.
        sticky: whether a button stays pressed until it is pressed again.
    """

    number: int
    name: str
    path: Path | None
    deadzone: float
    repeat_rate_hz: float
    coalesce_interval_s: float
    sticky: bool

    def device(self) -> Path | None:
        """Return the path of the device, or None if it does not exist."""
        if self.path is not None and not self.name:
            return self.path if self.path.exists() else None
        return find_device(self.number, self.name)

    def requested_device(self) -> str:
        """Return the requested name or path of the device, for log messages."""
        return f"'{self.name}'" if self.name else str(self.path or f"/dev/input/js{self.number}")


class JoyNode(SingleNode):
    """The running joy_node.

    Parameters: ``device_id``, ``device_name``, ``deadzone``, ``autorepeat_rate``, ``sticky_buttons``,
    ``coalesce_interval_ms``, or ``coalesce_interval`` in s.

    Raises:
        LinkwrightError: NODE903, a parameter is out of its range.
    """

    DEFAULT_NAME = "joy_node"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._device: JoystickDevice | None = None
        self._axes: list[float] = []
        self._buttons: list[int] = []
        self._logged_reason: str | None = None
        with handle_start_errors(self._node):
            self._settings = self._read_settings(self._node)
            self._start()

    def close(self) -> None:
        """Close the joystick and the node."""
        if self._device is not None:
            self._device.close()
        super().close()

    def _read_settings(self, node: Node) -> _Settings:
        number: int = node.declare_parameter("device_id", 0).value
        name: str = node.declare_parameter("device_name", "").value
        node.declare_parameter("autocenter", 0)
        milliseconds = _declare_number(node, "coalesce_interval_ms", 1, 0, None)
        seconds: float | None = node.declare_parameter("coalesce_interval", ParameterType.DOUBLE).value
        return _declare_settings(node, number, name, None, milliseconds / 1000.0 if seconds is None else seconds)

    def _start(self) -> None:
        settings, node = self._settings, self._node
        self._message_type = get_message("sensor_msgs/msg/Joy")
        self._publisher = node.create_publisher(self._message_type, "joy", _QUEUE_DEPTH)
        clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        self._publish_timer = node.create_timer(
            settings.coalesce_interval_s, self._publish, clock=clock, autostart=False
        )
        is_repeated = settings.repeat_rate_hz > 0.0
        self._repeat_timer = node.create_timer(
            1.0 / settings.repeat_rate_hz if is_repeated else 1.0, self._publish, clock=clock, autostart=False
        )
        self._retry_timer = node.create_timer(_RETRY_SECONDS, self._open, clock=clock)
        self._open()

    def _open(self) -> None:
        path = self._settings.device()
        if path is None:
            device_label = self._settings.requested_device()
            self._log_missing_joystick(
                localized(phrase("the joystick {device} is not connected; waiting for it", device=device_label))
            )
            return
        try:
            self._device = JoystickDevice(path, self._on_events, self._on_unplugged)
        except OSError as error:
            reason = foreign(error.strerror or error)
            self._log_missing_joystick(
                localized(
                    phrase(
                        "the joystick {path} cannot be read: {reason}; trying again (add your user to the "
                        "device's group, often 'input')",
                        path=str(path),
                        reason=reason,
                    )
                )
            )
            return
        self._logged_reason = None
        self._retry_timer.cancel()
        self._axes, self._buttons = [], []
        self._node.get_logger().info(
            f"Opened joystick: {self._device.name or path}.  deadzone: {self._settings.deadzone:f}"
        )
        if self._settings.repeat_rate_hz > 0.0:
            self._repeat_timer.reset()

    def _log_missing_joystick(self, reason: str) -> None:
        """Log the reason why there is no joystick, unless it was logged last."""
        if reason != self._logged_reason:
            self._logged_reason = reason
            self._node.get_logger().warning(reason)

    def _on_unplugged(self) -> None:
        self._device = None
        self._publish_timer.cancel()
        self._repeat_timer.cancel()
        self._axes, self._buttons = [0.0] * len(self._axes), [0] * len(self._buttons)
        self._send()
        self._node.get_logger().warning(localized(phrase("the joystick was disconnected; waiting for it")))
        self._logged_reason = None
        self._retry_timer.reset()

    def _on_events(self, events: list[JoystickEvent]) -> None:
        publish_now, publish_soon = False, False
        for event in events:
            if event.is_axis:
                publish_soon |= self._update_axis(event)
            elif self._update_button(event):
                # When it is opened, the device reports all axes and buttons; one message contains all these events.
                publish_now, publish_soon = publish_now or not event.is_initial, publish_soon or event.is_initial
        if publish_now or (publish_soon and self._settings.coalesce_interval_s == 0.0):
            self._publish()
        elif publish_soon and self._publish_timer.is_canceled():
            self._publish_timer.reset()

    def _update_axis(self, event: JoystickEvent) -> bool:
        axes = self._axes
        axes += [0.0] * (event.number + 1 - len(axes))
        old_value, axes[event.number] = axes[event.number], compute_deflection(event.value, self._settings.deadzone)
        return event.is_initial or old_value != axes[event.number]

    def _update_button(self, event: JoystickEvent) -> bool:
        buttons = self._buttons
        buttons += [0] * (event.number + 1 - len(buttons))
        old_value = buttons[event.number]
        if not self._settings.sticky:
            buttons[event.number] = int(event.value != 0)
        elif event.value:
            buttons[event.number] = 1 - old_value
        return event.is_initial or old_value != buttons[event.number]

    def _publish(self) -> None:
        self._publish_timer.cancel()
        if self._device is None:
            return
        if self._settings.repeat_rate_hz > 0.0:
            self._repeat_timer.reset()
        self._send()

    def _send(self) -> None:
        message = self._message_type()
        message.header.stamp = self._node.get_clock().now().to_msg()
        message.header.frame_id = "joy"
        message.axes, message.buttons = list(self._axes), list(self._buttons)
        self._publisher.publish(message)


class JoyLinuxNode(JoyNode):
    """The running joy_linux_node, a `JoyNode` with other parameters.

    The other parameters are ``dev``, ``dev_name`` and ``coalesce_interval``.
    """

    def _read_settings(self, node: Node) -> _Settings:
        path = Path(node.declare_parameter("dev", "/dev/input/js0").value)
        name: str = node.declare_parameter("dev_name", "").value
        node.declare_parameter("dev_ff", "/dev/input/event0")
        node.declare_parameter("default_trig_val", False)
        return _declare_settings(node, 0, name, path, _declare_number(node, "coalesce_interval", 0.001, 0.0, None))


def compute_deflection(value: int, deadzone: float) -> float:
    """Return the deflection of an axis from -1 to 1, positive forwards and to the left.

    Args:
        value: the device's value from -32767 to 32767, positive backwards and to the right.
        deadzone: the fraction around the center that counts as 0; beyond it, the deflection grows from 0.
    """
    raw_deflection = max(-1.0, min(1.0, -value / MAX_VALUE))
    excess = abs(raw_deflection) - deadzone
    if excess <= 0.0:
        return 0.0
    return excess / (1.0 - deadzone) * (1.0 if raw_deflection > 0.0 else -1.0)


def _declare_settings(node: Node, number: int, name: str, path: Path | None, coalesce: float) -> _Settings:
    deadzone = _declare_number(node, "deadzone", 0.05, 0.0, 1.0)
    repeat_rate = _declare_number(node, "autorepeat_rate", 20.0, 0.0, _MAX_RATE_HZ)
    sticky: bool = node.declare_parameter("sticky_buttons", False).value
    return _Settings(number, name, path, deadzone, repeat_rate, coalesce, sticky)


def _declare_number(node: Node, name: str, default: float, minimum: float, maximum: float | None) -> float:
    """Declare a numeric parameter, and return its value after checking the range.

    `maximum` is None for no maximum.

    Raises:
        LinkwrightError: NODE903, the parameter is out of its range.
    """
    value: Any = node.declare_parameter(name, default).value
    if isfinite(value) and value >= minimum and (maximum is None or value <= maximum):
        return float(value)
    message = (
        phrase(
            "parameter '{name}' must be at least {minimum}, but it is {value}", name=name, minimum=minimum, value=value
        )
        if maximum is None
        else phrase(
            "parameter '{name}' must be between {minimum} and {maximum}, but it is {value}",
            name=name,
            minimum=minimum,
            maximum=maximum,
            value=value,
        )
    )
    raise LinkwrightError(Diagnostic("NODE903", message))
