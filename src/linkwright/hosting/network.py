"""Join the ROS 2 network, and warn about node names that occur twice in it."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, Severity, joined_first, phrase, translated
from linkwright.hosting.launch_log import LaunchLog

if TYPE_CHECKING:
    from linkwright.graph import Graph
    from linkwright.hosting.plans import Supervisor


_SWITCH_VARIABLE = "LINKWRIGHT_DDS"
_JOIN_DELAY_S = 0.8
"""The delay with a viewer, so that the page and the robot appear before joining, which keeps a processor busy."""


class Network:
    """The connection of a launch's graph to the ROS 2 network.

    Args:
        session: the run whose nodes join the network.

    Attributes:
        domain_id: the ROS_DOMAIN_ID of the network; None as long as it is not joined.

    Raises:
        LinkwrightError: DDS121, the environment requires a network with security.
    """

    def __init__(self, session: Supervisor) -> None:
        from linkwright.wire.joining import check_security

        check_security()
        self._session = session
        self._graph: Graph | None = None
        self._handle: asyncio.TimerHandle | None = None
        self.domain_id: int | None = None

    def set_graph(self, graph: Graph) -> None:
        """Set the graph that will join the network."""
        self._graph = graph

    def join_soon(self, *, with_viewer: bool) -> None:
        """Join the network after a delay, unless this was already requested.

        This method has no effect if there is no graph, or if the environment disables joining.
        """
        if self._graph is None or self._handle is not None or os.environ.get(_SWITCH_VARIABLE) == "0":
            return
        loop = asyncio.get_running_loop()
        self._handle = loop.call_later(_JOIN_DELAY_S if with_viewer else 0.0, self._join)

    def close(self) -> None:
        """Cancel a pending attempt to join the network."""
        if self._handle is not None:
            self._handle.cancel()
        self._graph = None

    def _join(self) -> None:
        graph = self._graph
        if graph is None or graph.closed:
            return
        from linkwright.wire.joining import is_available, join, unavailable_reason

        if is_available():
            transport = join(graph)
            self.domain_id = None if transport is None else transport.domain_id
        elif self._session.has_processes:
            self._session.log.write_warning(
                "launch", f"nodes in this process and in others cannot discover each other: {unavailable_reason()}"
            )


_COLLECTION_PERIOD_S = 0.3
"""The seconds to collect names: nodes of another launch are discovered one by one, and one warning lists all."""
_MAX_LISTED_NAMES = 6
"""The maximum number of names in the warning, so that it fits on one line of the terminal."""


class SharedNames:
    """Watches for node names that a launch shares with other programs in the network.

    Args:
        network: the network, which provides the domain for the warning.
        log: the log for the warning.
        show: called after `findings` have changed.
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
        """The findings for the page: one finding while names are shared, otherwise none."""

    def set_names(self, names: frozenset[str]) -> None:
        """Set the full names of the nodes that exist twice.

        Any thread may call this method.
        """
        with suppress(RuntimeError):  # The event loop may have been closed.
            self._loop.call_soon_threadsafe(self._schedule_report, names)

    def close(self) -> None:
        """Cancel a pending warning."""
        if self._report_timer is not None:
            self._report_timer.cancel()

    def _schedule_report(self, names: frozenset[str]) -> None:
        self._names = names
        if self._report_timer is None:
            self._report_timer = self._loop.call_later(_COLLECTION_PERIOD_S, self._report)

    def _report(self) -> None:
        self._report_timer = None
        new_names, self._reported = self._names - self._reported, self._names
        if new_names:
            (finding,) = translated([self._create_finding(new_names)])
            self._log.write_warning("launch", f"{finding.message}; {finding.hint}")
        self.findings = [self._create_finding(self._names)] if self._names else []
        self._show()

    def _create_finding(self, names: frozenset[str]) -> Diagnostic:
        domain = self._network.domain_id or 0
        message = phrase(
            "another launch or program on ROS_DOMAIN_ID {domain} has nodes with the same names, which "
            "interfere: {names}",
            domain=domain,
            names=joined_first(sorted(names), _MAX_LISTED_NAMES),
        )
        hint = phrase(
            "start one of them in another domain, for example with ROS_DOMAIN_ID={other} linkwright launch ...",
            other=domain + 1,
        )
        return Diagnostic("LAUNCH148", message, hint=hint).with_changes(severity=Severity.WARNING)
