"""The executor that runs callbacks in a pool of daemon threads."""

from __future__ import annotations

import queue
import threading
import time
import warnings
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any

from linkwright.graph.executors.base import Context, SpinningExecutor, deadline_after
from linkwright.graph.faults import (
    ConditionReachedException,
    ExternalShutdownException,
    ShutdownException,
    TimeoutException,
)
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.process.processors import usable_processors


class MultiThreadedExecutor(SpinningExecutor):
    """An executor that runs callbacks in a thread pool, as their callback groups allow.

    It corresponds to rclpy's ``MultiThreadedExecutor``.

    The spinning thread hands work to at most as many threads as the pool has. Other work stays queued in its entities,
    subject to their QoS. `spin_once` does not wait for the work that it handed out to end. If a callback raises an
    exception, ``spin`` raises it in the spinning thread.

    Args:
        num_threads: the number of threads; None for the number of processors of the process.
        context: see `Executor`.
    """

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        if num_threads is None:
            num_threads = usable_processors()
        if num_threads == 1:
            warnings.warn(
                "MultiThreadedExecutor is used with a single thread.\nUse the SingleThreadedExecutor instead.",
                stacklevel=2,
            )
        self._workers = Workers(num_threads, "executor", self._work.wake)
        self._faults: deque[BaseException] = deque()
        self._is_spinning = False
        self._admission = threading.Lock()

    def spin(self) -> None:
        """Run callbacks until the executor or the context is shut down."""
        self._is_spinning = True
        try:
            super().spin()
        finally:
            self._is_spinning = False

    def shutdown(self, timeout_sec: float | None = None, *, wait_for_threads: bool = True) -> bool:
        """Stop running callbacks, and wait for the running callbacks and the threads to end.

        Args:
            timeout_sec: the maximum wait, in seconds; None or a negative number for no limit.
            wait_for_threads: False to return without waiting for the threads.

        Returns:
            Whether all callbacks, and the threads if waited for, have ended.
        """
        deadline_ns = deadline_after(timeout_sec)
        callbacks_ended = super().shutdown(timeout_sec)
        if not wait_for_threads:
            self._workers.close(0.0)
            return callbacks_ended
        remaining_s = (
            None if deadline_ns is None else max(deadline_ns - time.monotonic_ns(), 0) / NANOSECONDS_PER_SECOND
        )
        return self._workers.close(remaining_s) and callbacks_ended

    def _run_next(self, deadline_ns: int | None, condition: Callable[[], bool] | None) -> None:
        while not self._workers.has_room and not self._faults:
            if self._is_shutdown or not self._is_context_ok() or (condition is not None and condition()):
                return
            if deadline_ns is not None and time.monotonic_ns() >= deadline_ns:
                return
            self._work.wait_for_wake(deadline_ns)
        self._raise_faults()
        try:
            item = self._wait_for_next(deadline_ns, partial(self._should_end_wait, condition))
        except (ExternalShutdownException, ShutdownException, TimeoutException, ConditionReachedException):
            pass
        else:
            self._workers.submit(partial(self._run, item))
        self._raise_faults()

    def _should_end_wait(self, condition: Callable[[], bool] | None) -> bool:
        return bool(self._faults) or (condition is not None and condition())

    def _raise_faults(self) -> None:
        if self._faults:
            raise self._faults.popleft()

    def _run(self, item: Any) -> None:
        """Run a task or entity and, while the executor spins, the work that becomes ready next.

        Running the next work in the same thread avoids a thread switch.
        """
        while item is not None:
            try:
                self._execute(item)
            except BaseException as fault:  # noqa: BLE001  # raised in the thread that spins
                self._faults.append(fault)
            item = self._take_for_worker() if self._is_spinning else None

    def _take_for_worker(self) -> Any:
        while not (self._is_shutdown or self._faults) and self._is_context_ok():
            item = self._work.take()
            if item is None or self._admit(item):
                return item
        return None

    def _admit(self, item: Any, *, begin: bool = True) -> bool:
        with self._admission:
            return super()._admit(item, begin=begin)


class Workers:
    """A pool of daemon threads, each started when it is first needed.

    Args:
        limit: the maximum number of threads.
        name: the prefix of the threads' names.
        on_idle: called when a job has ended and its thread is free for the next one.
    """

    def __init__(self, limit: int, name: str, on_idle: Callable[[], None]) -> None:
        self._limit = limit
        self._on_idle = on_idle
        self._name = name
        self._jobs: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        self._threads: list[threading.Thread] = []
        self._lock = threading.Lock()
        self._unfinished_count = 0

    @property
    def has_room(self) -> bool:
        """Whether a job that is submitted now would start immediately."""
        return self._unfinished_count < self._limit

    def submit(self, job: Callable[[], None]) -> None:
        """Run a job in a thread of the pool.

        The job must not raise an exception.
        """
        with self._lock:
            self._unfinished_count += 1
            if self._unfinished_count > len(self._threads) and len(self._threads) < self._limit:
                thread = threading.Thread(target=self._work, name=f"{self._name}-{len(self._threads)}", daemon=True)
                self._threads.append(thread)
                thread.start()
        self._jobs.put(job)

    def close(self, timeout_sec: float | None = None) -> bool:
        """Stop the threads after the submitted jobs, and wait for the threads to end.

        Args:
            timeout_sec: the maximum wait for all threads together, in seconds; None for no limit.

        Returns:
            Whether all threads have ended. A thread of the pool that calls this method does not wait for itself.
        """
        with self._lock:
            threads, self._threads = self._threads, []
        for _ in threads:
            self._jobs.put(None)
        other_threads = [thread for thread in threads if thread is not threading.current_thread()]
        deadline_ns = deadline_after(timeout_sec)
        for thread in other_threads:
            remaining_ns = None if deadline_ns is None else max(0, deadline_ns - time.monotonic_ns())
            thread.join(None if remaining_ns is None else remaining_ns / NANOSECONDS_PER_SECOND)
        return not any(thread.is_alive() for thread in other_threads)

    def _work(self) -> None:
        while (job := self._jobs.get()) is not None:
            try:
                job()
            finally:
                with self._lock:
                    self._unfinished_count -= 1
                self._on_idle()
