"""Updates of a bridge after changes to the graph."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress

from linkwright.graph import Graph, Node

_DELAY_S = 0.1
"""Seconds for which changes to the graph are collected."""


class GraphUpdates:
    """Calls a function in the event loop after changes to the graph, once for those that follow each other.

    Args:
        graph: the graph, which reports changes from any thread.
        node: the node of the bridge. Nothing is called any more once it is destroyed.
        update: the function.
    """

    def __init__(self, graph: Graph, node: Node, update: Callable[[], object]) -> None:
        self._graph = graph
        self._node = node
        self._update = update
        self._loop = asyncio.get_running_loop()
        self._timer: asyncio.TimerHandle | None = None
        graph.watch(self._on_change)

    def close(self) -> None:
        """Stop, also with changes that are collected already."""
        self._graph.unwatch(self._on_change)
        if self._timer is not None:
            self._timer.cancel()

    def _on_change(self) -> None:
        with suppress(RuntimeError):  # the event loop was closed
            self._loop.call_soon_threadsafe(self._schedule)

    def _schedule(self) -> None:
        if self._timer is None and not self._node.handle.is_destroyed:
            self._timer = self._loop.call_later(_DELAY_S, self._run)

    def _run(self) -> None:
        self._timer = None
        self._update()
