"""The work queue of an executor: ready entities, alarms, and waiting for both."""

from __future__ import annotations

import heapq
import os
import threading
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_MAX_WAIT_S = 0.1 if os.name == "nt" else 3600.0
"""The maximum length of one wait. It is short on Windows, where a signal does not end a wait."""

_MAX_CANCELLED = 64


class ScheduledCall:
    """A callback that is scheduled with ``WorkQueue.call_at``."""

    __slots__ = ("_queue", "callback", "number", "steady_ns")

    def __init__(self, queue: WorkQueue, steady_ns: int, number: int, callback: Callable[[], None]) -> None:
        self._queue = queue
        self.steady_ns = steady_ns
        self.number = number
        self.callback: Callable[[], None] | None = callback

    def cancel(self) -> None:
        """Cancel the call."""
        if self.callback is not None:
            self.callback = None
            self._queue.note_cancelled()

    def __lt__(self, other: ScheduledCall) -> bool:
        return (self.steady_ns, self.number) < (other.steady_ns, other.number)


class WorkQueue:
    """A queue of ready entities and tasks that any thread may add to.

    A thread that takes from the queue also runs the alarms that are due.

    Adding takes no lock while no thread waits, so a message within one thread costs almost nothing. Waiting holds no
    lock either: Ctrl-C may raise KeyboardInterrupt at any point of the wait, and a ``threading.Condition`` would then
    release a lock that its thread does not hold (RuntimeError: cannot release un-acquired lock).
    """

    def __init__(self) -> None:
        self._ready: deque[Any] = deque()
        self._ready_once: set[Any] = set()
        self._alarms: list[ScheduledCall] = []
        self._last_number = 0
        self._cancelled = 0
        self._alarms_lock = threading.RLock()
        self._wait_locks: deque[threading.Lock] = deque()
        self._is_wake_requested = False

    def add(self, item: Any) -> None:
        """Add an item at the end."""
        self._ready.append(item)
        if self._wait_locks:
            self._wake_sleepers()

    def add_once(self, item: Any) -> None:
        """Add an item at the end, unless it is in the queue."""
        if item not in self._ready_once:
            self._ready_once.add(item)
            self.add(item)

    def add_first(self, items: list[Any]) -> None:
        """Put items back at the beginning, in their order."""
        self._ready_once.update(items)
        self._ready.extendleft(reversed(items))
        self._wake_sleepers()

    def has_ready(self) -> bool:
        """Return whether an item is ready."""
        return bool(self._ready)

    def take(self) -> Any:
        """Run the alarms that are due, then remove the first ready item and return it.

        Returns None if the queue is empty.
        """
        if self._alarms and self._alarms[0].steady_ns <= time.monotonic_ns():
            self._run_due_alarms()
        try:
            item = self._ready.popleft()
        except IndexError:
            return None
        self._ready_once.discard(item)
        return item

    def wait(self, deadline_ns: int | None) -> None:
        """Wait for an item, a due alarm, a call of `wake`, or `deadline_ns`.

        The wait may also end early without a reason.
        """
        self._sleep(deadline_ns, until_wake=False)

    def wait_for_wake(self, deadline_ns: int | None) -> None:
        """Wait for a call of `wake`, or `deadline_ns`.

        Ready items stay in the queue.
        """
        self._sleep(deadline_ns, until_wake=True)

    def wake(self) -> None:
        """End the wait of all waiting threads.

        If no thread is waiting, end the next wait.
        """
        self._is_wake_requested = True
        self._wake_sleepers()

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> ScheduledCall:
        """Schedule a callback for a value of ``time.monotonic_ns``.

        The callback runs in a thread that takes from the queue.
        """
        with self._alarms_lock:
            self._last_number += 1
            call = ScheduledCall(self, steady_ns, self._last_number, callback)
            heapq.heappush(self._alarms, call)
            is_next = self._alarms[0] is call
        if is_next:
            self._wake_sleepers()
        return call

    def note_cancelled(self) -> None:
        """Count a cancelled alarm.

        If there are many, remove them all.
        """
        self._cancelled += 1
        if self._cancelled > _MAX_CANCELLED:
            with self._alarms_lock:
                if self._cancelled * 2 > len(self._alarms):
                    self._alarms = [call for call in self._alarms if call.callback is not None]
                    heapq.heapify(self._alarms)
                    self._cancelled = 0

    def clear(self) -> None:
        """Remove all items and alarms."""
        with self._alarms_lock:
            self._ready.clear()
            self._ready_once.clear()
            self._alarms.clear()
            self._cancelled = 0

    def _run_due_alarms(self) -> None:
        while True:
            with self._alarms_lock:
                if not self._alarms or self._alarms[0].steady_ns > time.monotonic_ns():
                    return
                call = heapq.heappop(self._alarms)
                callback, call.callback = call.callback, None
                if callback is None:
                    self._cancelled -= 1
                    continue
            callback()

    def _sleep(self, deadline_ns: int | None, *, until_wake: bool) -> None:
        wait_lock = threading.Lock()
        wait_lock.acquire()
        self._wait_locks.append(
            wait_lock
        )  # before the queue is checked, so that a thread that adds later wakes this one
        try:
            if self._is_wake_requested or (self._ready and not until_wake):
                return
            if not until_wake:
                deadline_ns = self._earliest_wake_ns(deadline_ns)
            seconds = _MAX_WAIT_S
            if deadline_ns is not None:
                seconds = min((deadline_ns - time.monotonic_ns()) / NANOSECONDS_PER_SECOND, seconds)
            if seconds > 0:
                wait_lock.acquire(timeout=seconds)
        finally:
            self._is_wake_requested = False
            with suppress(ValueError):  # already removed by the thread that woke it
                self._wait_locks.remove(wait_lock)

    def _earliest_wake_ns(self, deadline_ns: int | None) -> int | None:
        with self._alarms_lock:
            if self._alarms and (deadline_ns is None or self._alarms[0].steady_ns < deadline_ns):
                return self._alarms[0].steady_ns
        return deadline_ns

    def _wake_sleepers(self) -> None:
        while self._wait_locks:
            with suppress(IndexError):  # another thread removed it
                self._wait_locks.popleft().release()
