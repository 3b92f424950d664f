"""What is to be done at which simulated times."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from heapq import heapify, heappop, heappush


@dataclass(eq=False, slots=True)
class Task:
    """A function that is called again and again.

    Attributes:
        period: nanoseconds from one call to the next.
        function: what is called.
        due: the time of the next call.
        turn: its place among those that are due at the same time.
        cancelled: whether it is called no more.
    """

    period: int
    function: Callable[[], None]
    due: int
    turn: int
    cancelled: bool = False

    def __lt__(self, other: Task) -> bool:
        return (self.due, self.turn) < (other.due, other.turn)


class Schedule:
    """Tasks by simulated time; those that are due at the same time are done in the order in which they were added."""

    def __init__(self) -> None:
        self._tasks: list[Task] = []
        self._count = 0

    @property
    def next_time(self) -> int | None:
        """When the next task is due, in nanoseconds; None if there is none."""
        while self._tasks and self._tasks[0].cancelled:
            heappop(self._tasks)
        return self._tasks[0].due if self._tasks else None

    def add(self, period: int, function: Callable[[], None], now: int) -> Task:
        """Add a task, which is due for the first time one period from now."""
        task = Task(period, function, now + period, self._count)
        self._count += 1
        heappush(self._tasks, task)
        return task

    def run(self, now: int) -> None:
        """Do what is due. A task that is due more than once, as time went in longer steps, is done once."""
        while (due := self.next_time) is not None and due <= now:
            task = heappop(self._tasks)
            task.due += (now - task.due) // task.period * task.period + task.period
            heappush(self._tasks, task)
            task.function()

    def restart(self) -> None:
        """Begin anew at time 0."""
        for task in self._tasks:
            task.due = task.period
        heapify(self._tasks)
