"""Decorators of ``launch_testing`` for the functions and classes of a launch test."""

from __future__ import annotations

import functools
import inspect
import threading
import time
import unittest
from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])
C = TypeVar("C")

PARAMETRIZED = "__parametrized__"
MARKERS = "__markers__"
AFTER_SHUTDOWN = "__post_shutdown_test__"
TIMEOUT = "__ready_to_test_action_timeout__"


def parametrize(argnames: str, argvalues: Iterable[Any]) -> Callable[[Callable[..., Any]], Callable[[], Any]]:
    """Decorate ``generate_test_description`` to launch once for each of several values.

    Args:
        argnames: the names of the arguments, separated by commas.
        argvalues: a value for each launch; for several arguments, a tuple of values.
    """
    names = [name.strip() for name in argnames.split(",") if name.strip()]
    values = [argvalue if isinstance(argvalue, tuple) else (argvalue,) for argvalue in argvalues]

    def decorate(function: Callable[..., Any]) -> Callable[[], Any]:
        @functools.wraps(function)
        def descriptions() -> Iterator[tuple[Callable[..., Any], dict[str, Any]]]:
            for value in values:
                arguments = dict(zip(names, value, strict=False))
                description_function = functools.partial(function, **arguments)
                functools.update_wrapper(description_function, function)
                yield description_function, arguments

        setattr(descriptions, PARAMETRIZED, True)
        return descriptions

    return decorate


def post_shutdown_test() -> Callable[[type[C]], type[C]]:
    """Decorate a class of tests that run after the launch.

    Raises:
        TypeError: raised by the decorator if the object is not a class.
    """

    def decorate(test_item: type[C]) -> type[C]:
        if not isinstance(test_item, type):
            raise TypeError("postcondition_test should decorate test classes")
        setattr(test_item, AFTER_SHUTDOWN, True)
        return test_item

    return decorate


def ready_to_test_action_timeout(timeout: float) -> Callable[[F], F]:
    """Decorate ``generate_test_description`` with a timeout in seconds for its `ReadyToTest`."""

    def decorate(function: F) -> F:
        setattr(function, TIMEOUT, timeout)
        return function

    return decorate


def keep_alive(test_description: F) -> F:
    """Decorate ``generate_test_description`` to keep the launch running until the tests end.

    Launches without processes need this decorator.
    """
    if not hasattr(test_description, MARKERS):
        setattr(test_description, MARKERS, {})
    getattr(test_description, MARKERS)["keep_alive"] = True
    return test_description


def retry_on_failure(*, times: int, delay: float | None = None) -> Callable[[F], F]:
    """Decorate a test to retry it when an assertion fails.

    Args:
        times: the maximum number of attempts.
        delay: the time between attempts in seconds.
    """
    if times <= 0:
        raise AssertionError("times must be positive")

    def decorate(test: F) -> F:
        if next(iter(inspect.signature(test).parameters), None) != "self":
            raise AssertionError("retry_on_failure decorates methods of tests")

        @functools.wraps(test)
        def tried(self: Any, *args: Any, **kwargs: Any) -> Any:
            for _ in range(times - 1):
                try:
                    result = test(self, *args, **kwargs)
                    if not isinstance(self, unittest.TestCase) or _has_passed(self):
                        return result
                except AssertionError:
                    pass
                _forget_failures(self)
                if delay is not None:
                    time.sleep(delay)
            return test(self, *args, **kwargs)

        return tried  # type: ignore[return-value]  # the function has the signature of F

    return decorate


def _has_passed(test: Any) -> bool:
    """Return whether no subtest of a test has failed.

    unittest has no public API for this.
    """
    outcome = test._outcome
    return outcome is None or bool(outcome.success)


def _forget_failures(test: Any) -> None:
    outcome = getattr(test, "_outcome", None)
    if outcome is None:
        return
    if hasattr(outcome, "errors"):  # Python before 3.11
        outcome.errors.clear()
    elif outcome.result is not None:
        outcome.result.errors.clear()
        outcome.result.failures.clear()
    outcome.success = True


class ReadyAggregator:
    """A counter that calls a function after a certain number of calls of `ready_fn`.

    Args:
        ready_fn: the function to call at the end.
        num_to_aggregate: the number of calls of the method `ready_fn` to wait for.
    """

    def __init__(self, ready_fn: Callable[[], object], num_to_aggregate: int) -> None:
        self._ready = ready_fn
        self._remaining_calls = num_to_aggregate
        self._lock = threading.Lock()

    def ready_fn(self) -> None:
        """Count a call, and call the function on the last one.

        This method may be called from any thread.
        """
        with self._lock:
            self._remaining_calls -= 1
            is_last = self._remaining_calls == 0
        if is_last:
            self._ready()
