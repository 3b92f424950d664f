"""Handlers for Ctrl-C and other signals.

The first signal ends a run in order, the second signal shortens the delays, and the third signal ends the run
immediately.

Work that must not be interrupted, such as writing the end of a recording, is completed in any case (`unfinished`).
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
from linkwright.process.interruption import on_lost_interrupt, resend_signal

T = TypeVar("T")

_DEADLINE_S = 1.9
"""The seconds after a signal until the program ends, even if it hangs.

Recordings are completed before. After the first signal, a responsive event loop adds the time that processes may take
to end."""
_SAME_KEYPRESS_S = 0.3
"""Signals within these seconds count as one, because a wrapper may forward the Ctrl-C of a terminal."""

_SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))


class Session(Protocol):
    """The interface of a run that a signal ends in order."""

    @property
    def loop(self) -> asyncio.AbstractEventLoop | None:
        """The event loop of the run, or None before it exists."""

    @property
    def is_blocking(self) -> bool:
        """Whether code is running that blocks the event loop.

        A KeyboardInterrupt may interrupt it.
        """

    def interrupt(self, reason: str) -> None:
        """End the run because the user interrupted it."""

    def seconds_to_end(self) -> float:
        """Return the maximum seconds that the processes of the run may take to end."""

    def kill_all(self) -> None:
        """Kill the processes of the run immediately.

        A signal handler calls this method.
        """


class SignalWatch:
    """A context manager that handles signals in its ``with`` block.

    Outside of the main thread, signals are not handled.

    Attributes:
        session: the run to end; None before it exists. Without a run, a signal raises a KeyboardInterrupt.
        received: the number of the first signal that was received, or None.
    """

    def __init__(self) -> None:
        self.session: Session | None = None
        self.received: int | None = None
        self._last_signal_time = 0.0
        self._is_hurried = False
        self._is_creating_loop = False
        self._previous_handlers: dict[int, Any] = {}
        self._previous_hook: Callable[[Any], Any] | None = None
        self._deadline: threading.Timer | None = None

    @property
    def exit_status(self) -> int | None:
        """The exit status after a signal, or None if there was no signal.

        As in shells, the status is 128 plus the signal's number.
        """
        return None if self.received is None else 128 + self.received

    def __enter__(self) -> SignalWatch:  # noqa: PYI034 - typing.Self needs Python 3.11
        if threading.current_thread() is threading.main_thread():
            for signal_number in _SIGNALS:
                self._previous_handlers[signal_number] = signal.signal(signal_number, self._handle)
            self._previous_hook = on_lost_interrupt(self._resend_signal)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
        for signal_number, handler in self._previous_handlers.items():
            signal.signal(signal_number, handler)
        if self._previous_hook is not None:
            sys.unraisablehook = self._previous_hook

    def run(self, create_coroutine: Callable[[], Coroutine[Any, Any, T]]) -> T:
        """Run a coroutine on a new event loop, and return its result.

        Raises:
            KeyboardInterrupt: a signal was received while the loop was being created.
        """
        self._is_creating_loop = True
        return run_coroutine(create_coroutine, self._handle_loop_created)

    def _handle_loop_created(self) -> None:
        self._is_creating_loop = False
        if self.received is not None:
            raise KeyboardInterrupt

    def _handle(self, signal_number: int, _: FrameType | None) -> None:
        now = time.monotonic()
        session, ends_now = self.session, False
        if self.received is not None:
            if now - self._last_signal_time <= _SAME_KEYPRESS_S:
                return
            ends_now = self._is_hurried or session is None or session.loop is None
            self._is_hurried = True
        self.received, self._last_signal_time = self.received or signal_number, now
        self._schedule_end(0.0 if ends_now else _DEADLINE_S)
        if ends_now or self._is_creating_loop:
            return
        if session is None or session.loop is None:
            raise KeyboardInterrupt
        session.loop.call_soon_threadsafe(self._extend_deadline, session)
        if session.is_blocking:
            raise KeyboardInterrupt
        session.loop.call_soon_threadsafe(session.interrupt, format_interruption(signal_number))

    def _extend_deadline(self, session: Session) -> None:
        """Extend the deadline by the time that processes may take to end.

        This is called when the event loop is responsive.
        """
        if not self._is_hurried:
            self._schedule_end(_DEADLINE_S + session.seconds_to_end())

    def _schedule_end(self, seconds: float) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
        self._deadline = threading.Timer(seconds, self._end_immediately)
        self._deadline.daemon = True
        self._deadline.start()

    def _resend_signal(self) -> None:
        """Send the signal again after its KeyboardInterrupt was lost.

        The state before the signal is restored first.
        """
        signal_number, self.received = self.received, None
        if self._deadline is not None:
            self._deadline.cancel()
        if signal_number is not None:
            resend_signal(signal_number)

    def _end_immediately(self) -> None:
        """End the process from another thread.

        The main thread may be blocked, or may be writing files that must be completed.
        """
        if self.session is not None:
            self.session.kill_all()
        finish_all()
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
        os._exit(self.exit_status or 1)


def format_interruption(signal_number: int) -> str:
    """Return the line that the log shows for a signal."""
    if signal_number == signal.SIGINT:
        return "user interrupted with ctrl-c (SIGINT)"
    return f"received signal {signal.Signals(signal_number).name}"


def run_to_end(run: Callable[[SignalWatch], bool], finder: PackageFinder, log: LaunchLog) -> int:
    """Run a program, and end it in order after a signal.

    Args:
        run: runs the program with the signal handlers, and returns whether it succeeded.
        finder: the finder of ROS packages during the run.
        log: the log for signals that arrive before there is a session.

    Returns:
        The exit status: 0 if the program succeeded, 1 if not, or 128 plus the number of a received signal.
    """
    with SignalWatch() as signals:
        try:
            with own_environment(finder):
                succeeded = run(signals)
        except KeyboardInterrupt:
            if signals.received is None:  # raised in another thread, or by the user's own code
                raise
            log.write_warning("launch", format_interruption(signals.received))
            succeeded = False
        if signals.exit_status is not None:
            return signals.exit_status
        return 0 if succeeded else 1


@contextmanager
def own_environment(finder: PackageFinder) -> Iterator[None]:
    """Use a package finder in a ``with`` block, and set ``AMENT_PREFIX_PATH`` to its prefixes.

    Changes to this process's environment are undone at the end of the block.
    """
    saved_environment = dict(os.environ)
    try:
        with use_finder(finder):
            finder.set_prefix_path(os.environ)
            yield
    finally:
        for name in [name for name in os.environ if name not in saved_environment]:
            del os.environ[name]
        os.environ.update(saved_environment)
