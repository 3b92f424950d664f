"""Record the messages that are published on a topic during a test."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from linkwright.graph import (
    DurabilityPolicy,
    Graph,
    HistoryPolicy,
    MessageInfo,
    Node,
    QoSProfile,
    ReliabilityPolicy,
    Subscription,
)


class Recording:
    """The recorded messages of a topic, in the order of arrival.

    The method ``record`` of a stepped graph creates a recording.

    Without a message type, the recording subscribes when a node first publishes or subscribes to the topic, because
    this node determines the type. A recording can therefore be created before the node under test. Messages that a
    transient local publisher stores are included.

    Attributes:
        topic: the absolute name of the topic.
        messages: the recorded messages, in the order of arrival.
        times: the time of each message, in seconds since the beginning of the test.
    """

    def __init__(self, graph: Graph, node: Node, topic: str, msg_type: Any = None) -> None:
        self.topic = node.resolve_topic_name(topic)
        self.messages: list[Any] = []
        self.times: list[float] = []
        self._graph = graph
        self._node = node
        self._subscription: Subscription[Any] | None = None
        if msg_type is None:
            graph.watch(self._subscribe_when_available)
            self._subscribe_when_available()
        else:
            self._subscribe(msg_type)

    @property
    def last(self) -> Any:
        """The last message that was received.

        Raises:
            AssertionError: no message was received.
        """
        if not self.messages:
            raise AssertionError(f"nothing was published on '{self.topic}'")
        return self.messages[-1]

    def clear(self) -> None:
        """Drop the messages that have been received so far."""
        self.messages.clear()
        self.times.clear()

    def __len__(self) -> int:
        return len(self.messages)

    def __iter__(self) -> Iterator[Any]:
        return iter(self.messages)

    def __getitem__(self, index: int) -> Any:
        return self.messages[index]

    def __repr__(self) -> str:
        return f"<{len(self.messages)} messages of {self.topic}>"

    def _subscribe_when_available(self) -> None:
        if self._subscription is None:
            bus = self._graph.bus
            for endpoint in (*bus.publishers(self.topic), *bus.subscriptions(self.topic)):
                self._subscribe(endpoint.type_name)
                return

    def _subscribe(self, msg_type: Any) -> None:
        self._graph.unwatch(self._subscribe_when_available)
        durabilities = [publisher.qos_profile.durability for publisher in self._graph.bus.publishers(self.topic)]
        are_stored = bool(durabilities) and all(
            durability_policy is DurabilityPolicy.TRANSIENT_LOCAL for durability_policy in durabilities
        )
        qos = QoSProfile(
            history=HistoryPolicy.KEEP_ALL,
            reliability=ReliabilityPolicy.BEST_EFFORT,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if are_stored else DurabilityPolicy.VOLATILE,
        )
        self._subscription = self._node.create_subscription(msg_type, self.topic, self._receive, qos)

    def _receive(self, message: Any, info: MessageInfo) -> None:
        self.messages.append(message)
        self.times.append(self._graph.timebase.steady_ns() / 1e9)
