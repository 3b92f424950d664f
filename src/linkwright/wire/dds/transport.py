"""The DDS transport, which mirrors the graph of this process in a DDS domain."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from linkwright.graph.log.logger import Logger
from linkwright.wire.background import BackgroundTransport, TransportOptions
from linkwright.wire.dds.departures import DdsDepartureMonitor
from linkwright.wire.dds.local_sockets import count_other_processes
from linkwright.wire.dds.remote import RemoteGraph
from linkwright.wire.dds.settings import Range, Settings
from linkwright.wire.engine import Engine

if TYPE_CHECKING:
    from typing_extensions import Unpack

SETTLE_TIME_S = 0.3
"""Seconds without changes after which discovery counts as complete."""

_SETTLE_TIME_ALL_KNOWN_S = 0.05
"""The same, if all processes are known. A process may still be creating participants or endpoints."""


class DdsTransport(BackgroundTransport):
    """The transport that mirrors the graph of this process in a DDS domain.

    Args:
        settings: the domain and how to join it.
        logger: logs problems.
        options: see `BackgroundTransport`.
    """

    def __init__(self, settings: Settings, logger: Logger, **options: Unpack[TransportOptions]) -> None:
        for warning in settings.warnings:
            logger.warning(warning)
        self._settings = settings
        self._remote = RemoteGraph()
        self._departures = DdsDepartureMonitor(self._remote)
        super().__init__(settings.domain_id, self._remote, self._departures, logger, **options)

    def _make_engine(self) -> Engine:
        # Imported here, in the thread that joins, because loading Cyclone takes 0.15 s.
        from linkwright.wire.dds.engine import Engine as DdsEngine

        return DdsEngine(self._settings, self._remote, self._departures, self._work, self._logger)

    def _has_settled(self, quiet_s: float) -> bool:
        """Return whether all participants have announced their nodes, and nothing changes."""
        return self._remote.is_complete() and (
            quiet_s >= SETTLE_TIME_S or (quiet_s >= _SETTLE_TIME_ALL_KNOWN_S and self._knows_all_processes())
        )

    def _knows_all_processes(self) -> bool:
        """Return whether all processes in the domain are known, so that discovery need not wait.

        The result is True only if discovery is restricted to this machine, all processes in the domain belong to
        Linkwright, and this process has only one participant.
        """
        if self._settings.range is not Range.MACHINE:
            return False
        process_count, known_processes = (
            count_other_processes(self._settings.domain_id),
            self._remote.find_linkwright_process_ids(),
        )
        return (
            process_count is not None and os.getpid() not in known_processes and len(known_processes) >= process_count
        )
