"""The graph of a test as a program sees it."""

from __future__ import annotations

from typing import Any

from linkwright.graph import Graph
from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.graph.names.rules import NodeIdentity, Remappings


class ProgramGraph:
    """The graph of a program's context, whose nodes belong to the graph of a test.

    The callbacks of the nodes run when the program spins them. `close` destroys only the nodes of the program.

    Args:
        graph: the graph of the test, to which all other operations are delegated.
    """

    dispatcher = None

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._handles: list[NodeHandle] = []
        self._identities: list[NodeIdentity] = []

    def __getattr__(self, name: str) -> Any:
        return getattr(self._graph, name)

    def open_node(self, identity: NodeIdentity, remappings: Remappings, **options: Any) -> NodeHandle:
        """Add a node to the graph. See ``LocalGraph.open_node``."""
        handle = self._graph.open_node(identity, remappings, **options)
        handle.set_dispatcher(None)
        self._handles.append(handle)
        self._identities.append(identity)
        return handle

    def nodes(self) -> tuple[NodeHandle, ...]:
        """Return the nodes of the program."""
        return tuple(self._handles)

    @property
    def node_names(self) -> list[tuple[str, str]]:
        """The name and the namespace of each node."""
        return [(identity.name, identity.namespace) for identity in self._identities]

    def close_threadsafe(self) -> None:
        """Destroy the nodes."""
        for handle in self._handles:
            handle.destroy()
        self._handles.clear()
        self._identities.clear()
