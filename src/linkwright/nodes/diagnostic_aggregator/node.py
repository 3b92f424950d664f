"""aggregator_node, which sorts the diagnostics of all nodes into groups.

Topics and parameters are those of diagnostic_aggregator. As its documentation says, but not its node does, ``expected``
and ``name`` select statuses, and a list of one text may be written as a text. Time is that of the computer, also in
simulations.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation import localized
from linkwright.graph import Graph, Parameter, Publisher
from linkwright.graph.qos.profile import QoSProfile
from linkwright.graph.time.clock import Clock
from linkwright.graph.time.values import ClockType
from linkwright.messages import get_message
from linkwright.nodes.diagnostic_aggregator.analyzers import OtherAnalyzer
from linkwright.nodes.diagnostic_aggregator.creation import AnalyzerFactory
from linkwright.nodes.diagnostic_aggregator.items import Level, Status
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors

_ARRAY, _STATUS = "diagnostic_msgs/msg/DiagnosticArray", "diagnostic_msgs/msg/DiagnosticStatus"
_DEFAULT_RATE = 1.0


class DiagnosticAggregator(SingleNode):
    """The running aggregator_node.

    Parameters: ``path``, ``pub_rate`` (Hz), ``history_depth``, ``other_as_errors``, ``critical``, and the parameters of
    the analyzers, to which others can be added while it runs.
    """

    DEFAULT_NAME = "analyzers"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME, any_parameters=True)
        with handle_start_errors(self._node):
            self._start()

    def _start(self) -> None:
        node = self._node
        path = str(self._read("path", ""))
        base_path = f"/{path}" if path else ""
        rate = float(self._read("pub_rate", _DEFAULT_RATE))
        depth = int(self._read("history_depth", 1000))
        self._is_critical = bool(self._read("critical", False))
        self._other = OtherAnalyzer(base_path, are_errors=bool(self._read("other_as_errors", False)))
        self._base_path = base_path
        self._create_analyzers()
        node.add_post_set_parameters_callback(self._on_parameters)
        self._unstamped: set[str] = set()
        self._level = Level.STALE
        self._clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        self._groups: Publisher[Any] = node.create_publisher(_ARRAY, "/diagnostics_agg", 1)
        self._levels: Publisher[Any] = node.create_publisher(_STATUS, "/diagnostics_toplevel_state", 1)
        node.create_subscription(_ARRAY, "/diagnostics", self._on_diagnostics, QoSProfile(depth=max(depth, 1)))
        node.create_timer(1.0 / (rate if rate > 0 else _DEFAULT_RATE), self._publish, clock=self._clock)

    def _create_analyzers(self) -> None:
        parameters = {name: parameter.value for name, parameter in self._node.get_parameters_by_prefix("").items()}
        self._parameter_names = frozenset(parameters)
        log_error = self._node.get_logger().error
        factory = AnalyzerFactory(lambda problem: log_error(localized(problem)))
        self._group = factory.create_group(parameters, self._base_path)
        if not self._group.analyzers:
            log_error(localized(phrase("no analyzer is set, so all diagnostics are in the group 'Other'")))

    def _on_parameters(self, parameters: Sequence[Parameter]) -> None:
        """Create all analyzers again if there are new parameters, as add_analyzer sets them."""
        if not self._parameter_names.issuperset(parameter.name for parameter in parameters):
            self._create_analyzers()

    def _read(self, name: str, default: Any) -> Any:
        if not self._node.has_parameter(name):
            self._node.declare_parameter(name, default)
        return self._node.get_parameter(name).value

    def _on_diagnostics(self, message: Any) -> None:
        self._check_stamp(message)
        now_ns = self._clock.now().nanoseconds
        for status in message.status:
            item = Status.from_message(status, now_ns)
            if self._is_critical and item.level is Level.ERROR and self._level is not Level.ERROR:
                self._publish_level("toplevel_state_critical", Level.ERROR)
            if not self._group.analyze(item):
                self._other.analyze(item)

    def _check_stamp(self, message: Any) -> None:
        names = ", ".join(status.name for status in message.status)
        if message.header.stamp.sec or names in self._unstamped:
            return
        self._unstamped.add(names)
        self._node.get_logger().warning(
            localized(phrase("diagnostics without a timestamp were received: {names}", names=names))
        )

    def _publish(self) -> None:
        now_ns = self._clock.now().nanoseconds
        reported = [*self._group.report(now_ns), *self._other.report(now_ns)]
        array = get_message(_ARRAY)(status=[status.to_message() for status in reported])
        array.header.stamp = self._node.get_clock().now().to_msg()
        self._groups.publish(array)
        levels = [status.level for status in reported]
        has_only_stale = bool(levels) and all(level is Level.STALE for level in levels)
        self._publish_level(
            "toplevel_state", Level.STALE if has_only_stale else min(max(levels, default=Level.ERROR), Level.ERROR)
        )

    def _publish_level(self, name: str, level: Level) -> None:
        self._level = level
        self._levels.publish(Status(name, level, "").to_message())
