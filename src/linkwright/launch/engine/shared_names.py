"""Says that another launch has nodes with the names of ours: in one line of the terminal, and on the page."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

from linkwright.diagnostics import Diagnostic, Phrase, Severity, joined, phrase, translated
from linkwright.launch.engine.network import Network
from linkwright.launch.log.launch_log import LaunchLog

_GATHER_SECONDS = 0.3
"""Nodes of another launch are heard of one after another; so long they are waited for, to be told of together."""
_LISTED = 6
"""Names in the line, which is one of the terminal."""


class SharedNames:
    """What the graph of a launch tells of shared names.

    Args:
        network: knows which domain the names are shared on.
        log: where the line goes.
        show: called when `findings` are others.
    """

    def __init__(self, network: Network, log: LaunchLog, show: Callable[[], None]) -> None:
        self._network = network
        self._log = log
        self._show = show
        self._loop = asyncio.get_running_loop()
        self._names: frozenset[str] = frozenset()
        self._told: frozenset[str] = frozenset()
        self._telling: asyncio.TimerHandle | None = None
        self.findings: list[Diagnostic] = []
        """What the page shows: one finding as long as names are shared, else none."""

    def notice(self, names: frozenset[str]) -> None:
        """Take note of the full names of nodes that are shared now; from any thread."""
        with suppress(RuntimeError):  # the loop has come to its end
            self._loop.call_soon_threadsafe(self._gather, names)

    def close(self) -> None:
        """Tell of nothing any more."""
        if self._telling is not None:
            self._telling.cancel()

    def _gather(self, names: frozenset[str]) -> None:
        self._names = names
        if self._telling is None:
            self._telling = self._loop.call_later(_GATHER_SECONDS, self._tell)

    def _tell(self) -> None:
        self._telling = None
        new, self._told = self._names - self._told, self._names
        if new:
            (finding,) = translated([self._finding(new)])
            self._log.caution("launch", f"{finding.message}; {finding.hint}")
        self.findings = [self._finding(self._names)] if self._names else []
        self._show()

    def _finding(self, names: frozenset[str]) -> Diagnostic:
        domain = self._network.domain_id or 0
        message = phrase(
            "another launch or program on ROS_DOMAIN_ID {domain} has nodes of the same names, and the two disturb each"
            " other: {names}",
            domain=domain,
            names=_listed(sorted(names)),
        )
        hint = phrase(
            "give one of them another domain, as in ROS_DOMAIN_ID={other} linkwright launch ...", other=domain + 1
        )
        return replace(Diagnostic("LAUNCH148", message, hint=hint), severity=Severity.WARNING)


def _listed(names: list[str]) -> Phrase:
    listed = joined(names[:_LISTED])
    if len(names) <= _LISTED:
        return listed
    return phrase("{names} and {count} more", names=listed, count=len(names) - _LISTED)
