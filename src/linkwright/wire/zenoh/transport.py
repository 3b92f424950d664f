"""The Zenoh transport, which mirrors the graph of this process as rmw_zenoh_cpp does."""

from __future__ import annotations

import time
from threading import Event, Lock
from typing import TYPE_CHECKING, cast

from linkwright.graph.log.logger import Logger
from linkwright.wire.background import BackgroundTransport, TransportOptions
from linkwright.wire.engine import Engine
from linkwright.wire.zenoh.departures import Departures
from linkwright.wire.zenoh.remote import RemoteGraph
from linkwright.wire.zenoh.settings import Settings

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from linkwright.wire.zenoh.engine import Engine as ZenohEngine
    from linkwright.wire.zenoh.opening import SessionOpener

SETTLED_AFTER = 0.4
"""Seconds without news after which discovery counts as complete, where another session is linked to this one."""

_ANSWERED_WITHIN = 2.0
"""Seconds within which the router answers with the live tokens; the first query waits for that."""

_QUIET = 0.1
"""Seconds without news after which the answer counts as complete."""

_ALONE_AFTER = 1.4
"""The same where there is no router. Other sessions are asked at once and again after a second."""


class ZenohTransport(BackgroundTransport):
    """Mirrors the graph of this process in a Zenoh session.

    Args:
        settings: the domain and how to join it.
        logger: logs problems.
        options: see `BackgroundTransport`.
    """

    def __init__(self, settings: Settings, logger: Logger, **options: Unpack[TransportOptions]) -> None:
        self._settings = settings
        self._remote = RemoteGraph()
        self._departures = Departures(self._remote)
        self._zenoh_engine: ZenohEngine | None = None
        self._patience: SessionOpener | None = None
        self._linked_at = 0.0
        self._looks = False
        self._looking = Lock()
        self._looked = Event()
        super().__init__(settings.domain_id, self._remote, self._departures, logger, **options)

    def look_around(self) -> None:
        """Discover the whole remote graph.

        Before this call, a client of a router receives only the tokens that its own endpoints need.
        """
        engine = self._zenoh_engine
        waits = engine is not None and self._decided.is_set() and not engine.runs_this
        with self._looking:
            looks, self._looks = self._looks, True
        if looks:
            if waits and not self._looked.is_set():
                self._looked.wait(_ANSWERED_WITHIN)
            return
        answered = Event()
        self._do(lambda engine: cast("ZenohEngine", engine).look_around(_ANSWERED_WITHIN, answered.set))
        if waits:  # if not waiting, the remote graph arrives step by step
            self._wait_for_answer(answered)
            self._do(self._note_news)
            self._looked.wait(_ANSWERED_WITHIN)
        self._looked.set()

    @property
    def waits(self) -> bool:
        """Whether opening the session waits for a router, because the settings require one."""
        return self._patience is not None and self._patience.waits

    def _wait_for_answer(self, answered: Event) -> None:
        """Wait for the answer to a request for tokens, and until no more tokens arrive.

        Some tokens may arrive late.
        """
        answered.wait(_ANSWERED_WITHIN)
        begin = time.monotonic()
        while time.monotonic() < min(begin + _ANSWERED_WITHIN, max(self._remote.changed_at, begin) + _QUIET):
            time.sleep(_QUIET / 10)

    def _note_news(self, engine: Engine) -> None:
        cast("ZenohEngine", engine).process_tokens()
        self._looked.set()

    def _make_engine(self) -> Engine:
        from linkwright.wire.zenoh.engine import Engine as ZenohEngine
        from linkwright.wire.zenoh.opening import SessionOpener

        patience = SessionOpener(self._logger, self._given_up)
        self._patience = patience
        engine = ZenohEngine(self._settings, self._remote, self._departures, self._work, self._logger, patience)
        self._zenoh_engine = engine
        return engine

    def _has_settled(self, quiet: float) -> bool:
        engine = self._zenoh_engine
        if engine is None or not engine.has_neighbours():
            return quiet >= _ALONE_AFTER
        self._linked_at = self._linked_at or time.monotonic()
        return min(quiet, time.monotonic() - self._linked_at) >= SETTLED_AFTER
