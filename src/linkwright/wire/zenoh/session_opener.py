"""Open Zenoh sessions, with retries for as long as the configuration allows.

Waiting for a router or peers is logged and can be interrupted.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import zenoh

from linkwright.diagnostics import joined
from linkwright.graph.log.logger import Logger
from linkwright.wire.zenoh.connection_problems import (
    find_configured_addresses,
    find_connection_problems,
    get_mode_value,
)
from linkwright.wire.zenoh.session import is_connection_failure, open_session, session_error

_RETRY_INTERVAL_S = 1.0
"""Seconds between two attempts to connect."""

_LOG_DELAY_S = 1.0
"""Seconds after which the log names the reason of a wait."""

_LOG_INTERVAL_S = 10.0


class SessionOpener:
    """An opener of sessions that retries for as long as the configuration allows.

    Zenoh itself could wait, but that wait cannot be interrupted and reports nothing.

    Args:
        logger: logs the reason for a wait.
        cancel_event: an event that ends the wait; set when the session is no longer needed.
    """

    def __init__(self, logger: Logger, cancel_event: threading.Event) -> None:
        self._logger = logger
        self._cancel_event = cancel_event
        self.is_waiting = False
        """Whether opening a session currently waits for a router or peers."""

    def open(self, config: zenoh.Config) -> zenoh.Session:
        """Open a session.

        Raises:
            LinkwrightError: DDS112, the session cannot be opened, no process was reached in time, or `cancel_event`
                was set.
        """
        seconds = _get_wait_s(config)
        if seconds == 0:
            return open_session(config)
        config.insert_json5("connect/timeout_ms", "0")
        self.is_waiting = True
        reporter = ObstacleReporter(config, self._log_wait)
        try:
            reporter.start()
            return self._open_until(config, time.monotonic() + seconds)
        finally:
            reporter.end()
            self.is_waiting = False

    def _open_until(self, config: zenoh.Config, deadline: float) -> zenoh.Session:
        while True:
            result = _try_open(config)
            if isinstance(result, zenoh.Session):
                return result
            remaining_s = deadline - time.monotonic()
            if (
                not is_connection_failure(result)
                or remaining_s <= 0
                or self._cancel_event.wait(min(_RETRY_INTERVAL_S, remaining_s))
            ):
                raise session_error(result, config) from result

    def _log_wait(self, reasons: str) -> None:
        self._logger.warning(f"Waiting for a Zenoh router: {reasons}")


class ObstacleReporter:
    """A thread that reports why a session cannot reach its configured addresses.

    Args:
        config: the configuration of the session.
        log: called from the thread with the reasons.
        is_connected: returns whether the session is connected, so that there is nothing to report.
    """

    def __init__(
        self, config: zenoh.Config, log: Callable[[str], None], is_connected: Callable[[], bool] = lambda: False
    ) -> None:
        self._config = config
        self._log = log
        self._is_connected = is_connected
        self._end_event = threading.Event()
        self._thread = threading.Thread(target=self._run, name="linkwright-zenoh-waits", daemon=True)

    def start(self) -> None:
        """Start the reporting thread."""
        self._thread.start()

    def end(self) -> None:
        """Stop reporting.

        If the thread is trying an address, it ends a moment later.
        """
        self._end_event.set()

    def _run(self) -> None:
        pause_s = _LOG_DELAY_S
        while not self._end_event.wait(pause_s):
            if self._is_connected():
                pause_s = _LOG_DELAY_S
                continue
            reasons = (
                joined(find_connection_problems(self._config), "; ")
                or f"{', '.join(find_configured_addresses(self._config))} does not accept a session"
            )
            if not self._end_event.is_set() and not self._is_connected():
                self._log(reasons)
            pause_s = _LOG_INTERVAL_S


def _try_open(config: zenoh.Config) -> zenoh.Session | zenoh.ZError:
    """Try to open a session, and return the session or the error."""
    try:
        return zenoh.open(config)
    except zenoh.ZError as error:
        return error


def _get_wait_s(config: zenoh.Config) -> float:
    """Return how long a new session waits for a connection, in seconds."""
    is_client = get_mode_value(config, "mode", default="peer") == "client"
    if not find_configured_addresses(config) or not get_mode_value(
        config, "connect/exit_on_failure", default=is_client
    ):
        return 0.0
    milliseconds: Any = get_mode_value(config, "connect/timeout_ms", default=0 if is_client else -1)
    return float("inf") if milliseconds < 0 else milliseconds / 1000
