"""turtle_teleop_key, which drives the first turtle of turtlesim by the keys pressed in a terminal.

Keys, parameters and the action are those of the ROS node. Deliberate differences: letters also work in upper case, as
the help writes them, and a key that no node can receive is reported.
"""

from __future__ import annotations

import asyncio
import contextlib
from typing import Any

from linkwright.control.nodes.teleop.keys import INTERRUPT, split_keys
from linkwright.control.nodes.teleop.terminal import KeyTerminal, make_terminal_error
from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation import localized
from linkwright.graph import ActionClient, ClientGoalHandle, Graph
from linkwright.messages import get_action, get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.turtlesim.interfaces import TOPIC_QOS, find_interface_package

_DIRECTIONS = {"A": (1.0, 0.0), "B": (-1.0, 0.0), "C": (0.0, -1.0), "D": (0.0, 1.0)}
"""Forwards and counterclockwise, by the last character of an arrow key."""

_ANGLES = {
    "g": 0.0,
    "t": 0.7854,
    "r": 1.5708,
    "e": 2.3562,
    "d": 3.1416,
    "c": -2.3562,
    "v": -1.5708,
    "b": -0.7854,
}
"""The headings of the keys around F, in rad."""

_CANCEL_KEY, _QUIT_KEY = "f", "q"

_HELP = phrase("""Reading from keyboard
---------------------------
Use arrow keys to move the turtle.
Use G|B|V|C|D|E|R|T keys to rotate to absolute orientations. 'F' to cancel a rotation.
'Q' to quit.""")


class TurtleTeleopKey(SingleNode):
    """The running turtle_teleop_key.

    Parameters: ``scale_linear`` (units/s) and ``scale_angular`` (rad/s).

    Raises:
        LinkwrightError: NODE901, there is no terminal.
    """

    DEFAULT_NAME = "teleop_turtle"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self._goal: ClientGoalHandle | None = None
        with handle_start_errors(self._node):
            self._start(options)

    def _start(self, options: NodeOptions) -> None:
        node = self._node
        for name in ("scale_angular", "scale_linear"):
            node.declare_parameter(name, 2.0)
        self._twist = get_message("geometry_msgs/msg/Twist")
        self._publisher = node.create_publisher(self._twist, "turtle1/cmd_vel", TOPIC_QOS)
        self._rotate = get_action(f"{find_interface_package(options.environment)}/action/RotateAbsolute")
        self._client = ActionClient(node, self._rotate, "turtle1/rotate_absolute")
        error = make_terminal_error("turtlesim", "turtle_teleop_key")
        if options.terminal is None:
            raise error
        try:
            self._terminal = KeyTerminal(options.terminal, self._on_text, self._end)
        except OSError as os_error:
            raise error from os_error
        with contextlib.suppress(OSError):  # `KeyTerminal` reports a closed terminal.
            options.output(localized(_HELP))

    def close(self) -> None:
        """Restore the terminal, and close the node."""
        self._terminal.close()
        super().close()

    def _on_text(self, text: str) -> None:
        for key in split_keys(text):
            letter = key.lower()
            if key == INTERRUPT or letter == _QUIT_KEY:
                self._end()
                return
            if len(key) > 1:
                self._drive(*_DIRECTIONS.get(key[-1], (0.0, 0.0)))
            elif letter == _CANCEL_KEY:
                self._cancel()
            elif letter in _ANGLES:
                self._send_goal(_ANGLES[letter])

    def _drive(self, forward: float, turn: float) -> None:
        if not forward and not turn:
            return
        if self._publisher.get_subscription_count() == 0:
            topic = self._publisher.topic_name
            message = phrase("no node subscribes to {topic}; run `linkwright doctor` for details", topic=topic)
            self._node.get_logger().warning(localized(message))
            return
        twist = self._twist()
        twist.linear.x = forward * self._node.get_parameter("scale_linear").value
        twist.angular.z = turn * self._node.get_parameter("scale_angular").value
        self._publisher.publish(twist)

    def _send_goal(self, theta: float) -> None:
        if not self._client.server_is_ready():
            self._node.get_logger().warning(
                localized(phrase("no node offers the action {name}", name="turtle1/rotate_absolute"))
            )
            return
        self._client.send_goal_async(self._rotate.Goal(theta=theta)).add_done_callback(self._on_response)

    def _on_response(self, response: Any) -> None:
        self._goal = response.result()

    def _cancel(self) -> None:
        if self._goal is not None:
            self._goal.cancel_goal_async()

    def _end(self) -> None:
        self._terminal.close()
        if not self.finished.done():
            self.finished.set_result(0)
