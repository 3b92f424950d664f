"""The one way in which a simulation or a control loop calls the code of a part: an exception ends that part alone."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from linkwright.graph.log.logger import Logger, log_failure

Failure = Callable[[Exception], object]


class Calls:
    """Calls the functions of a plugin, a sensor or a controller.

    Args:
        failed: called with the exception of a function; it may `close` these calls.

    Attributes:
        number: the number of the current call, from 1; 0 between two calls. A state that may change at any time,
            such as the subscriptions of a topic, is read once in a call (`Output.is_wanted`).
        is_closed: whether nothing is called any more.
    """

    __slots__ = ("_count", "_failed", "is_closed", "number")

    def __init__(self, failed: Failure) -> None:
        self.number = 0
        self.is_closed = False
        self._count = 0
        self._failed = failed

    def make(self, function: Callable[[], object]) -> None:
        """Call a function; `failed` receives its exception."""
        if self.is_closed:
            return
        outer, self._count = self.number, self._count + 1
        self.number = self._count
        try:
            function()
        except Exception as error:  # noqa: BLE001 - whatever a plugin throws must not end the others
            self.fail(error)
        finally:
            self.number = outer

    def fail(self, error: Exception) -> None:
        """Report an error from elsewhere, in the simulation's thread."""
        if not self.is_closed:
            self._failed(error)

    def close(self, function: Callable[[], object], on_error: Failure) -> None:
        """Call a last function, and no other one afterwards; its exception is only logged."""
        if self.is_closed:
            return
        self.is_closed = True
        try:
            function()
        except Exception as error:  # noqa: BLE001 - as above
            on_error(error)


def logged_calls(logger: Logger, name: str) -> Calls:
    """Return calls that log an error of a function; everything else continues."""
    return Calls(partial(log_failure, logger, f"a callback of '{name}'"))
