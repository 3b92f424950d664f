"""Calls from a simulation or control loop to its plugins, sensors and controllers.

An exception ends only the plugin, sensor or controller that raised it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from linkwright.graph.log.logger import Logger, log_failure

Failure = Callable[[Exception], object]


class Calls:
    """A caller of the functions of a plugin, a sensor or a controller.

    Args:
        on_failure: called with the exception of a function; may call `close`.

    Attributes:
        number: the number of the current call, counted from 1; 0 between calls. State that may change at any time, such
            as the subscriptions of a topic, is read only once per call (`Output.is_wanted`).
        is_closed: whether further calls are ignored.
    """

    __slots__ = ("_count", "_on_failure", "is_closed", "number")

    def __init__(self, on_failure: Failure) -> None:
        self.number = 0
        self.is_closed = False
        self._count = 0
        self._on_failure = on_failure

    def call(self, function: Callable[[], object]) -> None:
        """Call a function, and pass an exception that it raises to `on_failure`."""
        if self.is_closed:
            return
        previous_number, self._count = self.number, self._count + 1
        self.number = self._count
        try:
            function()
        except Exception as error:  # noqa: BLE001 - an error of a plugin must not end the others
            self.fail(error)
        finally:
            self.number = previous_number

    def fail(self, error: Exception) -> None:
        """Report an error that occurred elsewhere.

        This method must be called in the simulation's thread.
        """
        if not self.is_closed:
            self._on_failure(error)

    def close(self, function: Callable[[], object], on_error: Failure) -> None:
        """Call a final function, and ignore all further calls.

        If the function raises an exception, `on_error` receives it.
        """
        if self.is_closed:
            return
        self.is_closed = True
        try:
            function()
        except Exception as error:  # noqa: BLE001 - as above
            on_error(error)


def create_logged_calls(logger: Logger, name: str) -> Calls:
    """Return a `Calls` object that logs exceptions and continues."""
    return Calls(partial(log_failure, logger, f"a callback of '{name}'"))
