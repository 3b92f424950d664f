"""Run a coroutine as Python 3.11's ``asyncio.run`` does, with a callback before it.

The callback is called when the loop exists, because interrupting the creation of a loop prints an error. Ctrl-C cancels
the coroutine. If Ctrl-C raised KeyboardInterrupt at any other point, it could abort an import. On Python 3.10, the
import lock would then remain locked for other threads that import the same module.
"""

from __future__ import annotations

import asyncio
import signal
import sys
import threading
from collections.abc import Callable, Coroutine
from typing import Any, TypeVar

T = TypeVar("T")


def run_coroutine(create_coroutine: Callable[[], Coroutine[Any, Any, T]], on_ready: Callable[[], object]) -> T:
    """Run a coroutine on a new event loop, and return its result.

    Args:
        create_coroutine: returns the coroutine.
        on_ready: called when the loop exists, before the coroutine starts. From then on, KeyboardInterrupt may be
            raised.

    Raises:
        KeyboardInterrupt: the user pressed Ctrl-C, which cancelled the coroutine.
    """
    if sys.version_info >= (3, 11):
        with asyncio.Runner() as runner:
            runner.get_loop()
            on_ready()
            return runner.run(create_coroutine())
    else:
        return _run(create_coroutine, on_ready)


def _run(create_coroutine: Callable[[], Coroutine[Any, Any, T]], on_ready: Callable[[], object]) -> T:
    """Run a coroutine like `asyncio.Runner`, which Python 3.10 does not have."""
    loop = asyncio.new_event_loop()
    try:
        asyncio.set_event_loop(loop)
        on_ready()
        task = loop.create_task(create_coroutine())
        interruptions = _CancelOnInterrupt(loop, task)
        with interruptions:
            try:
                return loop.run_until_complete(task)
            except asyncio.CancelledError:
                if interruptions.count:
                    raise KeyboardInterrupt from None
                raise
    finally:
        try:
            _cancel_remaining(loop)
            loop.run_until_complete(loop.shutdown_asyncgens())
            loop.run_until_complete(loop.shutdown_default_executor())
        finally:
            asyncio.set_event_loop(None)
            loop.close()


class _CancelOnInterrupt:
    """A context in which Ctrl-C cancels a task.

    Each later Ctrl-C raises KeyboardInterrupt.

    The context has no effect outside of the main thread, or if SIGINT has another handler.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop, task: asyncio.Task[Any]) -> None:
        self.count = 0
        self._loop = loop
        self._task = task

    def __enter__(self) -> None:
        self._is_installed = (
            threading.current_thread() is threading.main_thread()
            and signal.getsignal(signal.SIGINT) is signal.default_int_handler
        )
        if self._is_installed:
            signal.signal(signal.SIGINT, self._handle)

    def __exit__(self, *_: object) -> None:
        if self._is_installed and signal.getsignal(signal.SIGINT) == self._handle:
            signal.signal(signal.SIGINT, signal.default_int_handler)

    def _handle(self, _number: int, _frame: object) -> None:
        self.count += 1
        if self.count > 1 or self._task.done():
            raise KeyboardInterrupt
        self._task.cancel()
        self._loop.call_soon_threadsafe(lambda: None)  # wake the loop, which may be waiting only for files


def _cancel_remaining(loop: asyncio.AbstractEventLoop) -> None:
    remaining_tasks = asyncio.all_tasks(loop)
    for task in remaining_tasks:
        task.cancel()
    if remaining_tasks:
        loop.run_until_complete(asyncio.gather(*remaining_tasks, return_exceptions=True))
    for task in remaining_tasks:
        if not task.cancelled() and task.exception() is not None:
            loop.call_exception_handler({"message": "a task failed while the loop ended", "task": task})
