"""Spinning, for the executors of this room; each says what one turn is."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from typing import Any

from linkwright.graph.executors.base import Executor, deadline_after
from linkwright.graph.loop.future import Future


class SpinningExecutor(Executor):
    """Takes turns until it is to end."""

    def spin(self) -> None:
        """Run callbacks until the executor or the context is shut down."""
        self._spinner_begins()
        try:
            while not self._is_shutdown and self._context_ok():
                self._turn(None, None)
        finally:
            self._spinner_ends()

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Wait for one callback and have it run; see ``Executor.spin_once``."""
        self._single_turn(timeout_sec, None)

    def spin_once_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """As `spin_once`, but the wait ends when the future is done, too."""
        future.add_waiter(self.wake)
        self._single_turn(timeout_sec, future.ended)

    def _single_turn(self, timeout_sec: float | None, condition: Callable[[], bool] | None) -> None:
        self._spinner_begins()
        try:
            self._turn(deadline_after(timeout_sec), condition)
        finally:
            self._spinner_ends()

    @abstractmethod
    def _turn(self, deadline_ns: int | None, condition: Callable[[], bool] | None) -> None:
        """Wait for one callback and have it run.

        Args:
            deadline_ns: the count of ``time.monotonic_ns`` at which the wait ends; None for any time.
            condition: ends the wait when it gives True after a `wake`.
        """
