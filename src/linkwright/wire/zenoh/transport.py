"""The Zenoh transport, which mirrors the graph of this process as rmw_zenoh_cpp does."""

from __future__ import annotations

import time
from threading import Event, Lock
from typing import TYPE_CHECKING, cast

from linkwright.graph.log.logger import Logger
from linkwright.wire.background import BackgroundTransport, TransportOptions
from linkwright.wire.engine import Engine
from linkwright.wire.zenoh.departures import ZenohDepartureMonitor
from linkwright.wire.zenoh.remote import RemoteGraph
from linkwright.wire.zenoh.settings import Settings

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from linkwright.wire.zenoh.engine import Engine as ZenohEngine
    from linkwright.wire.zenoh.session_opener import SessionOpener

SETTLE_TIME_S = 0.4
"""Seconds without changes after which discovery counts as complete, if another session is connected."""

_ANSWER_TIMEOUT_S = 2.0
"""Seconds within which the router answers with the live tokens. The first query waits for the answer."""

_QUIET_S = 0.1
"""Seconds without new tokens after which the answer counts as complete."""

_ALONE_TIMEOUT_S = 1.4
"""The same, if there is no router. Other sessions are asked immediately, and again after a second."""


class ZenohTransport(BackgroundTransport):
    """The transport that mirrors the graph of this process in a Zenoh session.

    Args:
        settings: the domain and how to join it.
        logger: logs problems.
        options: see `BackgroundTransport`.
    """

    def __init__(self, settings: Settings, logger: Logger, **options: Unpack[TransportOptions]) -> None:
        self._settings = settings
        self._remote = RemoteGraph()
        self._departures = ZenohDepartureMonitor(self._remote)
        self._zenoh_engine: ZenohEngine | None = None
        self._opener: SessionOpener | None = None
        self._connected_at = 0.0
        self._is_discovering = False
        self._discovery_lock = Lock()
        self._discovery_done = Event()
        super().__init__(settings.domain_id, self._remote, self._departures, logger, **options)

    def start_discovery(self) -> None:
        """Discover the whole remote graph.

        Before this call, a client of a router receives only the tokens that its own endpoints need.
        """
        engine = self._zenoh_engine
        must_wait = engine is not None and self._join_ended.is_set() and not engine.is_current_thread
        with self._discovery_lock:
            was_discovering, self._is_discovering = self._is_discovering, True
        if was_discovering:
            if must_wait and not self._discovery_done.is_set():
                self._discovery_done.wait(_ANSWER_TIMEOUT_S)
            return
        answered = Event()
        self._queue(lambda engine: cast("ZenohEngine", engine).start_discovery(_ANSWER_TIMEOUT_S, answered.set))
        if must_wait:  # if not waiting, the remote graph arrives step by step
            self._wait_for_answer(answered)
            self._queue(self._process_tokens)
            self._discovery_done.wait(_ANSWER_TIMEOUT_S)
        self._discovery_done.set()

    @property
    def waits_for_others(self) -> bool:
        """Whether opening the session waits for a router, because the settings require one."""
        return self._opener is not None and self._opener.is_waiting

    def _wait_for_answer(self, answered: Event) -> None:
        """Wait for the answer to a request for tokens, and until no more tokens arrive.

        Some tokens may arrive late.
        """
        answered.wait(_ANSWER_TIMEOUT_S)
        start = time.monotonic()
        while time.monotonic() < min(start + _ANSWER_TIMEOUT_S, max(self._remote.changed_at, start) + _QUIET_S):
            time.sleep(_QUIET_S / 10)

    def _process_tokens(self, engine: Engine) -> None:
        cast("ZenohEngine", engine).process_tokens()
        self._discovery_done.set()

    def _make_engine(self) -> Engine:
        from linkwright.wire.zenoh.engine import Engine as ZenohEngine
        from linkwright.wire.zenoh.session_opener import SessionOpener

        opener = SessionOpener(self._logger, self._given_up)
        self._opener = opener
        engine = ZenohEngine(self._settings, self._remote, self._departures, self._work, self._logger, opener)
        self._zenoh_engine = engine
        return engine

    def _has_settled(self, quiet_s: float) -> bool:
        engine = self._zenoh_engine
        if engine is None or not engine.has_neighbors():
            return quiet_s >= _ALONE_TIMEOUT_S
        self._connected_at = self._connected_at or time.monotonic()
        return min(quiet_s, time.monotonic() - self._connected_at) >= SETTLE_TIME_S
