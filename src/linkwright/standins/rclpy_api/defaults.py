"""The default context, for functions that are called without a context."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import TYPE_CHECKING

from linkwright.graph.faults import NotInitializedError, RclError
from linkwright.standins.rclpy_api.context import Context
from linkwright.standins.rclpy_api.state import current_state

if TYPE_CHECKING:
    from linkwright.graph import Graph

_lock = threading.RLock()


def get_default_context(*, shutting_down: bool = False) -> Context:
    """Return the default context, and create one if none exists.

    Args:
        shutting_down: whether to return only an existing context and to forget it, so that the next call creates a new
            one.

    Raises:
        RclError: `shutting_down` is True, and there is no default context.
    """
    with _lock:
        state = current_state()
        if shutting_down:
            if state.default_context is None:
                raise RclError(
                    "Context must be initialized before it can be shutdown: rclpy.init() has not been called"
                )
            previous_context: Context = state.default_context
            state.default_context = None
            return previous_context
        if state.default_context is None:
            state.default_context = Context()
        context: Context = state.default_context
        return context


def has_default_context() -> bool:
    """Return whether a default context was created and has not been shut down."""
    return current_state().default_context is not None


def is_default(context: Context | None) -> bool:
    """Return whether a context is the default context or None."""
    return context is None or context is current_state().default_context


def use_graph(graph: Graph, args: Sequence[str]) -> Context:
    """Initialize the default context with an existing graph, as `linkwright.testing` does.

    The graph is closed with the context.

    Args:
        graph: the graph for the nodes of the default context.
        args: the command line.

    Raises:
        RuntimeError: the default context is already initialized.
    """
    with _lock:
        state = current_state()
        if state.default_context is not None and state.default_context.ok():
            raise RuntimeError("rclpy.init() has been called already")
        context = state.default_context = Context(graph)
    context.init(args, initialize_logging=False)
    return context


def check_initialized(context: Context, action: str) -> None:
    """Raise NotInitializedError unless a context is initialized and not shut down."""
    if not context.ok():
        raise NotInitializedError(action)
