"""The Zenoh transport: mirrors the graph of this process in a Zenoh session, as rmw_zenoh_cpp does."""

from __future__ import annotations

from linkwright.graph.log.logger import Logger
from linkwright.wire.background import BackgroundTransport, Engine
from linkwright.wire.zenoh.departures import Departures
from linkwright.wire.zenoh.remote import RemoteGraph
from linkwright.wire.zenoh.settings import Settings

SETTLED_AFTER = 0.4
"""Seconds without news after which discovery counts as complete."""


class ZenohTransport(BackgroundTransport):
    """The graph of this process in a Zenoh session.

    Args:
        settings: the domain and how to join it.
        logger: for what there is to tell.
        only_looks: see `BackgroundTransport`.
    """

    def __init__(self, settings: Settings, logger: Logger, *, only_looks: bool = False) -> None:
        self._settings = settings
        self._remote = RemoteGraph()
        self._departures = Departures(self._remote)
        super().__init__(settings.domain_id, self._remote, self._departures, logger, only_looks=only_looks)

    def _make_engine(self) -> Engine:
        from linkwright.wire.zenoh.engine import Engine as ZenohEngine

        return ZenohEngine(self._settings, self._remote, self._departures, self._work, self._logger)

    def _has_settled(self, quiet: float) -> bool:
        return quiet >= SETTLED_AFTER
