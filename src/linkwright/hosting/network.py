"""The ROS 2 network: joining it, and warnings of node names that are used twice."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, Phrase, Severity, joined, phrase, translated
from linkwright.hosting.launch_log import LaunchLog

if TYPE_CHECKING:
    from linkwright.graph import Graph
    from linkwright.hosting.plans import Supervisor


_SWITCH = "LINKWRIGHT_DDS"
_DELAY_SECONDS = 0.8
"""With a viewer the page and the robot come first: joining the network takes a processor for a fifth of a second."""


class Network:
    """Joins the graph of a launch to the ROS 2 network.

    Args:
        session: the launch.

    Attributes:
        domain_id: the ROS_DOMAIN_ID of the network; None if it was not joined.

    Raises:
        LinkwrightError: DDS121, the network must be joined with security.
    """

    def __init__(self, session: Supervisor) -> None:
        self._session = session
        if session.options.network:
            from linkwright.wire.joining import check_security

            check_security()
        self._graph: Graph | None = None
        self._handle: asyncio.TimerHandle | None = None
        self.domain_id: int | None = None

    def offer(self, graph: Graph) -> None:
        """Set the graph that is joined to the network."""
        self._graph = graph

    def join_soon(self, *, with_viewer: bool) -> None:
        """Join the network after a delay, once.

        Nothing happens if there is no graph, or if joining is switched off.
        """
        if self._graph is None or self._handle is not None or not self._is_enabled():
            return
        loop = asyncio.get_running_loop()
        self._handle = loop.call_later(_DELAY_SECONDS if with_viewer else 0.0, self._join)

    def close(self) -> None:
        """Cancel joining the network."""
        if self._handle is not None:
            self._handle.cancel()
        self._graph = None

    def _is_enabled(self) -> bool:
        return self._session.options.network and os.environ.get(_SWITCH) != "0"

    def _join(self) -> None:
        graph = self._graph
        if graph is None or graph.closed:
            return
        from linkwright.wire.joining import available, join, unavailable_reason

        if available():
            transport = join(graph)
            self.domain_id = None if transport is None else transport.domain_id
        elif self._session.has_processes:
            self._session.log.warning_line(
                "launch", f"the nodes in this process and those in others cannot see each other: {unavailable_reason()}"
            )


_GATHER_SECONDS = 0.3
"""Seconds to collect names, because nodes of another launch are discovered one by one: one warning lists them all."""
_LISTED = 6
"""The most names in the warning, which is one line of the terminal."""


class SharedNames:
    """Warns about node names that a launch has in common with other programs in the network.

    Args:
        network: the network, whose domain the warning names.
        log: the log for the warning.
        show: called when `findings` have changed.
    """

    def __init__(self, network: Network, log: LaunchLog, show: Callable[[], None]) -> None:
        self._network = network
        self._log = log
        self._show = show
        self._loop = asyncio.get_running_loop()
        self._names: frozenset[str] = frozenset()
        self._reported: frozenset[str] = frozenset()
        self._report_timer: asyncio.TimerHandle | None = None
        self.findings: list[Diagnostic] = []
        """The findings for the page: one as long as names are shared, else none."""

    def notice(self, names: frozenset[str]) -> None:
        """Set the full names of the nodes that exist twice now; may be called from any thread."""
        with suppress(RuntimeError):  # The event loop may have been closed.
            self._loop.call_soon_threadsafe(self._gather, names)

    def close(self) -> None:
        """Cancel a pending warning."""
        if self._report_timer is not None:
            self._report_timer.cancel()

    def _gather(self, names: frozenset[str]) -> None:
        self._names = names
        if self._report_timer is None:
            self._report_timer = self._loop.call_later(_GATHER_SECONDS, self._report)

    def _report(self) -> None:
        self._report_timer = None
        new, self._reported = self._names - self._reported, self._names
        if new:
            (finding,) = translated([self._finding(new)])
            self._log.warning_line("launch", f"{finding.message}; {finding.hint}")
        self.findings = [self._finding(self._names)] if self._names else []
        self._show()

    def _finding(self, names: frozenset[str]) -> Diagnostic:
        domain = self._network.domain_id or 0
        message = phrase(
            "another launch or program on ROS_DOMAIN_ID {domain} has nodes with the same names, and the two "
            "interfere: {names}",
            domain=domain,
            names=_listed(sorted(names)),
        )
        hint = phrase(
            "give one of them another domain, as in ROS_DOMAIN_ID={other} linkwright launch ...", other=domain + 1
        )
        return Diagnostic("LAUNCH148", message, hint=hint).with_changes(severity=Severity.WARNING)


def _listed(names: list[str]) -> Phrase:
    listed = joined(names[:_LISTED])
    if len(names) <= _LISTED:
        return listed
    return phrase("{names} and {count} more", names=listed, count=len(names) - _LISTED)
