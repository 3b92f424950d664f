"""The topics that other nodes publish, cached for all displays until the graph changes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkwright.graph.introspection.graph_queries import UNKNOWN_NODE

if TYPE_CHECKING:
    from linkwright.graph import Node


class PublishedTopics:
    """The topics that the nodes of a graph publish, except one node: a viewer, whose publishers are its tools.

    Displays without messages check every second why there are none, and a configuration has hundreds of them.

    Args:
        node: the viewer's node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._is_current = False
        self._watches = False
        self._publishers: dict[str, list[tuple[str, str]]] = {}
        self._topics: dict[str, list[str]] = {}

    def publishers(self, topic: str) -> list[tuple[str, str]]:
        """Return node and type of each publisher of a topic, by its name in the viewer's node.

        Raises:
            InvalidTopicNameError: the name is not valid.
        """
        name = self._node.resolve_topic_name(topic)
        self._look()
        return self._publishers.get(name, [])

    def of_type(self, message: str) -> list[str]:
        """Return the topics that carry messages of a type, sorted."""
        self._look()
        return self._topics.get(message, [])

    def close(self) -> None:
        """Stop watching the graph."""
        if self._watches:
            self._node.graph.unwatch(self._changed)
            self._watches = False

    def _changed(self) -> None:
        self._is_current = False

    def _look(self) -> None:
        if not self._watches:
            self._watches = True
            self._node.graph.watch(self._changed)
        if self._is_current:
            return
        self._is_current = True  # first: a change during the lookup is seen by the next one
        publishers: dict[str, list[tuple[str, str]]] = {}
        topics: dict[str, set[str]] = {}
        own = self._node.get_name()
        for publisher in self._node.graph.publishers():
            node = (publisher.node or UNKNOWN_NODE).name
            if node != own:
                publishers.setdefault(publisher.name, []).append((node, publisher.type_name))
                topics.setdefault(publisher.type_name, set()).add(publisher.name)
        self._publishers = publishers
        self._topics = {message: sorted(names) for message, names in topics.items()}
