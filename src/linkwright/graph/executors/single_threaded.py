"""The executor that runs callbacks in the thread that spins."""

from __future__ import annotations

import threading
from collections.abc import Callable

from linkwright.graph.executors.base import SpinningExecutor
from linkwright.graph.faults import ConditionReachedException, ShutdownException, TimeoutException


class SingleThreadedExecutor(SpinningExecutor):
    """Runs callbacks one after another in the thread that spins (rclpy ``SingleThreadedExecutor``).

    If a callback raises an exception, ``spin`` raises it. If the context is shut down from outside during the wait,
    ``spin`` raises ``ExternalShutdownException``.
    """

    def is_own_thread(self) -> bool:
        """Return whether the calling thread runs the callbacks, and so must not wait for other callbacks."""
        return set(self._spinners) == {threading.get_ident()}

    def _turn(self, deadline_ns: int | None, condition: Callable[[], bool] | None) -> None:
        try:
            item = self._next(deadline_ns, condition)
        except (ShutdownException, TimeoutException, ConditionReachedException):
            return
        self._execute(item)
