"""The node graph, the counterpart of ``rqt_graph``."""

from __future__ import annotations

from linkwright.graph import EndpointKind
from linkwright.graph.introspection.graph_queries import GraphQueries
from linkwright.graph.names.rules import join
from linkwright.page.audience import Page
from linkwright.page.protocol.monitor import GraphTopic, NodeGraph, WatchNodeGraph
from linkwright.panels.page_feature import FeatureHost, PageFeature


class NodeGraphFeature(PageFeature):
    """The feature that sends the nodes and topics to subscribed pages.

    The nodes and topics are sent initially and after every change.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._sent_graphs: dict[Page, NodeGraph] = {}

    def receive(self, page: Page, message: WatchNodeGraph) -> None:
        """Start or stop sending the graph to a page."""
        if not message.watched:
            self.remove_page(page)
            return
        self._sent_graphs[page] = graph = make_node_graph(self.context.node.graph)
        page.send(graph)
        self.context.graph_changes.watch(self._publish)

    def remove_page(self, page: Page) -> None:
        """Stop sending the graph to the page."""
        self._sent_graphs.pop(page, None)
        if not self._sent_graphs:
            self.context.graph_changes.unwatch(self._publish)

    def close(self) -> None:
        """Stop sending the graph to any page."""
        self._sent_graphs.clear()
        self.context.graph_changes.unwatch(self._publish)

    def _publish(self) -> None:
        graph = make_node_graph(self.context.node.graph)
        for page, sent_graph in self._sent_graphs.items():
            if graph != sent_graph:
                self._sent_graphs[page] = graph
                page.send(graph)


def make_node_graph(graph: GraphQueries) -> NodeGraph:
    """Return the current nodes and topics.

    As in ROS, nodes with the same name count as one node.
    """
    topics: dict[str, GraphTopic] = {}
    for endpoint in graph.endpoints():
        if endpoint.kind not in (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION):
            continue
        topic = topics.setdefault(endpoint.name, GraphTopic(endpoint.name, [], [], []))
        if endpoint.type_name not in topic.types:
            topic.types.append(endpoint.type_name)
        if endpoint.node is not None:
            node_names = topic.publishers if endpoint.kind is EndpointKind.PUBLISHER else topic.subscribers
            name = join(endpoint.node.namespace, endpoint.node.name)
            if name not in node_names:
                node_names.append(name)
    for topic in topics.values():
        for names in (topic.types, topic.publishers, topic.subscribers):
            names.sort()
    nodes = sorted({join(node.namespace, node.name) for node in graph.identities()})
    return NodeGraph(nodes, [topics[name] for name in sorted(topics)])
