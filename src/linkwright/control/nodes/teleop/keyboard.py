"""teleop_twist_keyboard, which publishes velocities for keys pressed in a terminal.

Keys, parameters and the line with the speeds are those of the ROS node; ``repeat_rate`` and ``key_timeout`` come from
its ROS 1 version. Deliberate differences: unless ``stamped`` is set, the node publishes the type that the subscriptions
of the topic expect; the node always publishes a stop when it ends; and a key that sends several characters, such as an
arrow key, stops the robot, while the ROS node interprets the last character as a key.
"""

from __future__ import annotations

import asyncio
import contextlib
from math import isfinite

from linkwright.control.nodes.teleop.keys import (
    DIRECTIONS,
    INTERRUPT,
    SPEED_FACTORS,
    STILL,
    Direction,
    format_speeds,
    help_text,
    split_keys,
)
from linkwright.control.nodes.teleop.terminal import KeyTerminal, make_terminal_error
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.diagnostics.translation import localized
from linkwright.graph import Clock, ClockType, Graph, ParameterType
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.velocity_topic import VelocityTopic

_TYPE_CHECK_PERIOD_S = 0.5
_LINES_BETWEEN_HELP = 15


class TeleopTwistKeyboard(SingleNode):
    """The running teleop_twist_keyboard.

    Parameters: ``stamped`` (by default, the type that the subscriptions expect), ``frame_id``, ``speed`` (m/s),
    ``turn`` (rad/s), ``repeat_rate`` (Hz, while no key is pressed; 0 for none), ``key_timeout`` (the seconds without a
    key after which the robot stops; 0 for never).

    Raises:
        LinkwrightError: NODE901, there is no terminal; NODE902, a parameter is negative or not a number.
    """

    DEFAULT_NAME = "teleop_twist_keyboard"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._output = options.output
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self._direction: Direction = STILL
        self._speed_line_count = 0
        self._has_warned = False
        with handle_start_errors(self._node):
            self._start(options.terminal)

    def _start(self, terminal: int | None) -> None:
        node = self._node
        is_stamped: bool | None = node.declare_parameter("stamped", ParameterType.BOOL).value
        frame_id: str = node.declare_parameter("frame_id", "").value
        self._speed, self._turn_speed = self._declare_number("speed", 0.5), self._declare_number("turn", 1.0)
        repeat_rate, self._key_timeout = (
            self._declare_number("repeat_rate", 0.0),
            self._declare_number("key_timeout", 0.0),
        )
        terminal_error = make_terminal_error("teleop_twist_keyboard", "teleop_twist_keyboard")
        if terminal is None:
            raise terminal_error
        self._topic = VelocityTopic(node, "cmd_vel", is_stamped, frame_id)
        try:
            self._terminal = KeyTerminal(terminal, self._on_text, self._on_end)
        except OSError as error:
            raise terminal_error from error
        # The timers use the steady clock, because a stop must not wait for simulated time, which may be paused.
        clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        node.create_timer(_TYPE_CHECK_PERIOD_S, self._check_subscriptions, clock=clock)
        if repeat_rate > 0.0:
            node.create_timer(1.0 / repeat_rate, self._publish, clock=clock)
        self._timeout_timer = node.create_timer(
            self._key_timeout or 1.0, self._on_key_timeout, clock=clock, autostart=False
        )
        self._print(localized(help_text()))
        self._print(format_speeds(self._speed, self._turn_speed))

    def close(self) -> None:
        """Stop the robot, restore the terminal, and close the node."""
        self._terminal.close()
        self._topic.stop()
        self._topic.close()
        super().close()

    def _declare_number(self, name: str, default: float) -> float:
        value: float = self._node.declare_parameter(name, default).value
        if not isfinite(value) or value < 0.0:
            message = phrase("parameter '{name}' must be 0 or more, but it is {value}", name=name, value=value)
            raise LinkwrightError(Diagnostic("NODE902", message))
        return value

    def _print(self, text: str) -> None:
        with contextlib.suppress(OSError):  # `KeyTerminal` reports a closed terminal.
            self._output(text)

    def _on_text(self, text: str) -> None:
        for key in split_keys(text):
            if key == INTERRUPT:
                self._on_end()
                return
            self._apply_key(key)
        if self._key_timeout:
            self._timeout_timer.reset()
        self._update_message_type()
        self._publish()

    def _apply_key(self, key: str) -> None:
        if key in SPEED_FACTORS:
            speed_factor, turn_factor = SPEED_FACTORS[key]
            self._speed, self._turn_speed = self._speed * speed_factor, self._turn_speed * turn_factor
            self._print(format_speeds(self._speed, self._turn_speed))
            self._speed_line_count = (self._speed_line_count + 1) % _LINES_BETWEEN_HELP
            if self._speed_line_count == 0:
                self._print(localized(help_text()))
        else:
            self._direction = DIRECTIONS.get(key, STILL)

    def _on_key_timeout(self) -> None:
        """Stop the robot because no key was received within ``key_timeout``.

        The user may have released the key or lost the connection.
        """
        self._timeout_timer.cancel()
        if self._direction != STILL:
            self._direction = STILL
            self._publish()

    def _on_end(self) -> None:
        self._terminal.close()
        self._topic.stop()
        if not self.finished.done():
            self.finished.set_result(0)

    def _update_message_type(self) -> bool:
        """Adopt the message type of the subscriptions, and return whether there are any."""
        return self._topic.update_type(may_change=self._direction == STILL or self._has_warned) > 0

    def _check_subscriptions(self) -> None:
        """Adopt the message type of the subscriptions.

        If there are none while the robot should move, warn once.
        """
        if self._update_message_type():
            self._has_warned = False
        elif self._direction != STILL and not self._has_warned:
            self._has_warned = True
            message = phrase(
                "no node subscribes to {topic}; run `linkwright doctor` for details", topic=self._topic.name
            )
            self._node.get_logger().warning(localized(message))

    def _publish(self) -> None:
        x, y, z, turn_fraction = self._direction
        speed = self._speed
        self._topic.publish((x * speed, y * speed, z * speed), (0.0, 0.0, turn_fraction * self._turn_speed))
