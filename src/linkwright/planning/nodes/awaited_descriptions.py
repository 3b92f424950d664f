"""The descriptions of a robot for move_group: from its parameters, or from topics of the same names, as in MoveIt."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import DESCRIPTION_QOS, Clock, ClockType, Node, Subscription

NAMES = ("robot_description", "robot_description_semantic")
_DEFAULT_TIMEOUT_S = 10.0


class AwaitedDescriptions:
    """The URDF and the SRDF of a robot, until both are known.

    A description without a parameter is read from the topic with the name of the parameter. If no message arrives
    within the parameter ``NAME_timeout``, an error is logged.

    Args:
        node: the node whose parameters and topics are read.
        parameters: the parameters of the node by name.
        on_complete: called once with the URDF and the SRDF, immediately if both are parameters. If it raises a
            LinkwrightError in response to a message, the error is logged, and the next message is awaited.

    Raises:
        LinkwrightError: raised by `on_complete` for the values of parameters.
    """

    def __init__(self, node: Node, parameters: Mapping[str, Any], on_complete: Callable[[str, str], None]) -> None:
        self._node = node
        self._on_complete = on_complete
        self._texts = {name: _read_text(parameters.get(name)) for name in NAMES}
        missing_names = [name for name in NAMES if not self._texts[name]]
        self._subscriptions: list[Subscription[Any]] = [
            node.create_subscription("std_msgs/msg/String", name, partial(self._receive, name), DESCRIPTION_QOS)
            for name in missing_names
        ]
        if not missing_names:
            on_complete(*self._texts.values())
            return
        clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        self._timers = [
            node.create_timer(timeout_s, partial(self._report_timeout, name, timeout_s), clock=clock)
            for name in missing_names
            for timeout_s in (float(parameters.get(f"{name}_timeout") or _DEFAULT_TIMEOUT_S),)
        ]

    def _receive(self, name: str, message: Any) -> None:
        self._texts[name] = _read_text(message.data)
        if not all(self._texts.values()):
            return
        try:
            self._on_complete(*self._texts.values())
        except LinkwrightError as error:
            self._node.get_logger().error(error.diagnostics[0].message)
            return
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        for timer in self._timers:
            timer.cancel()

    def _report_timeout(self, name: str, timeout_s: float) -> None:
        self._timers[0 if name == NAMES[0] else -1].cancel()
        if not self._texts[name]:
            self._node.get_logger().error(
                f"Could not find parameter {name} and did not receive {name} via std_msgs::msg::String subscription"
                f" within {timeout_s:.6f} seconds."
            )


def _read_text(value: Any) -> str:
    return value if isinstance(value, str) and value.strip() else ""
