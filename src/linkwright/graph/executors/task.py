"""Tasks: a callable or a coroutine that an executor runs to its end, step by step (rclpy ``task.Task``)."""

from __future__ import annotations

import threading
from collections.abc import Callable, Coroutine, Generator, Mapping, Sequence
from types import CoroutineType
from typing import Any, Protocol, TypeVar

from linkwright.graph.loop.future import Future, StepsByExecutor, is_stepped_by_executor

T = TypeVar("T")


class TaskRunner(Protocol):
    """An executor, as its tasks know it."""

    def create_task(self, callback: Callable[..., Any], *args: Any) -> Any:
        """Run a callable after the work that is ready by now."""

    def run_again(self, task: Task[Any]) -> None:
        """Give a task its next turn."""


class Task(Future[T]):
    """The future result of a callable or a coroutine.

    Calling the task runs the callable, or the coroutine up to its next ``await``. With an executor the task asks it for
    its next turn as soon as the awaited future is done.

    Args:
        handler: a callable, a coroutine function or a coroutine.
        args: positional arguments for it.
        kwargs: keyword arguments for it.
        executor: the executor that runs the task and its done callbacks.
        ended: called once when there is nothing left to run, whether it ended, failed or was cancelled.
    """

    def __init__(
        self,
        handler: Callable[..., Any] | Coroutine[Any, Any, T],
        args: Sequence[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        executor: TaskRunner | None = None,
        *,
        ended: Callable[[], None] | None = None,
    ) -> None:
        super().__init__(executor=executor)
        self._runner = executor
        self._ended = ended
        self._steps: Coroutine[Any, Any, T] | None = None
        self._function: Callable[..., Any] | None = None
        if callable(handler):
            self._function = handler
        else:
            self._steps = handler
        self._arguments = tuple(args or ())
        self._keywords = dict(kwargs or {})
        self._turn = threading.Lock()

    def __call__(self) -> None:
        """Run until the next await, or to the end. Does nothing while another thread is at it, or afterwards."""
        if self.ended() or not self._turn.acquire(blocking=False):
            return
        try:
            awaited = self._run_step()
        finally:
            self._turn.release()
        if self._steps is not None:
            self._wait_for(awaited)

    def executing(self) -> bool:
        """Whether a thread runs the task right now."""
        return self._turn.locked()

    def cancel(self) -> None:
        """Stop: a coroutine is closed at its present await, unless it runs right now."""
        super().cancel()
        if self.cancelled() and self._turn.acquire(blocking=False):
            try:
                if self._steps is not None:
                    self._steps.close()
                self._finish()
            finally:
                self._turn.release()

    def __await__(self) -> Generator[Any, None, T | None]:
        if is_stepped_by_executor():
            # Tasks that await each other take turns even where the other is done.
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
                self._steps = result
            assert self._steps is not None
            with StepsByExecutor():
                return self._steps.send(None)
        except StopIteration as end:
            self.set_result(end.value)
        except Exception as error:  # noqa: BLE001  # the executor raises it from spin
            self.set_exception(error)
        except BaseException:
            self._finish()
            raise
        self._finish()
        return None

    def _wait_for(self, awaited: object) -> None:
        if self._runner is None:
            return
        if isinstance(awaited, Future):
            awaited.add_waiter(self._resume)
        else:
            self._resume()

    def _resume(self) -> None:
        if self._runner is not None:
            self._runner.run_again(self)

    def _finish(self) -> None:
        self._steps = None
        self._arguments, self._keywords = (), {}
        ended, self._ended = self._ended, None
        if ended is not None:
            ended()
