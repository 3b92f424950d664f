"""The base class of topic_tools' nodes, whose output topic has the input topic's type.

There are three differences from topic_tools 1.3. Changes to the graph are handled immediately instead of within 100 ms.
If a source returns with another type, the node subscribes to it again. If the publisher of the last velocity
disappears, a stop is sent.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, ClassVar

from linkwright.graph import DEFAULT_QOS, Graph, Publisher, QoSProfile, Subscription
from linkwright.graph.endpoints.base import EndpointInfo
from linkwright.graph.endpoints.command_disputes import DisputeMonitor
from linkwright.graph.endpoints.command_guard import CommandGuard
from linkwright.graph.qos.compatibility import fit_profile
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import get_arguments, log_unknown_parameters, options_from_arguments
from linkwright.nodes.standstill import VELOCITIES, send_stop


class TopicTool(SingleNode, ABC):
    """The base class of nodes that forward messages.

    While the input topic has a publisher, the node publishes the output topic with the same type and a compatible QoS.
    A subclass sets `_input` and `_output` in `_declare`.

    Attributes:
        USAGE: the usage text.
        WORDS: the functions that convert command-line arguments to parameter values, by parameter name.
    """

    USAGE: ClassVar[str]
    WORDS: ClassVar[Mapping[str, Callable[[str], Any]]] = {}

    _input: str
    _output: str
    _lazy = False

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        options = self._parse_options(options, get_arguments(options))
        self._graph = graph
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._publisher: Publisher[Any] | None = None
        self._subscription: Subscription[Any] | None = None
        self._has_mixed_qos = False
        with handle_start_errors(self._node):
            self._declare()
            log_unknown_parameters(self._node)
        self._changed = self._node.create_guard_condition(self._update_endpoints)
        graph.watch(self._changed.trigger)
        self._update_endpoints()

    def close(self) -> None:
        """Close the node."""
        self._graph.unwatch(self._changed.trigger)
        super().close()

    def _parse_options(self, options: NodeOptions, arguments: list[str]) -> NodeOptions:
        """Return the options with parameters that are set by command-line arguments."""
        return options_from_arguments(options, arguments, self.WORDS, self.USAGE)

    @abstractmethod
    def _declare(self) -> None:
        """Declare the parameters and store their values."""

    @abstractmethod
    def _receive(self, message: Any) -> None:
        """Handle an input message."""

    def _send(self, message: Any) -> None:
        if self._publisher is not None:
            self._publisher.publish(message)

    def _update_endpoints(self) -> None:
        """Create or destroy the publisher and the subscription to match the current graph."""
        sources = self._find_sources()
        if not sources:
            self._stop()
            return
        message_type = sources[0].topic_type
        qos = self._choose_profile([source.qos_profile for source in sources])
        if not self._matches(self._publisher, self._output, message_type, qos):
            self._stop()
            self._publisher = self._node.create_publisher(message_type, self._output, qos)
        if not self._matches(self._subscription, self._input, message_type, qos):
            self._unsubscribe()
        if self._lazy and not (self._publisher and self._publisher.get_subscription_count()):
            self._unsubscribe()
        elif self._subscription is None:
            self._subscription = self._create_subscription(message_type, qos)

    def _create_subscription(self, message_type: str, qos: QoSProfile) -> Subscription[Any]:
        if message_type not in VELOCITIES:
            return self._node.create_subscription(message_type, self._input, self._receive, qos)
        command_guard = CommandGuard(self._stop_output, DisputeMonitor.of(self._node))
        callback = command_guard.tracking_callback(self._receive)
        subscription: Subscription[Any] = self._node.create_subscription(message_type, self._input, callback, qos)
        command_guard.watch(subscription)
        return subscription

    def _stop_output(self, lost_publisher: EndpointInfo) -> None:
        """Publish a stop if the output is a velocity topic.

        This is called after the input's publisher has disappeared.
        """
        if self._publisher is not None and self._publisher.type_name in VELOCITIES:
            send_stop(self._node, self._publisher, lost_publisher)

    def _find_sources(self) -> list[Any]:
        return self._node.get_publishers_info_by_topic(self._input)

    def _choose_profile(self, offers: list[QoSProfile]) -> QoSProfile:
        qos_match = fit_profile(DEFAULT_QOS, offers)
        if qos_match.mixed and not self._has_mixed_qos:
            for offered_value, fallback_value in qos_match.mixed:
                self._node.get_logger().warning(
                    f"Some, but not all, publishers on topic {self._input} offer {offered_value}. Falling "
                    f"back to {fallback_value} in "
                    "order to connect to all publishers."
                )
        self._has_mixed_qos = bool(qos_match.mixed)
        return qos_match.profile

    def _matches(
        self, endpoint: Publisher[Any] | Subscription[Any] | None, topic: str, message_type: str, qos: QoSProfile
    ) -> bool:
        return (
            endpoint is not None
            and endpoint.type_name == message_type
            and endpoint.name == self._node.resolve_topic_name(topic)
            and endpoint.qos_profile == qos
        )

    def _stop(self) -> None:
        self._unsubscribe()
        if self._publisher is not None:
            self._node.destroy_publisher(self._publisher)
            self._publisher = None

    def _unsubscribe(self) -> None:
        if self._subscription is not None:
            self._node.destroy_subscription(self._subscription)
            self._subscription = None
