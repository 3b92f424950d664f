"""The executor that runs callbacks in the thread that spins."""

from __future__ import annotations

import threading
from collections.abc import Callable

from linkwright.graph.executors.base import SpinningExecutor
from linkwright.graph.faults import ConditionReachedException, ShutdownException, TimeoutException


class SingleThreadedExecutor(SpinningExecutor):
    """Runs callbacks one after another in the thread that spins (rclpy ``SingleThreadedExecutor``).

    The exception of a callback leaves ``spin``. When the context is shut down from outside during the wait,
    ``ExternalShutdownException`` does.
    """

    def is_own_thread(self) -> bool:
        """Whether the calling thread is the one that runs callbacks, which must not wait for others of them."""
        return set(self._spinners) == {threading.get_ident()}

    def _turn(self, deadline_ns: int | None, condition: Callable[[], bool] | None) -> None:
        try:
            item = self._next(deadline_ns, condition)
        except (ShutdownException, TimeoutException, ConditionReachedException):
            return
        self._execute(item)
