"""twist_mux, which forwards the velocity topic with the highest priority.

The output topic is ``cmd_vel_out``.

Parameters, rules and diagnostics are those of the ROS node. A topic is active until its ``timeout`` has passed since
its last message. A lock that is on, or that received no message within its ``timeout``, blocks all topics of lower
priority. Deliberate differences: a topic without a timeout blocks others only after its first message, and a stop is
published when the publisher of the last velocity disappears.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from math import isfinite
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase
from linkwright.diagnostics.translation import localized
from linkwright.graph import Graph, MessageInfo, Node, Publisher, Subscription
from linkwright.graph.endpoints.command_disputes import DisputeMonitor
from linkwright.graph.endpoints.command_guard import CommandGuard
from linkwright.nodes.diagnostic_updater import DiagnosticUpdater, Health, Level
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.standstill import send_stop
from linkwright.nodes.velocity_topic import TWIST, TWIST_STAMPED
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_QUEUE_DEPTH = 10
_MAX_PRIORITY = 255


class _Source:
    """An input of the multiplexer: a velocity topic or a lock."""

    def __init__(self, name: str, topic: str, timeout: float, priority: int) -> None:
        self.name, self.topic, self.timeout = name, topic, timeout
        self.priority = max(0, min(_MAX_PRIORITY, priority))
        self.is_locked = False
        self._latest_message_ns: int | None = None

    def record_message(self, now_ns: int) -> None:
        """Record the arrival of a message."""
        self._latest_message_ns = now_ns

    def is_expired(self, now_ns: int) -> bool:
        """Return whether no message arrived within the timeout.

        An input without a timeout never expires.
        """
        if self.timeout == 0.0:
            return False
        return (
            self._latest_message_ns is None
            or (now_ns - self._latest_message_ns) / NANOSECONDS_PER_SECOND > self.timeout
        )

    @property
    def has_no_messages(self) -> bool:
        """Whether no message has arrived yet."""
        return self._latest_message_ns is None

    def format_status(self, state: str) -> str:
        """Return the text about the input in the diagnostics."""
        return f" {state} (listening to {self.topic} @ {self.timeout:f}s with priority #{self.priority})"


class TwistMux(SingleNode):
    """The running twist_mux.

    Parameters: ``topics.NAME`` and ``locks.NAME`` with ``topic``, ``timeout`` (s, 0 for never) and ``priority`` (0 to
    255), and ``use_stamped`` to receive and publish TwistStamped.

    Raises:
        LinkwrightError: NODE904, the parameters of a topic or a lock are incomplete or invalid.
    """

    DEFAULT_NAME = "twist_mux"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            self._start()

    def _start(self) -> None:
        node = self._node
        node.declare_parameters_from_overrides()
        if not node.has_parameter("use_stamped"):
            node.declare_parameter("use_stamped", False)
        message_type = TWIST_STAMPED if node.get_parameter("use_stamped").value else TWIST
        self._topics, self._locks = _read_sources(node, "topics"), _read_sources(node, "locks")
        if not self._topics:
            node.get_logger().warning(
                localized(phrase("no parameter topics.NAME.topic is set, so nothing is forwarded"))
            )
        self._publisher: Publisher[Any] = node.create_publisher(message_type, "cmd_vel_out", _QUEUE_DEPTH)
        self._command_guard = CommandGuard(partial(send_stop, node, self._publisher))
        for source in self._topics:
            velocities: Subscription[Any] = node.create_subscription(
                message_type, source.topic, partial(self._on_velocity, source, DisputeMonitor.of(node)), _QUEUE_DEPTH
            )
            self._command_guard.watch(velocities)
        for source in self._locks:
            node.create_subscription("std_msgs/msg/Bool", source.topic, partial(self._on_lock, source), _QUEUE_DEPTH)
        for source in (*self._topics, *self._locks):
            timeout = f"{source.timeout:f}s" if source.timeout > 0.0 else "None"
            node.get_logger().info(
                f"Topic handler '{source.name}' subscribed to topic '{source.topic}': "
                f"timeout = {timeout} , priority = {source.priority}."
            )
        DiagnosticUpdater(node, "Twist mux status", self._report_health)

    def _get_now_ns(self) -> int:
        return self._node.get_clock().now().nanoseconds

    def _on_velocity(self, source: _Source, dispute_monitor: DisputeMonitor, message: Any, info: MessageInfo) -> None:
        dispute_monitor.record_command(message, info)
        now_ns = self._get_now_ns()
        source.record_message(now_ns)
        lock_priority = self._find_lock_priority(now_ns)
        unmasked = [
            topic for topic in self._topics if topic.priority and not self._is_masked(topic, lock_priority, now_ns)
        ]
        if unmasked and max(unmasked, key=lambda source_topic: source_topic.priority) is source:
            self._command_guard.note_publisher(info)
            self._publisher.publish(message)

    def _on_lock(self, source: _Source, message: Any) -> None:
        source.record_message(self._get_now_ns())
        source.is_locked = message.data

    def _find_lock_priority(self, now_ns: int) -> int:
        return max((lock.priority for lock in self._locks if lock.is_locked or lock.is_expired(now_ns)), default=0)

    def _is_masked(self, source: _Source, lock_priority: int, now_ns: int) -> bool:
        return source.has_no_messages or source.is_expired(now_ns) or source.priority < lock_priority

    def _report_health(self) -> Health:
        now_ns = self._get_now_ns()
        lock = self._find_lock_priority(now_ns)
        values = {
            f"velocity {topic.name}": topic.format_status(
                "masked" if self._is_masked(topic, lock, now_ns) else "unmasked"
            )
            for topic in self._topics
        }
        values |= {
            f"lock {lock.name}": lock.format_status("locked" if lock.is_locked or lock.is_expired(now_ns) else "free")
            for lock in self._locks
        }
        values["current priority"] = str(lock)
        return Health(Level.OK, "ok", values)


def _read_sources(node: Node, group: str) -> list[_Source]:
    """Return the inputs described by the parameters ``GROUP.NAME.*``, sorted by name.

    Raises:
        LinkwrightError: NODE904, the parameters are incomplete or invalid.
    """
    values: dict[str, dict[str, Any]] = {}
    for key, parameter in node.get_parameters_by_prefix(group).items():
        name, _, entry = key.rpartition(".")
        values.setdefault(name, {})[entry] = parameter.value
    return [_parse_source(f"{group}.{name}", name, entries) for name, entries in sorted(values.items()) if name]


def _parse_source(path: str, name: str, entries: Mapping[str, Any]) -> _Source:
    topic, timeout, priority = (entries.get(key) for key in ("topic", "timeout", "priority"))
    if not isinstance(topic, str) or not topic:
        raise _parameter_error(path, phrase("parameter '{name}' must be the name of a topic", name=f"{path}.topic"))
    if isinstance(timeout, bool) or not isinstance(timeout, (int, float)) or not isfinite(timeout) or timeout < 0.0:
        raise _parameter_error(
            path,
            phrase(
                "parameter '{name}' must be a time in seconds, such as 0.5, or 0 for no timeout", name=f"{path}.timeout"
            ),
        )
    if isinstance(priority, bool) or not isinstance(priority, int):
        raise _parameter_error(path, phrase("parameter '{name}' must be an integer, 0 to 255", name=f"{path}.priority"))
    return _Source(name, topic, float(timeout), priority)


def _parameter_error(path: str, message: Phrase) -> LinkwrightError:
    hint = phrase("'{path}' must have three entries: topic, timeout and priority", path=path)
    return LinkwrightError(Diagnostic("NODE904", message, hint=hint))
