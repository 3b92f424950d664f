"""Methods that do what the method of the same name of a wrapped object does."""

from __future__ import annotations

from collections.abc import Callable
from functools import update_wrapper
from typing import Any, Concatenate, ParamSpec, TypeVar

from linkwright.graph import Node as GraphNode
from linkwright.graph.names import InvalidNameError

P = ParamSpec("P")
R = TypeVar("R")


def to_graph_node(method: Callable[Concatenate[GraphNode, P], R]) -> Callable[Concatenate[Any, P], R]:
    """A method that does what this one does with the ``graph_node`` of its object, with its signature and docstring."""
    name = method.__name__

    def forward(self: Any, /, *args: P.args, **kwargs: P.kwargs) -> R:
        result: R = getattr(self.graph_node, name)(*args, **kwargs)
        return result

    return update_wrapper(forward, method)


def to_graph_node_by_name(
    method: Callable[Concatenate[GraphNode, str, P], R],
) -> Callable[Concatenate[Any, str, P], R]:
    """As `to_graph_node`, for a question about a topic or service; its mistakes are told as rclpy tells them."""
    name = method.__name__

    def forward(self: Any, asked: str, /, *args: P.args, **kwargs: P.kwargs) -> R:
        if not isinstance(asked, str):
            raise TypeError(f"bad argument type for built-in operation: {asked!r} is not a name")
        try:
            result: R = getattr(self.graph_node, name)(asked, *args, **kwargs)
        except InvalidNameError as error:
            raise ValueError(f"{error.kind} is invalid: {error}") from error
        return result

    return update_wrapper(forward, method)
