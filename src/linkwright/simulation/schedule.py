"""Periodic calls of functions in simulated time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from heapq import heapify, heappop, heappush, heapreplace


@dataclass(eq=False, slots=True)
class Task:
    """A function that is called periodically.

    Attributes:
        period: the time between two calls, in simulated nanoseconds.
        function: the function to call, without arguments.
        is_cancelled: whether the task was cancelled, so that the function is no longer called.
    """

    period: int
    function: Callable[[], None]
    is_cancelled: bool = False


class Schedule:
    """The tasks in simulated time.

    Tasks that are due at the same time run in the order in which they were added.
    """

    def __init__(self) -> None:
        self._heap: list[tuple[int, int, Task]] = []  # time of the next call, sequence number, task
        self._count = 0

    @property
    def next_time(self) -> int | None:
        """The time of the next call, in nanoseconds, or None if there are no tasks."""
        while self._heap and self._heap[0][2].is_cancelled:
            heappop(self._heap)
        return self._heap[0][0] if self._heap else None

    def add(self, period: int, function: Callable[[], None], now: int) -> Task:
        """Add and return a task that first runs one period after `now`, in nanoseconds."""
        task = Task(period, function)
        heappush(self._heap, (now + period, self._count, task))
        self._count += 1
        return task

    def run(self, now: int) -> None:
        """Call each due task once, even if several of its periods have passed."""
        while self._heap and self._heap[0][0] <= now:
            time, number, task = self._heap[0]
            if task.is_cancelled:
                heappop(self._heap)
                continue
            next_time = time + task.period
            if next_time <= now:
                next_time += ((now - next_time) // task.period + 1) * task.period
            heapreplace(self._heap, (next_time, number, task))
            task.function()

    def restart(self) -> None:
        """Reschedule all tasks, because simulated time restarts at 0."""
        self._heap = [(task.period, number, task) for _, number, task in self._heap]
        heapify(self._heap)
