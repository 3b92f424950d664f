"""Tells on the event loop that nodes or endpoints came or went: once for many changes in a row."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress

from linkwright.graph.introspection.graph_queries import GraphQueries

_QUIET = 0.1
"""Seconds that changes are gathered for: a node that starts makes dozens of endpoints."""


class GraphChanges:
    """The changes of a graph, for those who listen; costs nothing while nobody does.

    Args:
        graph: whose changes; they may happen in any thread.
    """

    def __init__(self, graph: GraphQueries) -> None:
        self._graph = graph
        self._listeners: dict[Callable[[], None], None] = {}
        self._loop = asyncio.get_running_loop()
        self._due: asyncio.TimerHandle | None = None

    def listen(self, changed: Callable[[], None]) -> None:
        """Have something called on the loop after changes."""
        if not self._listeners:
            self._graph.watch(self._changed)
        self._listeners[changed] = None

    def ignore(self, changed: Callable[[], None]) -> None:
        """Do not have it called any longer."""
        self._listeners.pop(changed, None)
        if not self._listeners:
            self._graph.unwatch(self._changed)
            if self._due is not None:
                self._due.cancel()
                self._due = None

    def _changed(self) -> None:
        with suppress(RuntimeError):  # the loop is closed: nobody listens any more
            self._loop.call_soon_threadsafe(self._wait)

    def _wait(self) -> None:
        if self._due is None and self._listeners:
            self._due = self._loop.call_later(_QUIET, self._tell)

    def _tell(self) -> None:
        self._due = None
        for changed in tuple(self._listeners):
            if changed in self._listeners:
                changed()
