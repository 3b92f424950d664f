"""Futures (rclpy ``Future``), and detection of callbacks that would wait forever.

In rclpy the response to a request is processed in the callback group of the client. While one callback of a mutually
exclusive group runs, no other callback of the group runs, so a callback that blocks until the response arrives blocks
forever. Here, a response runs no user code and is processed in any case. Such a wait is logged as an error, so that it
is found before the program runs on a robot. If the node's parameter `STRICT_GROUPS_PARAMETER` is set, the callback
hangs as in rclpy.
"""

from __future__ import annotations

import asyncio
import os
import sys
import threading
from collections.abc import Callable, Generator, Iterator
from contextlib import suppress
from pathlib import Path
from types import CodeType, FrameType
from typing import Any, Generic, Protocol, TypeVar

from linkwright.graph.loop.node_handle import MutuallyExclusiveCallbackGroup

STRICT_GROUPS_PARAMETER = "strict_callback_groups"
"""The parameter that makes responses wait for the callback group of their client, as in rclpy."""

RUNNING_ENTITY_VARIABLE = "running_entity"
"""The name of the local variable with the entity in a function that runs the entity's callback."""

_PACKAGE_FOLDER = str(Path(__file__).parents[2]) + os.sep
_reported_waits: set[tuple[CodeType, str]] = set()


class WaitableFuture(Protocol):
    """The part of a future that the detection needs.

    Attributes:
        source: the client whose response the future waits for; None for any other future.
    """

    source: Any

    def ended(self) -> bool:
        """Return whether the future is done or cancelled."""


def report_self_wait(future: WaitableFuture) -> None:
    """Log an error if the calling thread is in a callback that would wait forever in rclpy.

    Each call site is reported once.

    Args:
        future: the future to wait for.
    """
    client = future.source
    if client is None or future.ended():
        return
    group = client.callback_group
    if not isinstance(group, MutuallyExclusiveCallbackGroup) or group.can_execute(client):
        return  # no callback of the group is running
    frames = list(_walk_frames(sys._getframe(1)))
    callback_frame = next((frame for frame in frames if _find_running_entity(frame) is not None), None)
    if callback_frame is None or _find_running_entity(callback_frame).callback_group is not group:
        return
    user_frames = [
        frame
        for frame in frames[: frames.index(callback_frame)]
        if not frame.f_code.co_filename.startswith(_PACKAGE_FOLDER)
    ]
    if not user_frames:
        return
    waiting_frame, callback = user_frames[0], user_frames[-1].f_code
    location = f"{waiting_frame.f_code.co_filename}:{waiting_frame.f_lineno}"
    if (callback, location) in _reported_waits:
        return
    _reported_waits.add((callback, location))
    client.node.logger.error(
        f"callback '{callback.co_name}' ({callback.co_filename}:{callback.co_firstlineno}) waits at {location} for the "
        f"{client.description}, which is in the same mutually exclusive callback group: on a robot it waits forever. "
        "Give the client a callback group of its own and use a MultiThreadedExecutor, or continue in a done "
        "callback of call_async()"
    )


def _find_running_entity(frame: FrameType) -> Any:
    """Return the entity whose callback an executor's frame runs, or None for any other frame."""
    return frame.f_locals.get(RUNNING_ENTITY_VARIABLE) if RUNNING_ENTITY_VARIABLE in frame.f_code.co_varnames else None


def _walk_frames(frame: FrameType | None) -> Iterator[FrameType]:
    while frame is not None:
        yield frame
        frame = frame.f_back


T = TypeVar("T")

_step_context = threading.local()


def is_stepped_by_executor() -> bool:
    """Return whether the calling thread is inside `StepsByExecutor`."""
    return bool(getattr(_step_context, "depth", 0))


class StepsByExecutor:
    """A context in which an executor, not asyncio, steps the coroutines of this thread.

    A coroutine that awaits a future then yields the future to the executor, even inside a running event loop.
    """

    def __enter__(self) -> None:
        _step_context.depth = getattr(_step_context, "depth", 0) + 1

    def __exit__(self, *_: object) -> None:
        _step_context.depth -= 1


