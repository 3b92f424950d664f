"""The state behind rclpy's functions that are called without a context.

A process has one such state. A test that runs several programs in one process switches between a state for each of
them.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from linkwright.standins.rclpy_api.signals import SignalHandlerOptions

if TYPE_CHECKING:
    from linkwright.graph import Graph


class RclpyState:
    """The default context, global executor and open contexts of a program.

    Args:
        create_graph: creates the graph of a context; None for a graph that joins the network.

    Attributes:
        signal_options: the signals that shut contexts down, as requested by calls of ``rclpy.init``.
    """

    def __init__(self, create_graph: Callable[[], Graph] | None = None) -> None:
        self.create_graph = create_graph
        self.default_context: Any = None
        self.executor: Any = None
        self.open_contexts: weakref.WeakSet[Any] = weakref.WeakSet()
        self.signal_options = SignalHandlerOptions.NO


class _Current:
    state = RclpyState()


def current_state() -> RclpyState:
    """Return the state in use."""
    return _Current.state


@contextmanager
def use_state(state: RclpyState) -> Iterator[None]:
    """Use a state in all threads inside the ``with`` block."""
    previous_state, _Current.state = _Current.state, state
    try:
        yield
    finally:
        _Current.state = previous_state
