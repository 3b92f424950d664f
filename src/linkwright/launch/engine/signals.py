"""Ctrl-C and other signals: the first ends a launch in order, the second hurries, the third ends it at once.

`AsyncSafeSignalManager` is for programs of users (``launch.utilities.signal_management``).
"""

from __future__ import annotations

import asyncio
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Coroutine
from types import FrameType, TracebackType
from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.event_loop import run_coroutine
from linkwright.interruption import when_lost
from linkwright.launch.engine.session import LaunchSession

if TYPE_CHECKING:
    from typing_extensions import Self


T = TypeVar("T")

_DEADLINE_SECONDS = 1.9
"""However badly something hangs: this long after a signal the program is over, or, after the first one, its event loop
gives the processes the time that they have."""
_SAME_KEYPRESS_SECONDS = 0.3
"""Signals this close count as one: a wrapper may pass a terminal's Ctrl-C on."""

_SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))


class SignalWatch:
    """Handles signals inside a ``with`` block; only the main thread can, elsewhere it does nothing.

    Attributes:
        session: the launch to be ended; None before there is one, when a KeyboardInterrupt is raised instead.
        received: the first signal that came, or None.
    """

    def __init__(self) -> None:
        self.session: LaunchSession | None = None
        self.received: int | None = None
        self._received_at = 0.0
        self._hurried = False
        self._is_making_loop = False
        self._before: dict[int, Any] = {}
        self._unraisable: Callable[[Any], Any] | None = None
        self._deadline: threading.Timer | None = None

    @property
    def exit_status(self) -> int | None:
        """The exit status that the signal asks for, as shells count: 128 and its number."""
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
        """Run a coroutine on a loop of its own.

        Raises:
            KeyboardInterrupt: a signal came while the loop was made.
        """
        self._is_making_loop = True
        return run_coroutine(make, self._loop_is_made)

    def _loop_is_made(self) -> None:
        self._is_making_loop = False
        if self.received is not None:
            raise KeyboardInterrupt

    def _handle(self, number: int, _: FrameType | None) -> None:
        now = time.monotonic()
        session = self.session
        if self.received is not None:
            if now - self._received_at <= _SAME_KEYPRESS_SECONDS:
                return
            if self._hurried or session is None or session.loop is None:
                self._end_at_once()
            self._hurried = True
        self.received, self._received_at = self.received or number, now
        self._end_after(_DEADLINE_SECONDS)
        if self._is_making_loop:
            return
        if session is None or session.loop is None:
            raise KeyboardInterrupt
        session.loop.call_soon_threadsafe(self._loop_runs, session)
        if session.visiting:
            raise KeyboardInterrupt
        session.loop.call_soon_threadsafe(session.interrupt, interruption_text(number))

    def _loop_runs(self, session: LaunchSession) -> None:
        """The event loop does not hang: it may take as long as the processes may."""
        if not self._hurried:
            self._end_after(_DEADLINE_SECONDS + session.processes.seconds_to_end())

    def _end_after(self, seconds: float) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
        self._deadline = threading.Timer(seconds, self._end_at_once)
        self._deadline.daemon = True
        self._deadline.start()

    def _handle_again(self) -> None:
        """The KeyboardInterrupt raised for a signal was lost: restore the earlier state and send the signal again."""
        number, self.received = self.received, None
        if self._deadline is not None:
            self._deadline.cancel()
        if number is not None:
            os.kill(os.getpid(), number)

    def _end_at_once(self) -> None:
        if self.session is not None:
            self.session.processes.kill_all()
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
        os._exit(self.exit_status or 1)


def interruption_text(number: int) -> str:
    """What the log says of a signal."""
    if number == signal.SIGINT:
        return "user interrupted with ctrl-c (SIGINT)"
    return f"received signal {signal.Signals(number).name}"


class AsyncSafeSignalManager:
    """Runs signal handlers on an event loop inside a ``with`` block, in the main thread; blocks may be nested.

    Args:
        loop: calls the handlers.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._handlers: dict[int, Callable[[int], object]] = {}
        self._before: dict[int, Any] = {}
        self._entered = False

    def __enter__(self) -> Self:
        self._entered = True
        for number in self._handlers:
            self._take_over(number)
        return self

    def __exit__(self, *_: object) -> None:
        self._entered = False
        for number in tuple(self._before):
            self._give_back(number)

    def handle(self, signum: int, handler: Callable[[int], object] | None) -> Callable[[int], object] | None:
        """Set the handler of a signal, which is called with the signal's number; None removes it.

        Returns:
            What handled the signal before; None for nothing.

        Raises:
            ValueError: there is no such signal.
        """
        number = signal.Signals(signum)
        previous = self._handlers.pop(number, None)
        if handler is not None:
            self._handlers[number] = handler
        if self._entered and handler is not None:
            self._take_over(number)
        elif self._entered:
            self._give_back(number)
        return previous

    def _take_over(self, number: int) -> None:
        if number not in self._before:
            self._before[number] = signal.signal(number, self._came)

    def _give_back(self, number: int) -> None:
        if number in self._before:
            before = self._before.pop(number)
            signal.signal(number, signal.SIG_DFL if before is None else before)

    def _came(self, number: int, _: FrameType | None) -> None:
        handler = self._handlers.get(number)
        if handler is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(handler, number)
