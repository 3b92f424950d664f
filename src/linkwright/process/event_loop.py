"""Runs a coroutine as ``asyncio.run`` does since Python 3.11, with a hook before it starts.

The hook is called after the loop is created, because a loop that is interrupted during its creation prints an error.
Ctrl-C cancels the coroutine. If KeyboardInterrupt were raised anywhere else, it could abort an import, and on Python
3.10 the import lock would remain locked for other threads that import the same module.
"""

from __future__ import annotations

import asyncio
import signal
import sys
import threading
from collections.abc import Callable, Coroutine
from typing import Any, TypeVar

T = TypeVar("T")


def run_coroutine(make: Callable[[], Coroutine[Any, Any, T]], ready: Callable[[], object]) -> T:
    """Run a coroutine on a new event loop, and return its result.

    Args:
        make: returns the coroutine.
        ready: called after the loop is created and before the coroutine starts; from then on KeyboardInterrupt may be
            raised.

    Raises:
        KeyboardInterrupt: Ctrl-C was pressed, and the coroutine was cancelled.
    """
    if sys.version_info >= (3, 11):
        with asyncio.Runner() as runner:
            runner.get_loop()
            ready()
            return runner.run(make())
    else:
        return _run(make, ready)


def _run(make: Callable[[], Coroutine[Any, Any, T]], ready: Callable[[], object]) -> T:
    """Run a coroutine as `asyncio.Runner` does, which Python 3.10 lacks."""
    loop = asyncio.new_event_loop()
    try:
        asyncio.set_event_loop(loop)
        ready()
        main = loop.create_task(make())
        interruptions = _Interruptions(loop, main)
        with interruptions:
            try:
                return loop.run_until_complete(main)
            except asyncio.CancelledError:
                if interruptions.count:
                    raise KeyboardInterrupt from None
                raise
    finally:
        try:
            _cancel_the_rest(loop)
            loop.run_until_complete(loop.shutdown_asyncgens())
            loop.run_until_complete(loop.shutdown_default_executor())
        finally:
            asyncio.set_event_loop(None)
            loop.close()


class _Interruptions:
    """A context in which the first Ctrl-C cancels a task; later ones raise KeyboardInterrupt.

    The context has no effect if SIGINT has another handler, or in a thread other than the main thread.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop, main: asyncio.Task[Any]) -> None:
        self.count = 0
        self._loop = loop
        self._main = main

    def __enter__(self) -> None:
        self._is_ours = (
            threading.current_thread() is threading.main_thread()
            and signal.getsignal(signal.SIGINT) is signal.default_int_handler
        )
        if self._is_ours:
            signal.signal(signal.SIGINT, self._handle)

    def __exit__(self, *_: object) -> None:
        if self._is_ours and signal.getsignal(signal.SIGINT) == self._handle:
            signal.signal(signal.SIGINT, signal.default_int_handler)

    def _handle(self, _number: int, _frame: object) -> None:
        self.count += 1
        if self.count > 1 or self._main.done():
            raise KeyboardInterrupt
        self._main.cancel()
        self._loop.call_soon_threadsafe(lambda: None)  # wake the loop, which may be waiting only for files


def _cancel_the_rest(loop: asyncio.AbstractEventLoop) -> None:
    rest = asyncio.all_tasks(loop)
    for task in rest:
        task.cancel()
    if rest:
        loop.run_until_complete(asyncio.gather(*rest, return_exceptions=True))
    for task in rest:
        if not task.cancelled() and task.exception() is not None:
            loop.call_exception_handler({"message": "a task failed while the loop ended", "task": task})
