"""The computation graph of a process."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Concatenate, ParamSpec

from linkwright.graph.local_graph import LocalGraph
from linkwright.graph.node import Node

P = ParamSpec("P")


def _made_by(node_class: Callable[Concatenate[LocalGraph, P], Node]) -> Callable[Concatenate[Graph, P], Node]:
    """The method that makes a node of a class in a graph, with that class's further arguments."""

    @wraps(node_class, assigned=("__doc__",), updated=())
    def create_node(graph: Graph, /, *args: P.args, **kwargs: P.kwargs) -> Node:
        return node_class(graph, *args, **kwargs)

    return create_node


class Graph(LocalGraph):
    """A ROS-like computation graph.

    Made inside a running event loop, it has that loop run the callbacks of its nodes. Made elsewhere, or with
    `threads`, its nodes have no dispatcher of their own; the executors of `linkwright.graph.executors` are ones. Its
    arguments are those of `LocalGraph`.
    """

    create_node = _made_by(Node)
