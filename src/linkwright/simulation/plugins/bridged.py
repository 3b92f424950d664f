"""gz topics whose names a bridge also uses in ROS, but with another type.

Topics of gz are topics of the graph under their own names. A bridge from ``geometry_msgs/msg/TwistStamped`` to
``gz.msgs.Twist`` with one name for both sides, as in the robots of Jazzy, would give this topic two types. Therefore
the gz side gets a hidden name as soon as there is such a bridge, in this process or in another one.
"""

from __future__ import annotations

from collections.abc import Callable

from linkwright.graph import EndpointKind, Node
from linkwright.graph.stepped.exchange import Exchange

_HIDDEN = "/_gz"


def hidden_gz_topic(topic: str) -> str:
    """Return the hidden name that a gz topic gets when a bridge uses its name for another type.

    Both names are absolute.
    """
    return _HIDDEN + topic


class BridgedTopics:
    """A watcher that notifies a simulation's plugins when a bridge starts to use a topic's name.

    Args:
        node: the simulator's node.
        exchange: passes the notification to the simulation thread.
    """

    def __init__(self, node: Node, exchange: Exchange) -> None:
        self._graph = node.graph
        self._exchange = exchange
        self._moves: dict[str, list[Callable[[], None]]] = {}
        self._is_due = False
        self._graph.watch(self._changed)

    def close(self) -> None:
        """Stop watching the graph and notifying the plugins."""
        self._graph.unwatch(self._changed)

    def has(self, topic: str) -> bool:
        """Return whether a bridge offers a topic under another type."""
        return topic in self._bridged([topic])

    def notify(self, topic: str, move: Callable[[], None]) -> None:
        """Register a function to be called once, when a bridge offers a topic under another type."""
        self._moves.setdefault(topic, []).append(move)

    def forget(self, topic: str, move: Callable[[], None]) -> None:
        """Unregister a function that was registered with `notify`."""
        moves = self._moves.get(topic, [])
        if move in moves:
            moves.remove(move)
        if not moves:
            self._moves.pop(topic, None)

    def _changed(self) -> None:
        if self._moves and not self._is_due:
            self._is_due = True
            self._exchange.post(self._review)

    def _review(self) -> None:
        self._is_due = False
        for topic in self._bridged(list(self._moves)):
            for move in self._moves.pop(topic):
                move()

    def _bridged(self, topics: list[str]) -> list[str]:
        """Return the topics in `topics` whose hidden names have publishers."""
        outside = {
            remote_endpoint.name
            for remote_endpoint in self._graph.remote_endpoints()
            if remote_endpoint.kind is EndpointKind.PUBLISHER
        }
        return [
            topic
            for topic in topics
            if hidden_gz_topic(topic) in outside or self._graph.bus.publishers(hidden_gz_topic(topic))
        ]
