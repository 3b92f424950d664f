"""Event loops that skip their waits.

A test of some seconds takes milliseconds, also on a busy machine.

The time of such a loop advances to the next due call, and only if no work is left. Work takes no time, however slow the
machine is, so rates, delays and order are the same in each run. Code that reads the computer's clock
(``time.monotonic``) does not see this time; a graph sees it if it has a `LoopClock`.
"""

from __future__ import annotations

import asyncio
import functools
import selectors
import time
from collections.abc import Callable, Coroutine
from typing import Any, TypeVar

from linkwright.graph import SystemClock, Timebase

_LOOK_S = 0.0005
"""The seconds to wait for sockets and other threads before time advances."""
_STEP_S = 0.02
"""The maximum seconds per advance, so that data that arrives after `_LOOK_S` does not meet a timeout."""

T = TypeVar("T")


class _SkippingSelector(selectors.DefaultSelector):  # type: ignore[misc, valid-type]
    """A selector that returns ready events, and advances the loop's time instead of waiting."""

    def __init__(self) -> None:
        super().__init__()
        self.passed = 0.0
        self.working = 0
        """The number of calls in other threads; the loop waits in real time for them."""

    def select(self, timeout: float | None = None) -> Any:
        if timeout is None or timeout <= 0 or self.working:
            return super().select(timeout)
        ready = super().select(_LOOK_S)
        if not ready:
            self.passed += min(timeout, _STEP_S)
        return ready


class SkippingLoop(asyncio.SelectorEventLoop):
    """An event loop that skips its waits."""

    def __init__(self) -> None:
        self._skipping = _SkippingSelector()
        super().__init__(self._skipping)

    def time(self) -> float:
        """Return the loop's time in seconds, which starts at 1000."""
        return 1000.0 + self._skipping.passed

    def run_in_executor(self, executor: Any, func: Callable[..., Any], *args: Any) -> asyncio.Future[Any]:
        """Run a function in another thread; no time is skipped meanwhile."""
        future = super().run_in_executor(executor, func, *args)
        self._skipping.working += 1
        future.add_done_callback(self._worked)
        return future

    def _worked(self, _future: asyncio.Future[Any]) -> None:
        self._skipping.working -= 1


class LoopClock(Timebase):
    """The time of the event loop, for the graph on it.

    Each reading of the time of day is a microsecond later.
    """

    def __init__(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._begin_ns = time.time_ns() - self.steady_ns()

    def now_ns(self) -> int:
        """Return the nanoseconds since the epoch."""
        self._begin_ns += 1000
        return self._begin_ns + self.steady_ns()

    def steady_ns(self) -> int:
        """Return the loop's time in nanoseconds."""
        return round(self._loop.time() * 1e9)

    def call_at(self, loop: asyncio.AbstractEventLoop, steady_ns: int, callback: Callable[[], None]) -> Any:
        """Call a function once on the loop."""
        return loop.call_at(steady_ns / 1e9, callback)


def graph_clock() -> Timebase:
    """Return the clock for a graph on the running loop: the loop's own if it skips its waits."""
    return LoopClock() if isinstance(asyncio.get_running_loop(), SkippingLoop) else SystemClock()


def skipping(test: Callable[..., Coroutine[Any, Any, T]]) -> Callable[..., T]:
    """Run a test that is a coroutine on a loop that skips its waits.

    Its fixtures must not be coroutines.
    """

    @functools.wraps(test)
    def run(*arguments: Any, **named: Any) -> T:
        loop = SkippingLoop()
        asyncio.set_event_loop(loop)
        try:
            return loop.run_until_complete(test(*arguments, **named))
        finally:
            loop.run_until_complete(loop.shutdown_asyncgens())
            loop.run_until_complete(loop.shutdown_default_executor())
            asyncio.set_event_loop(None)
            loop.close()

    return run
