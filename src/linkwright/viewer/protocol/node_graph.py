"""The node graph: who publishes what, and who subscribes to it."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.record import record


@record
class GraphTopic:
    """A topic with the full names of the nodes at both ends."""

    name: str
    types: list[str]
    publishers: list[str]
    subscribers: list[str]


@record
class NodeGraph:
    """All nodes and topics; sent when the panel opens and when they change."""

    nodes: list[str]
    topics: list[GraphTopic]
    type: Literal["node_graph"] = "node_graph"


@record
class WatchNodeGraph:
    """Whether the page wants to be told of the node graph."""

    watched: bool
    type: Literal["watch_node_graph"] = "watch_node_graph"
