"""Connecting the launcher's graph to other processes, in the background."""

from __future__ import annotations

import asyncio
import os
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.graph import Graph
    from linkwright.launch.engine.supervisor import Supervisor

_SWITCH = "LINKWRIGHT_DDS"
_DELAY_SECONDS = 0.8
"""With a viewer the page and the robot come first: what joins the network takes a processor for a fifth of a second."""


class Network:
    """Joins the graph of a launch to the network of ROS 2.

    Args:
        session: the launch.

    Attributes:
        domain_id: the ROS_DOMAIN_ID that was joined; None before, or where none can be.
    """

    def __init__(self, session: Supervisor) -> None:
        self._session = session
        self._graph: Graph | None = None
        self._handle: asyncio.TimerHandle | None = None
        self.domain_id: int | None = None

    def offer(self, graph: Graph) -> None:
        """Take note of the graph."""
        self._graph = graph

    def join_soon(self, *, with_viewer: bool) -> None:
        """Join in a moment, once; nothing happens without a graph, or where it is switched off."""
        if self._graph is None or self._handle is not None or not self._is_wanted():
            return
        loop = asyncio.get_running_loop()
        self._handle = loop.call_later(_DELAY_SECONDS if with_viewer else 0.0, self._join)

    def close(self) -> None:
        """Stop joining."""
        if self._handle is not None:
            self._handle.cancel()
        self._graph = None

    def _is_wanted(self) -> bool:
        return self._session.options.network and os.environ.get(_SWITCH) != "0"

    def _join(self) -> None:
        graph = self._graph
        if graph is None or graph.closed:
            return
        from linkwright.wire.dds import available, join, why_not

        if available():
            transport = join(graph)
            self.domain_id = None if transport is None else transport.domain_id
        elif self._session.has_processes:
            self._session.log.caution(
                "launch", f"the nodes in this process and those in others cannot see each other: {why_not()}"
            )
