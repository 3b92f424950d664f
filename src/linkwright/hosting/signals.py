"""Handling of Ctrl-C and other signals.

The first signal ends a run in order, the second one hurries the end, and the third one ends the run immediately.

Work that must be completed, such as writing the end of a recording, is completed in any case (`unfinished`).
"""

from __future__ import annotations

import asyncio
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager
from types import FrameType, TracebackType
from typing import Any, Protocol, TypeVar

from linkwright.files.unfinished import finish_all
from linkwright.hosting.launch_log import LaunchLog
from linkwright.packages import PackageFinder, use_finder
from linkwright.process.event_loop import run_coroutine
from linkwright.process.interruption import signal_again, when_lost

T = TypeVar("T")

_DEADLINE_SECONDS = 1.9
"""However badly the program hangs: this long after a signal it finishes its recordings and ends, or, after
the first one, its event loop gives the processes the time that they have."""
_SAME_KEYPRESS_SECONDS = 0.3
"""Signals within this time count as one: a wrapper may pass a terminal's Ctrl-C on."""

_SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))


class Session(Protocol):
    """A run that a signal ends in order."""

    @property
    def loop(self) -> asyncio.AbstractEventLoop | None:
        """The event loop of the run, or None before it exists."""

    @property
    def visiting(self) -> bool:
        """Whether code is running that blocks the event loop and that a KeyboardInterrupt may interrupt."""

    def interrupt(self, reason: str) -> None:
        """End the run at the user's request."""

    def seconds_to_end(self) -> float:
        """Return the seconds that the run's processes may take to end."""

    def kill_all(self) -> None:
        """Kill the run's processes immediately; called from a signal handler."""


class SignalWatch:
    """Handles signals inside a ``with`` block.

    In a thread other than the main thread, signals are not handled.

    Attributes:
        session: the run to end; None before one exists, when a signal raises a KeyboardInterrupt instead.
        received: the first received signal, or None.
    """

    def __init__(self) -> None:
        self.session: Session | None = None
        self.received: int | None = None
        self._received_at = 0.0
        self._hurried = False
        self._is_making_loop = False
        self._before: dict[int, Any] = {}
        self._unraisable: Callable[[Any], Any] | None = None
        self._deadline: threading.Timer | None = None

    @property
    def exit_status(self) -> int | None:
        """The exit status for the received signal, 128 plus its number as in shells, or None."""
        return None if self.received is None else 128 + self.received

    def __enter__(self) -> SignalWatch:  # noqa: PYI034 - typing.Self needs Python 3.11
        if threading.current_thread() is threading.main_thread():
            for number in _SIGNALS:
                self._before[number] = signal.signal(number, self._handle)
            self._unraisable = when_lost(self._handle_again)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
        for number, handler in self._before.items():
            signal.signal(number, handler)
        if self._unraisable is not None:
            sys.unraisablehook = self._unraisable

    def run(self, make: Callable[[], Coroutine[Any, Any, T]]) -> T:
        """Run a coroutine on a new event loop.

        Raises:
            KeyboardInterrupt: a signal was received while the loop was created.
        """
        self._is_making_loop = True
        return run_coroutine(make, self._loop_is_made)

    def _loop_is_made(self) -> None:
        self._is_making_loop = False
        if self.received is not None:
            raise KeyboardInterrupt

    def _handle(self, number: int, _: FrameType | None) -> None:
        now = time.monotonic()
        session, at_once = self.session, False
        if self.received is not None:
            if now - self._received_at <= _SAME_KEYPRESS_SECONDS:
                return
            at_once = self._hurried or session is None or session.loop is None
            self._hurried = True
        self.received, self._received_at = self.received or number, now
        self._end_after(0.0 if at_once else _DEADLINE_SECONDS)
        if at_once or self._is_making_loop:
            return
        if session is None or session.loop is None:
            raise KeyboardInterrupt
        session.loop.call_soon_threadsafe(self._extend_deadline, session)
        if session.visiting:
            raise KeyboardInterrupt
        session.loop.call_soon_threadsafe(session.interrupt, interruption_text(number))

    def _extend_deadline(self, session: Session) -> None:
        """Extend the deadline by the time that processes may take, because the event loop responds."""
        if not self._hurried:
            self._end_after(_DEADLINE_SECONDS + session.seconds_to_end())

    def _end_after(self, seconds: float) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
        self._deadline = threading.Timer(seconds, self._end_immediately)
        self._deadline.daemon = True
        self._deadline.start()

    def _handle_again(self) -> None:
        """Restore the former state and send the signal again, because its KeyboardInterrupt had no effect."""
        number, self.received = self.received, None
        if self._deadline is not None:
            self._deadline.cancel()
        if number is not None:
            signal_again(number)

    def _end_immediately(self) -> None:
        """End the process from a separate thread.

        The main thread may be blocked, or may be writing files that must be completed.
        """
        if self.session is not None:
            self.session.kill_all()
        finish_all()
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
        os._exit(self.exit_status or 1)


def interruption_text(number: int) -> str:
    """Return the log line for a signal."""
    if number == signal.SIGINT:
        return "user interrupted with ctrl-c (SIGINT)"
    return f"received signal {signal.Signals(number).name}"


def run_to_end(run: Callable[[SignalWatch], bool], finder: PackageFinder, log: LaunchLog) -> int:
    """Run a program that ends in order after a signal.

    Args:
        run: runs the program, and returns whether it succeeded.
        finder: finds packages during the run.
        log: the log for signals that arrive before there is a session.

    Returns:
        The exit status: 0, 1 if something failed, or 128 plus the signal's number after a signal.
    """
    with SignalWatch() as signals:
        try:
            with own_environment(finder):
                succeeded = run(signals)
        except KeyboardInterrupt:
            if signals.received is None:  # raised in another thread, or by the user's own code
                raise
            log.warning_line("launch", interruption_text(signals.received))
            succeeded = False
        if signals.exit_status is not None:
            return signals.exit_status
        return 0 if succeeded else 1


@contextmanager
def own_environment(finder: PackageFinder) -> Iterator[None]:
    """Find packages with a finder inside a ``with`` block, and set ``AMENT_PREFIX_PATH`` to its prefixes.

    Changes to the environment of this process are undone afterwards.
    """
    before = dict(os.environ)
    try:
        with use_finder(finder):
            finder.offer_prefix_path(os.environ)
            yield
    finally:
        for name in [name for name in os.environ if name not in before]:
            del os.environ[name]
        os.environ.update(before)
