"""Subscriptions that exist only while the output topics have subscribers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from linkwright.graph import Graph, Node, Publisher, Subscription


class LazySubscriptions:
    """Subscriptions that are open while at least one of the given publishers has a subscriber.

    Args:
        graph: the graph, which reports changes.
        node: the node that owns the subscriptions.
        publishers: the publishers that depend on the subscriptions.
        subscribe: creates the subscriptions, and returns them.
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
        self._subscriptions: Sequence[Subscription[Any]] = ()
        self._graph_condition = node.create_guard_condition(self._update_subscriptions)
        graph.watch(self._graph_condition.trigger)
        self._update_subscriptions()

    @property
    def are_open(self) -> bool:
        """Whether the subscriptions currently exist."""
        return bool(self._subscriptions)

    def close(self) -> None:
        """Stop watching the graph.

        The subscriptions are destroyed with their node.
        """
        self._graph.unwatch(self._graph_condition.trigger)

    def _update_subscriptions(self) -> None:
        is_needed = any(publisher.get_subscription_count() for publisher in self._publishers)
        if is_needed and not self._subscriptions:
            self._subscriptions = self._subscribe()
        elif not is_needed and self._subscriptions:
            for subscription in self._subscriptions:
                self._node.destroy_subscription(subscription)
            self._subscriptions = ()
