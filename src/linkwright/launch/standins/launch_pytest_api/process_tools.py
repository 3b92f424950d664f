"""Functions that wait for output or exits of processes (``launch_pytest.tools.process``).

The arguments of each function are the launch's context, the action that runs the process, and a timeout in seconds, or
None to wait without limit. The coroutines are for tests that run on the launch's event loop. The functions whose names
end in ``_sync`` are for tests that run in another thread. As in ROS, a start or an exit before the call does not count:
the functions wait for the next start or exit. Output is available only for actions with ``cached_output=True``.
"""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any, ParamSpec

from linkwright.launch.model.actions.execute import ExecuteLocal
from linkwright.launch.model.context import Handler, LaunchContext
from linkwright.launch.model.process_event_handlers import OnProcessExit, OnProcessIO, OnProcessStart

Validate = Callable[[str], Any]
"""A function that validates a text.

It returns a false value or raises AssertionError if the text is wrong.
"""

Reaction = Callable[..., None]
_P = ParamSpec("_P")


class _Wait:
    """A wait until an event occurs or a condition holds.

    Args:
        context: the context of the launch.
        create_handler: returns an event handler that calls the given function.
        timeout: the timeout in seconds; None to wait without limit.
        condition: the condition that must hold now or after an event; None if the first event ends the wait.
        on_timeout: called if the wait times out.
    """

    def __init__(
        self,
        context: LaunchContext,
        create_handler: Callable[[Reaction], Handler],
        timeout: float | None,
        condition: Callable[[], Any] | None = None,
        on_timeout: Callable[[], object] = lambda: None,
    ) -> None:
        self._context = context
        self._create_handler = create_handler
        self._timeout = timeout
        self._condition = condition
        self._on_timeout = on_timeout
        self._has_occurred = False

    async def run(self) -> Any:
        """Wait on the launch's event loop, and return the last value of the condition.

        Without a condition, return whether an event occurred.
        """
        event = asyncio.Event()
        with self._listening(event.set):
            value = self._evaluate_condition()
            deadline = self._compute_deadline()
            while not value:
                try:
                    await asyncio.wait_for(event.wait(), _compute_remaining_seconds(deadline))
                except asyncio.TimeoutError:
                    self._on_timeout()
                    break
                event.clear()
                value = self._evaluate_condition()
        return value

    def run_sync(self) -> Any:
        """Wait in a thread other than the event loop's, and return the last value of the condition.

        Without a condition, return whether an event occurred.
        """
        event = threading.Event()
        with self._listening(event.set):
            value = self._evaluate_condition()
            deadline = self._compute_deadline()
            while not value:
                if not event.wait(_compute_remaining_seconds(deadline)):
                    self._on_timeout()
                    break
                event.clear()
                value = self._evaluate_condition()
        return value

    def _compute_deadline(self) -> float | None:
        return None if self._timeout is None else time.monotonic() + self._timeout

    def _evaluate_condition(self) -> Any:
        return self._has_occurred if self._condition is None else self._condition()

    @contextmanager
    def _listening(self, notify: Callable[[], None]) -> Iterator[None]:
        """Call `notify` after each event while the context is active."""

        def react(*_: object) -> None:
            self._has_occurred = True
            notify()

        handler = self._create_handler(react)
        self._context.register_event_handler(handler)
        try:
            yield
        finally:
            self._context.unregister_event_handler(handler)


def _compute_remaining_seconds(deadline: float | None) -> float | None:
    """Return the seconds until a deadline on the monotonic clock, at least 0.

    The result is None if there is no deadline.
    """
    return None if deadline is None else max(deadline - time.monotonic(), 0.0)


def _create_wait_functions(
    create_wait: Callable[_P, _Wait],
) -> tuple[Callable[_P, Coroutine[Any, Any, Any]], Callable[_P, Any]]:
    """Return a coroutine function and a plain function that wait as `create_wait` specifies.

    Both have the signature and docstring of `create_wait`.
    """

    @wraps(create_wait)
    async def wait(*args: _P.args, **kwargs: _P.kwargs) -> Any:
        return await create_wait(*args, **kwargs).run()

    @wraps(create_wait)
    def wait_sync(*args: _P.args, **kwargs: _P.kwargs) -> Any:
        return create_wait(*args, **kwargs).run_sync()

    return wait, wait_sync


def _output_wait_factory(stream: str) -> Callable[..., _Wait]:
    def create_wait(
        launch_context: LaunchContext,
        execute_process_action: ExecuteLocal,
        validate_output: Validate,
        timeout: float | None = None,
    ) -> _Wait:
        """Wait until `validate_output` returns a true value for all output so far.

        Return the last value of `validate_output`.
        """
        create_handler, read_output = _create_output_access(execute_process_action, stream)
        return _Wait(launch_context, create_handler, timeout, lambda: validate_output(read_output()))

    return create_wait


def _assertion_wait_factory(stream: str) -> Callable[..., _Wait]:
    def create_wait(
        launch_context: LaunchContext,
        execute_process_action: ExecuteLocal,
        validate_output: Validate,
        timeout: float | None = None,
    ) -> _Wait:
        """Wait until `validate_output` raises no AssertionError for all output so far.

        On a timeout, `validate_output` is called once more, and its AssertionError is raised.
        """
        create_handler, read_output = _create_output_access(execute_process_action, stream)

        def is_valid() -> bool:
            try:
                validate_output(read_output())
            except AssertionError:
                return False
            return True

        return _Wait(launch_context, create_handler, timeout, is_valid, lambda: validate_output(read_output()))

    return create_wait


def _create_start_wait(
    launch_context: LaunchContext, execute_process_action: ExecuteLocal, timeout: float | None = None
) -> _Wait:
    """Wait until the process starts, and return whether it started in time."""

    def create_handler(react: Reaction) -> Handler:
        return OnProcessStart(target_action=execute_process_action, on_start=react)

    return _Wait(launch_context, create_handler, timeout)


def _create_exit_wait(
    launch_context: LaunchContext, execute_process_action: ExecuteLocal, timeout: float | None = None
) -> _Wait:
    """Wait until the process ends, and return whether it ended in time."""

    def create_handler(react: Reaction) -> Handler:
        return OnProcessExit(target_action=execute_process_action, on_exit=react)

    return _Wait(launch_context, create_handler, timeout)


def _create_output_access(action: ExecuteLocal, stream: str) -> tuple[Callable[[Reaction], Handler], Callable[[], str]]:
    """Return a factory of handlers for the output of a process, and a getter of its output.

    `stream` is ``stdout`` or ``stderr``.
    """

    def create_handler(react: Reaction) -> Handler:
        return OnProcessIO(target_action=action, **{f"on_{stream}": react})  # type: ignore[arg-type]  # a keyword name

    return create_handler, getattr(action, f"get_{stream}")


wait_for_output, wait_for_output_sync = _create_wait_functions(_output_wait_factory("stdout"))
wait_for_stderr, wait_for_stderr_sync = _create_wait_functions(_output_wait_factory("stderr"))
assert_output, assert_output_sync = _create_wait_functions(_assertion_wait_factory("stdout"))
assert_stderr, assert_stderr_sync = _create_wait_functions(_assertion_wait_factory("stderr"))
wait_for_start, wait_for_start_sync = _create_wait_functions(_create_start_wait)
wait_for_exit, wait_for_exit_sync = _create_wait_functions(_create_exit_wait)