class Future(Generic[T]):
    """The result of an operation that may not have ended yet.

    Coroutines of asyncio and of an executor can await the future.

    Args:
        executor: runs the done callbacks (through ``create_task(callback, future)``). Without an executor they are
            called immediately, in the thread that completes the future.
    """

    def __init__(self, *, executor: Any = None) -> None:
        self._done = False
        self._cancelled = False
        self._result: T | None = None
        self._exception: BaseException | None = None
        self._exception_fetched = False
        self._callbacks: list[Callable[[Any], object]] = []
        self._waiters: list[Callable[[], object]] = []
        self._executor = executor
        self._lock = threading.Lock()
        self.source: Any = None
        """The client whose response the future waits for, or None for any other future."""

    def __del__(self) -> None:
        if self._exception is not None and not self._exception_fetched:
            print(f"The following exception was never retrieved: {self._exception}", file=sys.stderr)

    def done(self) -> bool:
        """Return whether the future has a result or an exception.

        As in rclpy, a cancelled future is not done.
        """
        return self._done

    def ended(self) -> bool:
        """Return whether the future is done or cancelled."""
        return self._done or self._cancelled

    def cancelled(self) -> bool:
        """Return whether the future was cancelled."""
        return self._cancelled

    def cancel(self) -> None:
        """Cancel the future, call its done callbacks, and end all waits.

        Does nothing if the future is done.
        """
        with self._lock:
            if self._done or self._cancelled:
                return
            self._cancelled = True
        self._notify()

    def result(self) -> T | None:
        """Return the result, or None while the future has none.

        Raises:
            Exception: the exception that the future was completed with.
        """
        if self._exception is not None:
            self._exception_fetched = True
            raise self._exception
        return self._result

    def exception(self) -> BaseException | None:
        """Return the exception that the future was completed with, or None if there is none."""
        self._exception_fetched = True
        return self._exception

    def set_result(self, result: T) -> None:
        """Complete the future with a result."""
        with self._lock:
            self._result = result
            self._done = True
            self._cancelled = False
        self._notify()

    def set_exception(self, exception: BaseException) -> None:
        """Complete the future with an exception."""
        with self._lock:
            self._exception = exception
            self._exception_fetched = False
            self._done = True
            self._cancelled = False
        self._notify()

    def add_done_callback(self, callback: Callable[[Any], object]) -> None:
        """Register a callback that receives this future when the future is done or cancelled.

        If that has already happened, the callback is called immediately.
        """
        with self._lock:
            if not self.ended():
                self._callbacks.append(callback)
                return
        self._call(callback)

    def remove_done_callback(self, callback: Callable[[Any], object]) -> int:
        """Unregister a callback, and return how many times it was registered."""
        with self._lock:
            remaining_callbacks = [registered for registered in self._callbacks if registered != callback]
            removed_count = len(self._callbacks) - len(remaining_callbacks)
            self._callbacks = remaining_callbacks
        return removed_count

    def set_executor(self, executor: Any) -> None:
        """Set the executor that runs the done callbacks."""
        self._executor = executor

    def hand_over(self, result: T, dispatcher: Any) -> None:
        """Complete the future with a result, unless the future is done or cancelled.

        Args:
            result: the result.
            dispatcher: the dispatcher of the waiting node; if this is an executor, it runs the done callbacks.
        """
        if not self.ended():
            self._run_callbacks_by(dispatcher)
            self.set_result(result)

    def fail(self, exception: BaseException, dispatcher: Any) -> None:
        """Complete the future with an exception, unless the future is done or cancelled.

        See `hand_over`.
        """
        if not self.ended():
            self._run_callbacks_by(dispatcher)
            self.set_exception(exception)

    def _run_callbacks_by(self, dispatcher: Any) -> None:
        if hasattr(dispatcher, "create_task"):
            self.set_executor(dispatcher)

    def add_waiter(self, callback: Callable[[], object]) -> None:
        """Register a callback that is called as soon as the future is done or cancelled.

        The callback runs in the thread that completes or cancels the future. Waiters are for code that runs coroutines.
        Registering the same callback twice has no effect.
        """
        with self._lock:
            if not self.ended():
                if callback not in self._waiters:
                    self._waiters.append(callback)
                return
        callback()

    def remove_waiter(self, callback: Callable[[], object]) -> None:
        """Unregister a callback that was registered with `add_waiter`."""
        with self._lock, suppress(ValueError):
            self._waiters.remove(callback)

    def wait(self, timeout_sec: float | None = None) -> bool:
        """Block the calling thread until the future is done or cancelled.

        Args:
            timeout_sec: the maximum wait, in seconds; None for no limit.

        Returns:
            Whether the future is done or cancelled.
        """
        if self.source is not None:
            report_self_wait(self)
        event = threading.Event()
        self.add_waiter(event.set)
        event.wait(timeout_sec)
        self.remove_waiter(event.set)
        return self.ended()

    def __await__(self) -> Generator[Any, None, T | None]:
        loop = None if getattr(_step_context, "depth", 0) else asyncio._get_running_loop()
        if loop is None:
            while not self.ended():
                yield self
        elif not self.ended():
            yield from self._wait_on(loop)
        return self.result()

    def _wait_on(self, loop: asyncio.AbstractEventLoop) -> Generator[Any, None, None]:
        completion = loop.create_future()

        def set_ready() -> None:
            if not completion.done():
                completion.set_result(None)

        def wake() -> None:
            with suppress(RuntimeError):  # the loop is closed
                loop.call_soon_threadsafe(set_ready)

        self.add_waiter(wake)
        try:
            yield from completion.__await__()
        finally:
            self.remove_waiter(wake)

    def _notify(self) -> None:
        with self._lock:
            waiters, self._waiters = self._waiters, []
            callbacks, self._callbacks = self._callbacks, []
        for waiter in waiters:
            waiter()
        for callback in callbacks:
            self._call(callback)

    def _call(self, callback: Callable[[Any], object]) -> None:
        if self._executor is not None:
            self._executor.create_task(callback, self)
        else:
            callback(self)
