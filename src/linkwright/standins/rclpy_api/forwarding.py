"""Methods that do what the method of the same name of a wrapped object does."""

from __future__ import annotations

from collections.abc import Callable
from functools import update_wrapper
from typing import Any, Concatenate, ParamSpec, TypeVar

from linkwright.graph import Node as GraphNode

P = ParamSpec("P")
R = TypeVar("R")


def to_graph_node(method: Callable[Concatenate[GraphNode, P], R]) -> Callable[Concatenate[Any, P], R]:
    """A method that does what this one does with the ``graph_node`` of its object, with its signature and docstring."""
    name = method.__name__

    def forward(self: Any, /, *args: P.args, **kwargs: P.kwargs) -> R:
        result: R = getattr(self.graph_node, name)(*args, **kwargs)
        return result

    return update_wrapper(forward, method)
