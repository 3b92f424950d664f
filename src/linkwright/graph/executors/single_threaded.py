"""The executor that runs callbacks in the spinning thread."""

from __future__ import annotations

import threading
from collections.abc import Callable

from linkwright.graph.executors.base import SpinningExecutor
from linkwright.graph.faults import ConditionReachedException, ShutdownException, TimeoutException


class SingleThreadedExecutor(SpinningExecutor):
    """An executor that runs callbacks one by one in the spinning thread.

    It corresponds to rclpy's ``SingleThreadedExecutor``. If a callback raises an exception, ``spin`` also raises it. If
    the context is shut down during the wait, ``spin`` raises ``ExternalShutdownException``.
    """

    def is_own_thread(self) -> bool:
        """Return whether the calling thread spins this executor.

        If it does, it must not block on callbacks.
        """
        return set(self._spinners) == {threading.get_ident()}

    def _run_next(self, deadline_ns: int | None, condition: Callable[[], bool] | None) -> None:
        try:
            item = self._wait_for_next(deadline_ns, condition)
        except (ShutdownException, TimeoutException, ConditionReachedException):
            return
        self._execute(item)
