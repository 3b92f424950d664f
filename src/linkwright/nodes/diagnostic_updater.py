"""Periodic publication of a node's diagnostics on ``/diagnostics`` (diagnostic_updater)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import IntEnum

from linkwright.graph import Node
from linkwright.messages import get_message

_PERIOD_S = 1.0
_QUEUE_DEPTH = 1


class Level(IntEnum):
    """The levels of diagnostic_msgs/DiagnosticStatus."""

    OK = 0
    WARN = 1
    ERROR = 2


@dataclass(frozen=True, slots=True)
class Health:
    """A diagnostic status: a level, a message, and values by name."""

    level: Level
    message: str
    values: Mapping[str, str] = field(default_factory=dict)


class DiagnosticUpdater:
    """A publisher of a node's diagnostics, which publishes once per second of the node's clock.

    Args:
        node: the node, whose name is the prefix of the task's name.
        task: the name of the diagnostic task.
        get_health: returns the current diagnostic status.
        hardware_id: the ID of the hardware; ``none`` for no hardware, as in diagnostic_updater.
    """

    def __init__(self, node: Node, task: str, get_health: Callable[[], Health], hardware_id: str = "none") -> None:
        self._node = node
        self._task = task
        self._get_health = get_health
        self._hardware_id = hardware_id
        self._array = get_message("diagnostic_msgs/msg/DiagnosticArray")
        self._status = get_message("diagnostic_msgs/msg/DiagnosticStatus")
        self._key_value = get_message("diagnostic_msgs/msg/KeyValue")
        self._publisher = node.create_publisher(self._array, "/diagnostics", _QUEUE_DEPTH)
        node.create_timer(_PERIOD_S, self._publish)

    def _publish(self) -> None:
        health = self._get_health()
        status = self._status(
            name=f"{self._node.get_name()}: {self._task}", message=health.message, hardware_id=self._hardware_id
        )
        status.level = bytes([health.level])
        status.values = [self._key_value(key=key, value=value) for key, value in health.values.items()]
        message = self._array(status=[status])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)
