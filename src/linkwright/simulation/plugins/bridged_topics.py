"""gz topics with hidden names, because a bridge offers the same name with another type.

In Linkwright, gz topics are topics of the graph under their own names. A bridge from
``geometry_msgs/msg/TwistStamped`` to ``gz.msgs.Twist`` with one name for both sides, as in the robots of Jazzy, would
give the topic of this name two types. Therefore the gz topic is renamed to a hidden name when such a bridge starts, in
any process.
"""

from __future__ import annotations

from collections.abc import Callable

from linkwright.graph import EndpointKind, Node
from linkwright.graph.stepped.exchange import Exchange

_HIDDEN_PREFIX = "/_gz"


def hidden_gz_topic(topic: str) -> str:
    """Return the hidden name of a gz topic, for use beside a bridge with another type.

    Both names are absolute.
    """
    return _HIDDEN_PREFIX + topic


class BridgedTopics:
    """Calls functions of plugins when a bridge starts to use the name of a topic.

    Args:
        node: the simulator's node.
        exchange: runs the functions in the simulation thread.
    """

    def __init__(self, node: Node, exchange: Exchange) -> None:
        self._graph = node.graph
        self._exchange = exchange
        self._callbacks: dict[str, list[Callable[[], None]]] = {}
        self._is_check_queued = False
        self._graph.watch(self._on_graph_change)

    def close(self) -> None:
        """Stop watching the graph and notifying the plugins."""
        self._graph.unwatch(self._on_graph_change)

    def is_bridged(self, topic: str) -> bool:
        """Return whether a bridge offers a topic under another type."""
        return topic in self._bridged_topics([topic])

    def add_callback(self, topic: str, callback: Callable[[], None]) -> None:
        """Register a function that is called when a bridge offers a topic with another type.

        The function is called once.
        """
        self._callbacks.setdefault(topic, []).append(callback)

    def remove_callback(self, topic: str, callback: Callable[[], None]) -> None:
        """Unregister a function that was registered with `add_callback`."""
        callbacks = self._callbacks.get(topic, [])
        if callback in callbacks:
            callbacks.remove(callback)
        if not callbacks:
            self._callbacks.pop(topic, None)

    def _on_graph_change(self) -> None:
        if self._callbacks and not self._is_check_queued:
            self._is_check_queued = True
            self._exchange.post(self._call_callbacks)

    def _call_callbacks(self) -> None:
        self._is_check_queued = False
        for topic in self._bridged_topics(list(self._callbacks)):
            for callback in self._callbacks.pop(topic):
                callback()

    def _bridged_topics(self, topics: list[str]) -> list[str]:
        """Return the topics in `topics` whose hidden names have publishers."""
        remote_topics = {
            remote_endpoint.name
            for remote_endpoint in self._graph.remote_endpoints()
            if remote_endpoint.kind is EndpointKind.PUBLISHER
        }
        return [
            topic
            for topic in topics
            if hidden_gz_topic(topic) in remote_topics or self._graph.bus.publishers(hidden_gz_topic(topic))
        ]
