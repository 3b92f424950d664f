"""teleop_twist_keyboard, which publishes velocities for keys pressed in a terminal.

Keys, parameters and the line with the speeds are those of the ROS node; ``repeat_rate`` and ``key_timeout`` are those
of its ROS 1 version. Three things differ on purpose: unless ``stamped`` is set, the node publishes the type that the
topic's subscriptions expect; the node publishes a stop however it ends; and a key that sends several characters, such
as an arrow key, stops the robot, while the ROS node interprets the last character as a key.
"""

from __future__ import annotations

import asyncio
import contextlib
from math import isfinite

from linkwright.control.nodes.teleop.keys import (
    INTERRUPT,
    MOVES,
    SPEEDS,
    STILL,
    Direction,
    help_text,
    keys_in,
    speeds_text,
)
from linkwright.control.nodes.teleop.terminal import KeyTerminal
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.diagnostics.translation import localized
from linkwright.graph import Clock, ClockType, Graph, ParameterType
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, starting
from linkwright.nodes.velocity_topic import VelocityTopic

_REVIEW_SECONDS = 0.5
_SPEEDS_BETWEEN_HELPS = 15


class TeleopTwistKeyboard(SingleNode):
    """The running teleop_twist_keyboard.

    Parameters: ``stamped`` (by default, the type that the subscriptions expect), ``frame_id``, ``speed`` (m/s),
    ``turn`` (rad/s), ``repeat_rate`` (messages per second while nothing is pressed; 0 for none), ``key_timeout`` (s
    without a key after which the robot stops; 0 for never).

    Raises:
        LinkwrightError: NODE901, there is no terminal; NODE902, a parameter is negative or not a number.
    """

    DEFAULT_NAME = "teleop_twist_keyboard"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._output = options.output
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self._direction: Direction = STILL
        self._helps = 0
        self._unheard = False
        with starting(self._node):
            self._start(options.terminal)

    def _start(self, terminal: int | None) -> None:
        node = self._node
        stamped: bool | None = node.declare_parameter("stamped", ParameterType.BOOL).value
        frame_id: str = node.declare_parameter("frame_id", "").value
        self._speed, self._turn = self._number("speed", 0.5), self._number("turn", 1.0)
        repeat_rate, self._key_timeout = self._number("repeat_rate", 0.0), self._number("key_timeout", 0.0)
        if terminal is None:
            raise _no_terminal()
        self._topic = VelocityTopic(node, "cmd_vel", stamped, frame_id)
        try:
            self._terminal = KeyTerminal(terminal, self._typed, self._ended)
        except OSError as error:
            raise _no_terminal() from error
        # Use the steady clock, because a stop must not wait for simulated time, which may be paused.
        clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        node.create_timer(_REVIEW_SECONDS, self._review, clock=clock)
        if repeat_rate > 0.0:
            node.create_timer(1.0 / repeat_rate, self._publish, clock=clock)
        self._silence = node.create_timer(self._key_timeout or 1.0, self._lost, clock=clock, autostart=False)
        self._print(localized(help_text()))
        self._print(speeds_text(self._speed, self._turn))

    def close(self) -> None:
        """Stop the robot, restore the terminal, and close the node."""
        self._terminal.close()
        self._topic.stop()
        self._topic.close()
        super().close()

    def _number(self, name: str, default: float) -> float:
        value: float = self._node.declare_parameter(name, default).value
        if not isfinite(value) or value < 0.0:
            message = phrase("parameter '{name}' must be 0 or more, but it is {value}", name=name, value=value)
            raise LinkwrightError(Diagnostic("NODE902", message))
        return value

    def _print(self, text: str) -> None:
        with contextlib.suppress(OSError):  # The reader reports a closed terminal.
            self._output(text)

    def _typed(self, text: str) -> None:
        for key in keys_in(text):
            if key == INTERRUPT:
                self._ended()
                return
            self._pressed(key)
        if self._key_timeout:
            self._silence.reset()
        self._follow()
        self._publish()

    def _pressed(self, key: str) -> None:
        if key in SPEEDS:
            faster, turning = SPEEDS[key]
            self._speed, self._turn = self._speed * faster, self._turn * turning
            self._print(speeds_text(self._speed, self._turn))
            self._helps = (self._helps + 1) % _SPEEDS_BETWEEN_HELPS
            if self._helps == 0:
                self._print(localized(help_text()))
        else:
            self._direction = MOVES.get(key, STILL)

    def _lost(self) -> None:
        """Stop the robot because no key was received within ``key_timeout``.

        The user may have released the key or lost the connection.
        """
        self._silence.cancel()
        if self._direction != STILL:
            self._direction = STILL
            self._publish()

    def _ended(self) -> None:
        self._terminal.close()
        self._topic.stop()
        if not self.finished.done():
            self.finished.set_result(0)

    def _follow(self) -> bool:
        """Adopt the message type that the subscriptions expect, and return whether there are any."""
        return self._topic.review(may_change=self._direction == STILL or self._unheard) > 0

    def _review(self) -> None:
        """Adopt the type of the subscriptions, and warn once if a moving robot has none."""
        if self._follow():
            self._unheard = False
        elif self._direction != STILL and not self._unheard:
            self._unheard = True
            message = phrase("no node subscribes to {topic}; `linkwright doctor` shows more", topic=self._topic.name)
            self._node.get_logger().warning(localized(message))

    def _publish(self) -> None:
        x, y, z, turn = self._direction
        speed = self._speed
        self._topic.publish((x * speed, y * speed, z * speed), (0.0, 0.0, turn * self._turn))


def _no_terminal() -> LinkwrightError:
    return LinkwrightError(
        Diagnostic(
            "NODE901",
            phrase("teleop_twist_keyboard needs a terminal, but it was started without one"),
            hint=phrase(
                "start it in its own terminal, not from a launch file: ros2 run teleop_twist_keyboard "
                "teleop_twist_keyboard; over ssh, use ssh -t"
            ),
        )
    )
