"""Subscriptions that exist only while the topics published from them have subscribers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from linkwright.graph import Graph, Node, Publisher, Subscription


class LazySubscriptions:
    """Keeps subscriptions open while at least one of some publishers has a subscriber.

    Args:
        graph: the graph, which reports changes.
        node: the owner of the subscriptions.
        publishers: the publishers whose subscribers count.
        subscribe: creates the subscriptions.
    """

    def __init__(
        self,
        graph: Graph,
        node: Node,
        publishers: Sequence[Publisher[Any]],
        subscribe: Callable[[], Sequence[Subscription[Any]]],
    ) -> None:
        self._graph = graph
        self._node = node
        self._publishers = publishers
        self._subscribe = subscribe
        self._open: Sequence[Subscription[Any]] = ()
        self._changed = node.create_guard_condition(self._look)
        graph.watch(self._changed.trigger)
        self._look()

    @property
    def are_open(self) -> bool:
        """Whether the subscriptions are open."""
        return bool(self._open)

    def close(self) -> None:
        """Stop watching; the subscriptions are removed with their node."""
        self._graph.unwatch(self._changed.trigger)

    def _look(self) -> None:
        wanted = any(publisher.get_subscription_count() for publisher in self._publishers)
        if wanted and not self._open:
            self._open = self._subscribe()
        elif not wanted and self._open:
            for subscription in self._open:
                self._node.destroy_subscription(subscription)
            self._open = ()
