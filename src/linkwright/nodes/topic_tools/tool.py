"""The base class of topic_tools' nodes, with an input whose type is taken from the graph, and an output.

Differences from topic_tools 1.3: changes of the graph are handled immediately instead of within 100 ms; the node
subscribes again to a source that returns with another type; and a stop is sent when the publisher of the last velocity
disappears.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, ClassVar

from linkwright.graph import DEFAULT_QOS, Graph, Publisher, QoSProfile, Subscription
from linkwright.graph.endpoints.base import EndpointInfo
from linkwright.graph.endpoints.commander import Commander
from linkwright.graph.endpoints.drivers import DriverWatch
from linkwright.graph.qos.compatibility import fit
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, starting
from linkwright.nodes.settings import log_unknown, options_from_words, words_of
from linkwright.nodes.standstill import VELOCITIES, send_stop


class TopicTool(SingleNode, ABC):
    """The base class of nodes that forward messages.

    The output has a publisher while the input has one, with the same type, reliability and durability. A subclass sets
    `_input` and `_output` in `_declare`.

    Attributes:
        USAGE: the usage text.
        WORDS: the parameters that command-line arguments set, with their converters.
    """

    USAGE: ClassVar[str]
    WORDS: ClassVar[Mapping[str, Callable[[str], Any]]] = {}

    _input: str
    _output: str
    _lazy = False

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        options = self._options(options, words_of(options))
        self._graph = graph
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._publisher: Publisher[Any] | None = None
        self._subscription: Subscription[Any] | None = None
        self._mixed = False
        with starting(self._node):
            self._declare()
            log_unknown(self._node)
        self._changed = self._node.create_guard_condition(self._look)
        graph.watch(self._changed.trigger)
        self._look()

    def close(self) -> None:
        """Close the node."""
        self._graph.unwatch(self._changed.trigger)
        super().close()

    def _options(self, options: NodeOptions, words: list[str]) -> NodeOptions:
        """Return the options with parameters that are set by command-line arguments."""
        return options_from_words(options, words, self.WORDS, self.USAGE)

    @abstractmethod
    def _declare(self) -> None:
        """Declare the parameters and store their values."""

    @abstractmethod
    def _receive(self, message: Any) -> None:
        """Handle an input message."""

    def _send(self, message: Any) -> None:
        if self._publisher is not None:
            self._publisher.publish(message)

    def _look(self) -> None:
        """Create or destroy the publisher and the subscription to match the current graph."""
        sources = self._sources()
        if not sources:
            self._stop()
            return
        kind = sources[0].topic_type
        qos = self._fitting([source.qos_profile for source in sources])
        if not self._is_like(self._publisher, self._output, kind, qos):
            self._stop()
            self._publisher = self._node.create_publisher(kind, self._output, qos)
        if not self._is_like(self._subscription, self._input, kind, qos):
            self._unsubscribe()
        if self._lazy and not (self._publisher and self._publisher.get_subscription_count()):
            self._unsubscribe()
        elif self._subscription is None:
            self._subscription = self._subscribed(kind, qos)

    def _subscribed(self, kind: str, qos: QoSProfile) -> Subscription[Any]:
        if kind not in VELOCITIES:
            return self._node.create_subscription(kind, self._input, self._receive, qos)
        commander = Commander(self._stop_output, DriverWatch.of(self._node))
        callback = commander.tracking_callback(self._receive)
        subscription: Subscription[Any] = self._node.create_subscription(kind, self._input, callback, qos)
        commander.watch(subscription)
        return subscription

    def _stop_output(self, lost: EndpointInfo) -> None:
        """Publish a stop if the output is a velocity, after the input's publisher has disappeared."""
        if self._publisher is not None and self._publisher.type_name in VELOCITIES:
            send_stop(self._node, self._publisher, lost)

    def _sources(self) -> list[Any]:
        return self._node.get_publishers_info_by_topic(self._input)

    def _fitting(self, offers: list[QoSProfile]) -> QoSProfile:
        fitting = fit(DEFAULT_QOS, offers)
        if fitting.mixed and not self._mixed:
            for offered, taken in fitting.mixed:
                self._node.get_logger().warning(
                    f"Some, but not all, publishers on topic {self._input} offer {offered}. Falling back to {taken} in "
                    "order to connect to all publishers."
                )
        self._mixed = bool(fitting.mixed)
        return fitting.profile

    def _is_like(
        self, endpoint: Publisher[Any] | Subscription[Any] | None, topic: str, kind: str, qos: QoSProfile
    ) -> bool:
        return (
            endpoint is not None
            and endpoint.type_name == kind
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
