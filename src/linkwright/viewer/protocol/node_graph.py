"""The node graph: who publishes what, and who subscribes to it."""

from __future__ import annotations

from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage


class GraphTopic(Record):
    """A topic with the full names of the nodes at both ends."""

    name: str
    types: list[str]
    publishers: list[str]
    subscribers: list[str]


class NodeGraph(ServerMessage):
    """All nodes and topics; sent when the panel opens and when they change."""

    nodes: list[str]
    topics: list[GraphTopic]


class WatchNodeGraph(PageMessage):
    """Whether the page wants to be told of the node graph."""

    watched: bool
