"""Time in the graph: the system's, or one that a test moves by hand."""

from __future__ import annotations

import asyncio
import heapq
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import count
from typing import Protocol

from linkwright.graph.executor import Executor
from linkwright.messages import Time

_NANOSECONDS_PER_SECOND = 1_000_000_000


@dataclass(frozen=True, slots=True, order=True)
class TimePoint:
    """A point in time, as a clock gives it: nanoseconds since the epoch."""

    nanoseconds: int

    def to_msg(self) -> Time:
        """The point as a message."""
        return Time.from_nanoseconds(self.nanoseconds)


class Alarm(Protocol):
    """A callback that a clock will call."""

    def cancel(self) -> None:
        """Do not call it."""


class Clock(ABC):
    """What stamps messages and wakes timers.

    Stamps are points in time (they may jump, as system clocks do); timers go by a steady count that never goes back.
    """

    @abstractmethod
    def now_ns(self) -> int:
        """Nanoseconds since the epoch."""

    @abstractmethod
    def steady_ns(self) -> int:
        """Nanoseconds of a steady count with an arbitrary start."""

    @abstractmethod
    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Call something once on the event loop when the steady count has come to a value."""

    def now(self) -> TimePoint:
        """The present as a point in time."""
        return TimePoint(self.now_ns())

    @abstractmethod
    def attach(self, executor: Executor) -> None:
        """Learn of the executor of a graph that goes by this clock."""


class SystemClock(Clock):
    """The computer's clock; timers go by the event loop's monotonic one."""

    def now_ns(self) -> int:
        """Nanoseconds since the epoch."""
        return time.time_ns()

    def steady_ns(self) -> int:
        """Nanoseconds of the running event loop's time."""
        return int(asyncio.get_running_loop().time() * _NANOSECONDS_PER_SECOND)

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Call something once on the running event loop."""
        return asyncio.get_running_loop().call_at(steady_ns / _NANOSECONDS_PER_SECOND, callback)

    def attach(self, executor: Executor) -> None:
        """Nothing to do: the event loop runs the executor while time goes by."""


@dataclass(slots=True, order=True)
class _JumpAlarm:
    steady_ns: int
    number: int
    callback: Callable[[], None] = field(compare=False)
    cancelled: bool = field(default=False, compare=False)

    def cancel(self) -> None:
        self.cancelled = True


class JumpClock(Clock):
    """A clock that stands still until a test moves it, so that an hour of timers takes milliseconds.

    Args:
        start_ns: what `now_ns` gives at first, nanoseconds since the epoch.
    """

    def __init__(self, start_ns: int = 1_700_000_000 * _NANOSECONDS_PER_SECOND) -> None:
        self._now_ns = start_ns
        self._steady_ns = 0
        self._alarms: list[_JumpAlarm] = []
        self._numbers = count()
        self._executors: list[Executor] = []

    def now_ns(self) -> int:
        """Nanoseconds since the epoch, as moved so far."""
        return self._now_ns

    def steady_ns(self) -> int:
        """Nanoseconds advanced so far."""
        return self._steady_ns

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Call something once when the clock is advanced that far."""
        alarm = _JumpAlarm(steady_ns, next(self._numbers), callback)
        heapq.heappush(self._alarms, alarm)
        return alarm

    def attach(self, executor: Executor) -> None:
        """Let the executor finish its work before each step of the clock."""
        self._executors.append(executor)

    async def advance(self, seconds: float) -> None:
        """Let time go by; each timer is called when it falls due, and what it causes is done before the next."""
        end = self._steady_ns + round(seconds * _NANOSECONDS_PER_SECOND)
        await self._settle()
        while self._alarms and self._alarms[0].steady_ns <= end:
            alarm = heapq.heappop(self._alarms)
            if not alarm.cancelled:
                self._move_to(max(alarm.steady_ns, self._steady_ns))
                alarm.callback()
                await self._settle()
        self._move_to(end)

    def jump(self, seconds: float) -> None:
        """Set the time of stamps forward or back, as a corrected system clock or a restarted recording does.

        Timers are not called.
        """
        self._now_ns += round(seconds * _NANOSECONDS_PER_SECOND)

    def _move_to(self, steady_ns: int) -> None:
        self._now_ns += steady_ns - self._steady_ns
        self._steady_ns = steady_ns

    async def _settle(self) -> None:
        for executor in self._executors:
            await executor.settle()
