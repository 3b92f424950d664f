"""Tasks: callables or coroutines that an executor runs step by step (rclpy ``task.Task``)."""

from __future__ import annotations

import threading
from collections.abc import Callable, Coroutine, Generator, Mapping, Sequence
from types import CoroutineType
from typing import Any, Protocol, TypeVar

from linkwright.graph.loop.future import Future, StepsByExecutor, is_stepped_by_executor

T = TypeVar("T")


class TaskRunner(Protocol):
    """The part of an executor that its tasks need."""

    def create_task(self, callback: Callable[..., Any], *args: Any) -> Any:
        """Run a callable after the work that is already ready."""

    def run_again(self, task: Task[Any]) -> None:
        """Queue a task to run up to its next await."""


class Task(Future[T]):
    """The future result of a callable or a coroutine.

    Calling the task runs the callable, or the coroutine up to its next ``await``. As soon as the awaited future is
    done, the task is queued in its executor again.

    Args:
        handler: a callable, a coroutine function or a coroutine.
        args: positional arguments for `handler`.
        kwargs: keyword arguments for `handler`.
        executor: the executor that runs the task and its done callbacks.
        on_end: called once when nothing is left to run, whether the task finished, failed or was cancelled.
    """

    def __init__(
        self,
        handler: Callable[..., Any] | Coroutine[Any, Any, T],
        args: Sequence[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        executor: TaskRunner | None = None,
        *,
        on_end: Callable[[], None] | None = None,
    ) -> None:
        super().__init__(executor=executor)
        self._executor = executor
        self._on_end = on_end
        self._coroutine: Coroutine[Any, Any, T] | None = None
        self._function: Callable[..., Any] | None = None
        if callable(handler):
            self._function = handler
        else:
            self._coroutine = handler
        self._arguments = tuple(args or ())
        self._keywords = dict(kwargs or {})
        self._run_lock = threading.Lock()

    def __call__(self) -> None:
        """Run until the next await, or to the end.

        Does nothing while another thread runs the task, or once it has ended.
        """
        if self.ended() or not self._run_lock.acquire(blocking=False):
            return
        try:
            awaited = self._run_step()
        finally:
            self._run_lock.release()
        if self._coroutine is not None:
            self._wait_for(awaited)

    def executing(self) -> bool:
        """Return whether a thread is currently running the task."""
        return self._run_lock.locked()

    def cancel(self) -> None:
        """Cancel the task.

        A coroutine is closed at its current await, unless it is running now.
        """
        super().cancel()
        if self.cancelled() and self._run_lock.acquire(blocking=False):
            try:
                if self._coroutine is not None:
                    self._coroutine.close()
                self._finish()
            finally:
                self._run_lock.release()

    def __await__(self) -> Generator[Any, None, T | None]:
        if is_stepped_by_executor():
            # Yield even if the other task is done, so that tasks that await each other alternate.
            yield self
        return (yield from super().__await__())

    def _run_step(self) -> object:
        try:
            if self._function is not None:
                function, self._function = self._function, None
                result = function(*self._arguments, **self._keywords)
                if not isinstance(result, CoroutineType):
                    self.set_result(result)
                    self._finish()
                    return None
                self._coroutine = result
            assert self._coroutine is not None
            with StepsByExecutor():
                return self._coroutine.send(None)
        except StopIteration as stop:
            self.set_result(stop.value)
        except Exception as error:  # noqa: BLE001  # the executor raises it from spin
            self.set_exception(error)
        except BaseException:
            self._finish()
            raise
        self._finish()
        return None

    def _wait_for(self, awaited: object) -> None:
        if self._executor is None:
            return
        if isinstance(awaited, Future):
            awaited.add_waiter(self._resume)
        else:
            self._resume()

    def _resume(self) -> None:
        if self._executor is not None:
            self._executor.run_again(self)

    def _finish(self) -> None:
        self._coroutine = None
        self._arguments, self._keywords = (), {}
        on_end, self._on_end = self._on_end, None
        if on_end is not None:
            on_end()
