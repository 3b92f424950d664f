"""The default context, used wherever none is given."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import TYPE_CHECKING

from linkwright.graph.faults import NotInitializedError, RclError
from linkwright.standins.rclpy_api.context import Context

if TYPE_CHECKING:
    from linkwright.graph import Graph

_lock = threading.RLock()


class _Default:
    context: Context | None = None


def get_default_context(*, shutting_down: bool = False) -> Context:
    """The default context; a new one after the old one was shut down.

    Args:
        shutting_down: forget it; the next call gives a new one.

    Raises:
        RclError: there is none to be shut down.
    """
    with _lock:
        if shutting_down:
            if _Default.context is None:
                raise RclError(
                    "Context must be initialized before it can be shutdown: rclpy.init() has not been called"
                )
            context, _Default.context = _Default.context, None
            return context
        if _Default.context is None:
            _Default.context = Context()
        return _Default.context


def has_default_context() -> bool:
    """Return whether somebody has asked for the default context and it was not shut down since."""
    return _Default.context is not None


def is_default(context: Context | None) -> bool:
    """Return whether a context is the default one, which None stands for too."""
    return context is None or context is _Default.context


def use_graph(graph: Graph, args: Sequence[str]) -> Context:
    """Initialise the default context with a graph that exists, as `linkwright.testing` does; it is closed with it.

    Args:
        graph: the graph in which the nodes of the default context are.
        args: the command line.

    Raises:
        RuntimeError: the default context was initialised already.
    """
    with _lock:
        if _Default.context is not None and _Default.context.ok():
            raise RuntimeError("rclpy.init() has been called already")
        context = _Default.context = Context(graph)
    context.init(args, initialize_logging=False)
    return context


def check_initialized(context: Context, what: str) -> None:
    """Raise NotInitializedError unless a context is ok."""
    if not context.ok():
        raise NotInitializedError(what)
