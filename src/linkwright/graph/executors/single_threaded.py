"""The executor that runs callbacks in the thread that spins."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from linkwright.graph.executors.errors import ConditionReachedException, ShutdownException, TimeoutException
from linkwright.graph.executors.executor import Executor, deadline_after
from linkwright.graph.future import Future


class SingleThreadedExecutor(Executor):
    """Runs callbacks one after another in the thread that spins (rclpy ``SingleThreadedExecutor``).

    What a callback raises leaves ``spin``. When the context is shut down from outside during the wait,
    ``ExternalShutdownException`` does.
    """

    def is_own_thread(self) -> bool:
        """Whether the calling thread is the one that runs callbacks, which must not wait for others of them."""
        return set(self._spinners) == {threading.get_ident()}

    def spin(self) -> None:
        """Run callbacks until the executor or the context is shut down."""
        self._spinner_begins()
        try:
            while not self._is_shutdown and self._context_ok():
                self._run_one(None, None)
        finally:
            self._spinner_ends()

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Wait for one callback and run it; see ``Executor.spin_once``."""
        self._spin_once(timeout_sec, None)

    def spin_once_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """As `spin_once`, but the wait ends when the future is done, too."""
        future.add_waiter(self.wake)
        self._spin_once(timeout_sec, future.ended)

    def _spin_once(self, timeout_sec: float | None, condition: Callable[[], bool] | None) -> None:
        self._spinner_begins()
        try:
            self._run_one(deadline_after(timeout_sec), condition)
        finally:
            self._spinner_ends()

    def _run_one(self, deadline_ns: int | None, condition: Callable[[], bool] | None) -> None:
        try:
            item = self._next(deadline_ns, condition)
        except (ShutdownException, TimeoutException, ConditionReachedException):
            return
        self._execute(item)
